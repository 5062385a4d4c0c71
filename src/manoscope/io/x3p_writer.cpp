// Maps as .x3p (ISO 25178-72): 64-bit heights, a validity mask, checksums.
#include <fmt/format.h>
#include <zip.h>

#include <bit>
#include <limits>
#include <utility>
#include <vector>

#include "manoscope/core/atomic_file.hpp"
#include "manoscope/core/error.hpp"
#include "manoscope/io/md5.hpp"
#include "manoscope/io/writer.hpp"

namespace manoscope::io {
namespace {

using Files = std::vector<std::pair<std::string, std::string>>;

[[noreturn]] void fail(const std::filesystem::path& path, const char* reason) {
  throw InputError(path.string(), fmt::format("cannot be packed: {}", reason),
                   "Write the map as .nc");
}

/// The archive's bytes. Every file carries the same date, so that equal maps give equal bytes.
std::string zip_of(const Files& files, const std::filesystem::path& path) {
  zip_error_t error;
  zip_error_init(&error);
  zip_source_t* target = zip_source_buffer_create(nullptr, 0, 0, &error);
  if (target == nullptr) fail(path, zip_error_strerror(&error));
  zip_source_keep(target);  // outlives the archive, which frees one hold
  const auto finish = [&](const char* reason) {
    const std::string kept = reason;
    zip_source_free(target);
    fail(path, kept.c_str());
  };
  zip_t* archive = zip_open_from_source(target, ZIP_TRUNCATE, &error);
  if (archive == nullptr) {
    zip_source_free(target);
    finish(zip_error_strerror(&error));
  }
  for (const auto& [name, content] : files) {
    zip_source_t* source = zip_source_buffer(archive, content.data(), content.size(), 0);
    const zip_int64_t index =
        source == nullptr ? -1 : zip_file_add(archive, name.c_str(), source, ZIP_FL_ENC_UTF_8);
    constexpr zip_uint16_t kFirstOfJanuary1980 = 0x21;
    if (index < 0 || zip_file_set_dostime(archive, static_cast<zip_uint64_t>(index), 0,
                                          kFirstOfJanuary1980, 0) != 0) {
      if (index < 0) zip_source_free(source);
      const std::string reason = zip_strerror(archive);
      zip_discard(archive);
      finish(reason.c_str());
    }
  }
  if (zip_close(archive) != 0) {
    const std::string reason = zip_strerror(archive);
    zip_discard(archive);
    finish(reason.c_str());
  }
  zip_stat_t status;
  zip_stat_init(&status);
  std::string bytes;
  if (zip_source_stat(target, &status) != 0 || zip_source_open(target) != 0) {
    finish(zip_error_strerror(zip_source_error(target)));
  }
  bytes.resize(status.size);
  const zip_int64_t n_read = zip_source_read(target, bytes.data(), bytes.size());
  zip_source_close(target);
  if (n_read != static_cast<zip_int64_t>(bytes.size())) finish("it cannot be read back");
  zip_source_free(target);
  zip_error_fini(&error);
  return bytes;
}

std::string main_xml(const CameraGrid& grid, const std::string& data, const std::string& valid) {
  const auto axis = [](const char* name, char kind, double increment) {
    return fmt::format(
        "<{0}><AxisType>{1}</AxisType><DataType>D</DataType><Increment>{2}</Increment>"
        "<Offset>0</Offset></{0}>\n",
        name, kind, increment);
  };
  const std::string mask = valid.empty()
                               ? std::string()
                               : fmt::format(
                                     "<ValidPointsLink>bindata/valid.bin</ValidPointsLink>\n"
                                     "<MD5ChecksumValidPoints>{}</MD5ChecksumValidPoints>\n",
                                     md5(valid));
  return fmt::format(
      "<?xml version=\"1.0\" encoding=\"UTF-8\"?>\n"
      "<p:ISO5436_2 xmlns:p=\"http://www.opengps.eu/2008/ISO5436_2\" "
      "xmlns:xsi=\"http://www.w3.org/2001/XMLSchema-instance\" "
      "xsi:schemaLocation=\"http://www.opengps.eu/2008/ISO5436_2 "
      "http://www.opengps.eu/2008/ISO5436_2/ISO5436_2.xsd\">\n"
      "<Record1>\n<Revision>ISO5436 - 2000</Revision>\n<FeatureType>SUR</FeatureType>\n<Axes>\n"
      "{}{}{}</Axes>\n</Record1>\n"
      "<Record3>\n<MatrixDimension><SizeX>{}</SizeX><SizeY>{}</SizeY><SizeZ>1</SizeZ>"
      "</MatrixDimension>\n<DataLink>\n<PointDataLink>bindata/data.bin</PointDataLink>\n"
      "<MD5ChecksumPointData>{}</MD5ChecksumPointData>\n{}</DataLink>\n</Record3>\n"
      "<Record4><ChecksumFile>md5checksum.hex</ChecksumFile></Record4>\n</p:ISO5436_2>\n",
      axis("CX", 'I', grid.pitch_x.si()), axis("CY", 'I', grid.pitch_y.si()), axis("CZ", 'A', 1.0),
      grid.nx, grid.ny, md5(data), mask);
}

}  // namespace

void write_x3p(const std::filesystem::path& path, const HeightMap& map) {
  const auto n = static_cast<std::size_t>(map.height().size());
  std::string data, valid((n + 7) / 8, '\0');
  data.reserve(8 * n);
  bool all_valid = true;
  for (std::size_t i = 0; i < n; ++i) {
    const bool good = map.flags().data()[i] == 0;
    const double height = good ? map.height().data()[i] : std::numeric_limits<double>::quiet_NaN();
    const auto bits = std::bit_cast<std::uint64_t>(height);
    for (int shift = 0; shift < 64; shift += 8) data += static_cast<char>(bits >> shift & 0xffU);
    if (good) valid[i / 8] = static_cast<char>(valid[i / 8] | 1 << (i % 8));
    all_valid = all_valid && good;
  }
  if (all_valid) valid.clear();
  const std::string xml = main_xml(map.grid(), data, valid);
  Files files{{"main.xml", xml}, {"bindata/data.bin", data}};
  if (!valid.empty()) files.emplace_back("bindata/valid.bin", valid);
  files.emplace_back("md5checksum.hex", md5(xml) + " *main.xml\n");
  write_file_atomically(path, zip_of(files, path));
}

}  // namespace manoscope::io

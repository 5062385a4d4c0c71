// Gwyddion Simple Field 1.0 (.gsf).
//
// Source: "Simple Field Files", Gwyddion user guide,
// gwyddion.net/documentation/user-guide-en/gsf.html. A magic line; lines `name = value`; 1 to 4 NUL
// bytes up to a multiple of 4; then XRes x YRes little-endian 32-bit floats, row by row from the
// top.
#include <fmt/format.h>

#include <algorithm>
#include <bit>
#include <cmath>
#include <limits>
#include <map>

#include "manoscope/core/atomic_file.hpp"
#include "manoscope/core/error.hpp"
#include "manoscope/io/byte_cursor.hpp"
#include "manoscope/io/file_text.hpp"
#include "manoscope/io/file_units.hpp"
#include "manoscope/io/formats.hpp"
#include "manoscope/io/gsf.hpp"
#include "manoscope/io/writer.hpp"

namespace manoscope::io {
namespace {

/// The lines `name = value` between the magic line and the first NUL.
class Header {
 public:
  Header(std::string_view text, std::string where) : where_(std::move(where)) {
    int line_number = 1;
    while (!text.empty()) {
      ++line_number;
      const auto end = text.find('\n');
      const std::string_view line = trimmed(text.substr(0, end));
      text.remove_prefix(end == std::string_view::npos ? text.size() : end + 1);
      if (line.empty()) continue;
      const auto equals = line.find('=');
      if (equals == std::string_view::npos) {
        throw InputError(fmt::format("{}:{}", where_, line_number),
                         "this header line is not of the form name = value", kExport);
      }
      const std::string name(trimmed(line.substr(0, equals)));
      if (!fields_.emplace(name, trimmed(line.substr(equals + 1))).second) {
        throw InputError(fmt::format("{}:{}", where_, line_number),
                         fmt::format("{} is given a second time", excerpt(name)), kExport);
      }
    }
  }

  std::string text(const std::string& name) const {
    const auto found = fields_.find(name);
    return found == fields_.end() ? std::string() : std::string(found->second);
  }

  std::optional<double> number(const std::string& name) const {
    const auto found = fields_.find(name);
    if (found == fields_.end()) return std::nullopt;
    const auto value = parse_number(found->second);
    if (!value || !std::isfinite(*value)) {
      throw InputError(
          where_, fmt::format("{} is \"{}\", not a number", name, excerpt(found->second)), kExport);
    }
    return value;
  }

  double pixels(const std::string& name) const {
    const auto value = number(name);
    if (!value) throw InputError(where_, fmt::format("its header has no {}", name), kExport);
    if (*value < 1.0 || *value > kMostPixels || *value != std::floor(*value)) {
      throw InputError(where_, fmt::format("{} is {}, not a number of pixels", name, *value),
                       kExport);
    }
    return *value;
  }

 private:
  static constexpr const char* kExport = "Export the map to .gsf again";
  std::string where_;
  std::map<std::string, std::string_view> fields_;
};

/// The first bytes of a file, its header among them: the whole of it if the header is that long.
std::string_view head_of(ByteCursor& cursor) {
  constexpr std::uint64_t kMost = 4096, kMostPadding = 4;
  const std::string_view head = cursor.bytes(std::min(kMost, cursor.size()));
  const auto end = head.find('\0');
  if (end != std::string_view::npos && end + kMostPadding <= head.size()) return head;
  cursor.seek(0);
  return cursor.bytes(cursor.size());
}

class GsfReader final : public Reader {
 public:
  std::string_view name() const override { return "gsf"; }
  std::string_view description() const override { return "Gwyddion Simple Field"; }
  std::vector<std::string> extensions() const override { return {".gsf"}; }
  int score(const Probe& probe) const override {
    return probe.head.starts_with(kGsfMagic) ? 100 : 0;
  }

  std::vector<Channel> read(const std::filesystem::path& path, const ReadOptions&) const override {
    ByteCursor cursor(path);
    GsfLayout layout = read_gsf_header(head_of(cursor), cursor.size(), path.string());
    Channel channel;
    channel.name = std::move(layout.title);
    channel.grid = layout.grid;
    channel.file_unit = std::move(layout.file_unit);
    channel.unit = layout.unit.name;
    channel.values.resize(channel.grid.ny, channel.grid.nx);
    cursor.seek(layout.data);
    cursor.f32_array(Endian::little,
                     {channel.values.data(), static_cast<std::size_t>(channel.values.size())});
    scale_values(channel.values, layout.unit.scale, path.string());
    std::vector<Channel> channels;
    channels.push_back(std::move(channel));
    return channels;
  }
};

/// 0 where the file names no size, or none that is a length.
Length pitch(const Header& header, const std::string& field, double n, const std::string& where) {
  const auto size = header.number(field);
  const SiUnit unit = si_unit(header.text("XYUnits"), where);
  if (!size || unit.name != "m") return {};
  if (*size > 1e30) checked_pitch(*size, field, where);
  return Length::from_si(checked_pitch(unit.scale.to_si(*size) / n, field, where));
}

}  // namespace

GsfLayout read_gsf_header(std::string_view head, std::uint64_t file_bytes,
                          const std::string& where) {
  ByteCursor cursor(head, where);
  if (cursor.bytes(std::min(cursor.size(), kGsfMagic.size())) != kGsfMagic) {
    throw InputError(where, "does not begin with \"Gwyddion Simple Field 1.0\"",
                     "Export the map to .gsf again");
  }
  const auto header_end = head.find('\0');
  if (header_end == std::string::npos) {
    throw InputError(where, "no NUL byte ends its header",
                     "The file is incomplete; copy or export it again");
  }
  const Header header(head.substr(kGsfMagic.size(), header_end - kGsfMagic.size()), where);
  const double nx = header.pixels("XRes"), ny = header.pixels("YRes");
  check_pixel_counts(nx, ny, where);

  cursor.seek(header_end);
  const std::uint64_t n_padding = 4 - header_end % 4;
  for (const char byte : cursor.bytes(n_padding)) {
    if (byte != '\0') {
      cursor.fail(fmt::format("{} NUL bytes should end the header", n_padding),
                  "Export the map to .gsf again");
    }
  }
  const auto n_pixels = static_cast<std::uint64_t>(nx * ny);
  const std::uint64_t remaining = file_bytes - cursor.offset();
  if (remaining != 4 * n_pixels) {
    throw InputError(where,
                     fmt::format("{} bytes of heights follow its header, but XRes x YRes = {} x "
                                 "{} needs {}",
                                 remaining, nx, ny, 4 * n_pixels),
                     remaining < 4 * n_pixels
                         ? "The file is incomplete; copy or export it again"
                         : "The file is damaged or holds more than one map; export it again");
  }
  GsfLayout layout;
  layout.title = header.text("Title");
  layout.grid.nx = static_cast<Index>(nx);
  layout.grid.ny = static_cast<Index>(ny);
  layout.grid.pitch_x = pitch(header, "XReal", nx, where);
  layout.grid.pitch_y = pitch(header, "YReal", ny, where);
  static_cast<void>(header.number("XOffset"));  // must be numbers; a map counts from its corner
  static_cast<void>(header.number("YOffset"));
  layout.file_unit = header.text("ZUnits");
  layout.unit = si_unit(layout.file_unit, where);
  layout.data = cursor.offset();
  return layout;
}

const Reader& gsf_reader() {
  static const GsfReader reader;
  return reader;
}

void write_gsf(const std::filesystem::path& path, const HeightMap& map, const std::string& title) {
  const CameraGrid& grid = map.grid();
  std::string bytes = fmt::format(
      "{}XRes = {}\nYRes = {}\nXReal = {}\nYReal = {}\nXYUnits = m\nZUnits = m\nTitle = {}\n",
      kGsfMagic, grid.nx, grid.ny, grid.size_x().si(), grid.size_y().si(), one_line(title));
  bytes.append(4 - bytes.size() % 4, '\0');
  bytes.reserve(bytes.size() + 4 * static_cast<std::size_t>(map.height().size()));
  for (Index i = 0; i < map.height().size(); ++i) {
    const double height = map.height().data()[i];
    if (std::abs(height) > std::numeric_limits<float>::max()) {
      throw InputError(path.string(),
                       fmt::format("a height of {:.3g} m has no 32-bit float", height),
                       "Write the map as .nc");
    }
    const std::uint32_t bits = map.flags().data()[i] == 0
                                   ? std::bit_cast<std::uint32_t>(static_cast<float>(height))
                                   : 0x7fc00000U;
    for (int shift = 0; shift < 32; shift += 8) bytes += static_cast<char>(bits >> shift & 0xffU);
  }
  write_file_atomically(path, bytes);
}

}  // namespace manoscope::io

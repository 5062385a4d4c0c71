// How much memory a sound file takes while it is read, format by format, against what its maps and
// the bytes that must be at hand explain.
#include <fmt/format.h>
#include <gtest/gtest.h>

#include <cmath>
#include <functional>

#include "fuzz/allocation_counter.hpp"
#include "manoscope/io/file_units.hpp"
#include "manoscope/io/reader.hpp"
#include "manoscope/io/test_confocal_files.hpp"
#include "manoscope/io/test_files.hpp"
#include "manoscope/io/test_sdf.hpp"
#include "manoscope/io/test_tiff.hpp"
#include "manoscope/io/test_zip.hpp"
#include "manoscope/io/writer.hpp"
#include "manoscope/io/x3p_test_files.hpp"

namespace manoscope::fuzz {
namespace {

namespace own = io::testing;

constexpr int kNx = 1200, kNy = 800, kPixels = kNx * kNy;

/// 16-bit samples 100, 101 ... without the values that any format keeps for missing heights.
std::string samples(int n_bytes, bool little_endian = true) {
  std::string bytes;
  bytes.reserve(static_cast<std::size_t>(kPixels) * static_cast<std::size_t>(n_bytes));
  for (int i = 0; i < kPixels; ++i) {
    const auto value = static_cast<std::uint64_t>(100 + i % (n_bytes == 1 ? 100 : 9000));
    bytes += little_endian ? own::little(value, n_bytes) : own::big(value, n_bytes);
  }
  return bytes;
}

std::string floats() {
  std::string bytes;
  for (int i = 0; i < kPixels; ++i) bytes += own::little(static_cast<float>(i % 9000));
  return bytes;
}

std::string opd() {
  // The fixture's directory, with a larger array of heights and no image.
  const std::string array = own::little(kNx, 2) + own::little(kNy, 2) + own::little(2, 2);
  const auto entry = [](const std::string& name, std::uint64_t type, std::uint64_t size) {
    return own::padded(name, 16) + own::little(type, 2) + own::little(size, 4) + own::little(8, 2);
  };
  return std::string("\1\0", 2) + entry("Directory", 1, 4 * 24) +
         entry("RAW_DATA", 3, 6 + 2 * std::uint64_t{kPixels}) + entry("Pixel_size", 7, 4) +
         entry("Wavelength", 7, 4) + array + samples(2) + own::little(0.0016F) +
         own::little(632.8F);
}

std::string sur() {
  own::SurfObject file;
  file.bits = 16;
  file.nx = kNx;
  file.ny = kNy;
  file.n = kPixels;
  file.points = {};
  return file.bytes() + samples(2);
}

std::string nms() {
  std::string header = own::NanoFocusNms().bytes().substr(0, 3468);
  own::put(header, 1368, own::little(kNx, 4) + own::little(kNy, 4));
  return header + samples(2) + samples(1);
}

std::string sdf() {
  std::string bytes = own::binary_sdf("bISO-1.0", 5, samples(2));
  own::put(bytes, 42, own::little(kNx, 2) + own::little(kNy, 2));
  return bytes;
}

std::string plu() {
  return own::SensofarPlu().bytes().substr(0, 500) + own::little(kNy, 4) + own::little(kNx, 4) +
         floats() + std::string(8, '\0');
}

std::string dat() {
  own::ZygoDat file;
  file.phases = {};
  file.intensities = {};
  std::string bytes = file.bytes();
  own::put(bytes, 52,
           own::big(kNx, 2) + own::big(kNy, 2) + own::big(1, 2) + own::big(255, 2) +
               own::big(2 * std::uint64_t{kPixels}, 4));
  own::put(bytes, 64, own::big(0, 4) + own::big(kNx, 2) + own::big(kNy, 2));
  return bytes + samples(2, false) + samples(4, false);
}

std::string tiff(int bits) {
  own::TiffPage page;
  page.nx = kNx;
  page.ny = kNy;
  page.bits = bits;
  page.format = bits == 32 ? 3 : 2;
  page.data = bits == 32 ? floats() : samples(2);
  page.description = "ImageJ=1.53t\nunit=um\nvunit=nm\n";
  page.per_unit_x = page.per_unit_y = 0.5;
  return own::tiff_file({page});
}

std::string x3p_i16() {
  own::X3pParts parts;
  parts.z_kind = 'I';
  parts.z_type = 'I';
  parts.z_increment = "1e-9";
  parts.nx = kNx;
  parts.ny = kNy;
  return own::stored_zip({{"main.xml", own::x3p_main(parts)}, {"bindata/data.bin", samples(2)}});
}

std::string point_table() {
  std::string text = "x [um],y [um],z [nm]\n";
  for (int i = 0; i < kPixels; ++i) {
    text += fmt::format("{},{},{}\n", i % kNx, i / kNx, i % 9);
  }
  return text;
}

/// Of our own writers.
std::string written(const own::TestFolder& folder, const std::string& name) {
  Array2 height(kNy, kNx);
  for (Index i = 0; i < height.size(); ++i) {
    height.data()[i] = 1e-6 * std::sin(static_cast<double>(i));
  }
  io::write_map(folder / name, HeightMap(CameraGrid{kNx, kNy, 1.0 * um, 1.0 * um}, height), "");
  return own::bytes_of(folder / name);
}

double peak_of(const std::function<void()>& body) {
  AllocationCounter::restart();
  body();
  return static_cast<double>(AllocationCounter::peak());
}

struct Case {
  const char* name;
  std::function<std::string(const own::TestFolder&)> bytes;
  double copies_held;  ///< of the file's bytes, while it is read
  int n_channels;      ///< of kPixels
};

const std::vector<Case>& cases() {
  static const std::vector<Case> table{
      {"a.opd", [](const auto&) { return opd(); }, 0.0, 1},
      {"a.sur", [](const auto&) { return sur(); }, 0.0, 1},
      {"a.nms", [](const auto&) { return nms(); }, 0.0, 2},
      {"a.sdf", [](const auto&) { return sdf(); }, 0.0, 1},
      {"a.plu", [](const auto&) { return plu(); }, 0.0, 1},
      {"a.dat", [](const auto&) { return dat(); }, 0.0, 2},
      {"16.tif", [](const auto&) { return tiff(16); }, 0.0, 1},
      {"32.tif", [](const auto&) { return tiff(32); }, 0.0, 1},
      // What unpacks from the archive.
      {"16.x3p", [](const auto&) { return x3p_i16(); }, 1.0, 1},
      {"a.x3p", [](const auto& folder) { return written(folder, "a.x3p"); }, 1.1, 1},
      {"a.gsf", [](const auto& folder) { return written(folder, "a.gsf"); }, 1.0, 1},
      // The text beside three numbers a point, of which the map is one.
      {"a.txt", [](const auto&) { return point_table(); }, 2.7, 1},
      {"a.csv", [](const auto& folder) { return written(folder, "a.csv"); }, 1.0, 1},
  };
  return table;
}

TEST(Memory, OfAMapIsThatOfItsPixelsAndTheBytesThatMustBeAtHand) {
  ASSERT_TRUE(AllocationCounter::works());
  static_cast<void>(io::length_scale("um"));  // loads the table of units, once
  const own::TestFolder folder;
  // Windows and buffers; libtiff's strips of 8 rows and more.
  constexpr double kConstant = 300e3;
  fmt::print("{:8} {:>10} {:>12} {:>12} {:>8} {:>8}\n", "file", "bytes", "map holds", "all hold",
             "x file", "x file");
  for (const Case& file : cases()) {
    SCOPED_TRACE(file.name);
    const std::string bytes = file.bytes(folder);
    const auto n_bytes = static_cast<double>(bytes.size());
    const auto path = folder.write(file.name, bytes);
    const double map = peak_of([&] { static_cast<void>(io::read_height_map(path)); });
    const double all = peak_of([&] {
      const auto channels = io::read_channels(path);
      EXPECT_EQ(channels.size(), static_cast<std::size_t>(file.n_channels));
    });
    fmt::print("{:8} {:10.0f} {:12.0f} {:12.0f} {:8.2f} {:8.2f}\n", file.name, n_bytes, map, all,
               map / n_bytes, all / n_bytes);
    const double held = file.copies_held * n_bytes + kConstant;
    // A height map: 8 bytes of height and 1 of flags a pixel, whatever else the file holds.
    EXPECT_LE(map, 9.0 * kPixels + held);
    EXPECT_LE(all, 8.0 * kPixels * file.n_channels + held);
  }
}

}  // namespace
}  // namespace manoscope::fuzz

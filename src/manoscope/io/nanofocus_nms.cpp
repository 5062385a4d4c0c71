// NanoFocus (.nms).
//
// Source: the descriptions of the format in surfalize and SurfaceTopography, and NanoFocus' own
// words on their MATLAB reader (heights in um; a pixel is valid where its reflection is above 0).
// Little-endian. A header of 3468 bytes with the range of the heights in um at 16, the numbers of
// columns and rows at 1368, their distances in nm at 1376; heights as 16-bit numbers
//
//   height = z_min + number / 65534 (z_max - z_min)
//
// and, where the file is long enough, the reflection as bytes. Rows run from the top. The two
// descriptions agree on 65534; full range at 65535 would change heights by 1.5e-5 of the range.
#include <fmt/format.h>

#include <cmath>
#include <limits>
#include <vector>

#include "manoscope/core/error.hpp"
#include "manoscope/io/file_units.hpp"
#include "manoscope/io/formats.hpp"
#include "manoscope/io/sample_block.hpp"

namespace manoscope::io {
namespace {

constexpr std::uint64_t kHeaderBytes = 3468, kRange = 16, kVersion = 32, kTitle = 52, kDate = 1076,
                        kCounts = 1368;
constexpr double kFullRange = 65534.0;
constexpr const char* kSaveAgain = "Save the map as .nms again";

class NanoFocusReader final : public Reader {
 public:
  std::string_view name() const override { return "nanofocus-nms"; }
  std::string_view description() const override { return "NanoFocus"; }
  std::vector<std::string> extensions() const override { return {".nms"}; }
  int score(const Probe& probe) const override {
    if (probe.head.size() < kHeaderBytes) return 0;
    ByteCursor cursor(probe.head, {});
    cursor.seek(kCounts);
    const std::uint64_t nx = cursor.u32(Endian::little), ny = cursor.u32(Endian::little);
    const bool fits = nx > 0 && ny > 0 && nx <= (probe.size - kHeaderBytes) / 2 / ny;
    if (!fits) return 0;
    if (probe.head.substr(kVersion).starts_with("OM_MS")) return 95;
    return probe.path.extension() == ".nms" ? 50 : 0;
  }

  std::vector<Channel> read(const std::filesystem::path& path,
                            const ReadOptions& options) const override {
    ByteCursor cursor(path);
    cursor.seek(kRange);
    const double least = cursor.f64(Endian::little), most = cursor.f64(Endian::little);
    if (!(std::isfinite(least) && std::isfinite(most)) || std::abs(least) > 1e12 ||
        std::abs(most) > 1e12 || most <= least) {
      cursor.fail("the range of its heights is none", kSaveAgain);
    }
    cursor.seek(kCounts);
    const std::uint32_t nx = cursor.u32(Endian::little), ny = cursor.u32(Endian::little);
    const double pitch_x = cursor.f64(Endian::little), pitch_y = cursor.f64(Endian::little);
    if (!(std::isfinite(pitch_x) && std::isfinite(pitch_y)) || std::abs(pitch_x) > 1e15 ||
        std::abs(pitch_y) > 1e15) {
      cursor.fail("the size of its pixels is none", kSaveAgain);
    }
    cursor.seek(kHeaderBytes);
    Array2 heights = read_block(cursor, SampleType::u16, Endian::little, nx, ny, "heights");
    std::vector<Channel> channels;
    channels.push_back(make_channel("height", "m", std::move(heights),
                                    (most - least) / kFullRange * 1e-6, path.string()));
    channels.back().values += least * 1e-6;
    channels.back().file_unit = "um";
    if (cursor.remaining() >= std::uint64_t{nx} * ny) {
      const std::uint64_t start = cursor.offset();
      drop_unlit(channels.front().values, cursor);
      if (is_wanted(options, false, true)) {
        cursor.seek(start);
        channels.push_back(
            make_channel("reflection", "1",
                         read_block(cursor, SampleType::u8, Endian::little, nx, ny, "reflections"),
                         1.0, path.string()));
      }
    }
    for (Channel& channel : channels) {
      set_pitch(channel, pitch_x * 1e-9, pitch_y * 1e-9, path.string());
      const auto describe = [&](std::string_view setting, std::uint64_t offset, std::uint64_t n) {
        cursor.seek(offset);
        add_setting(channel, setting, cursor.text(n));
      };
      describe("version", kVersion, kTitle - kVersion);
      describe("title", kTitle, 64);
      describe("date", kDate, 16);
    }
    return channels;
  }

 private:
  /// Makes NaN of every height whose pixel has no reflection, row by row.
  static void drop_unlit(Array2& heights, ByteCursor& cursor) {
    std::vector<double> reflection(static_cast<std::size_t>(heights.cols()));
    for (Index iy = 0; iy < heights.rows(); ++iy) {
      read_samples(cursor, SampleType::u8, Endian::little, reflection);
      for (Index ix = 0; ix < heights.cols(); ++ix) {
        if (reflection[static_cast<std::size_t>(ix)] == 0.0) {
          heights(iy, ix) = std::numeric_limits<double>::quiet_NaN();
        }
      }
    }
  }
};

}  // namespace

const Reader& nanofocus_nms_reader() {
  static const NanoFocusReader reader;
  return reader;
}

}  // namespace manoscope::io

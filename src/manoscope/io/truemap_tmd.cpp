// TrueMap (.tmd), as TrueMap 6 and GelSight write it.
//
// Source: the descriptions of the format by the TrueMapData project and in SurfaceTopography's
// reader TMD; GelSight's own programs write pixel sizes in mm there. Little-endian. A mark of 32
// bytes, a comment that a NUL ends, the numbers of columns and rows, the map's sizes and offsets,
// and the heights as 32-bit floats. All lengths are in mm. Rows run from the top.
#include <fmt/format.h>

#include <cmath>

#include "manoscope/core/error.hpp"
#include "manoscope/io/file_text.hpp"
#include "manoscope/io/file_units.hpp"
#include "manoscope/io/formats.hpp"
#include "manoscope/io/sample_block.hpp"

namespace manoscope::io {
namespace {

constexpr std::string_view kMagic = "Binary TrueMap Data File v2.0";
constexpr std::uint64_t kMagicBytes = 32;
constexpr const char* kSaveAgain = "Save the map in TrueMap again";

class TrueMapReader final : public Reader {
 public:
  std::string_view name() const override { return "truemap-tmd"; }
  std::string_view description() const override { return "TrueMap"; }
  std::vector<std::string> extensions() const override { return {".tmd"}; }
  int score(const Probe& probe) const override { return probe.head.starts_with(kMagic) ? 100 : 0; }

  std::vector<Channel> read(const std::filesystem::path& path, const ReadOptions&) const override {
    ByteCursor cursor(path);
    if (!cursor.file_begins_with(kMagic)) {
      throw InputError(path.string(), fmt::format("does not begin with \"{}\"", kMagic),
                       kSaveAgain);
    }
    cursor.seek(kMagicBytes);
    const std::string comment(trimmed(cursor.zero_terminated().substr(0, 1000)));
    const std::uint32_t nx = cursor.u32(Endian::little), ny = cursor.u32(Endian::little);
    const double size_x = cursor.f32(Endian::little), size_y = cursor.f32(Endian::little);
    const double x0 = cursor.f32(Endian::little), y0 = cursor.f32(Endian::little);
    Array2 heights = read_block(cursor, SampleType::f32, Endian::little, nx, ny, "heights");
    if (cursor.remaining() != 0) {
      cursor.fail(
          fmt::format("{} bytes follow the heights of {} x {} pixels", cursor.remaining(), nx, ny),
          kSaveAgain);
    }
    std::vector<Channel> channels;
    channels.push_back(make_channel("height", "m", std::move(heights), 1e-3, path.string()));
    Channel& channel = channels.back();
    channel.file_unit = "mm";
    set_pitch(channel, size_x * 1e-3 / nx, size_y * 1e-3 / ny, path.string());
    add_setting(channel, "comment", comment);
    add_setting(channel, "x offset", x0, "mm");
    add_setting(channel, "y offset", y0, "mm");
    return channels;
  }
};

}  // namespace

const Reader& truemap_tmd_reader() {
  static const TrueMapReader reader;
  return reader;
}

}  // namespace manoscope::io

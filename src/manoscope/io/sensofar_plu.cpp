// Sensofar PLu (.plu).
//
// Source: the description in Gwyddion's import module sensofar (version 2000 and later).
// Little-endian. A date as text in 128 bytes and as seconds, a comment of 256 bytes, the scales of
// the axes in um, the settings of the measurement; from byte 500 on the layers, each with its
// numbers of rows and columns, its heights as 32-bit floats in um, least and greatest height. Rows
// run from the top; 1000001 marks a missing height.
#include <fmt/format.h>

#include <cmath>

#include "manoscope/core/error.hpp"
#include "manoscope/io/file_units.hpp"
#include "manoscope/io/formats.hpp"
#include "manoscope/io/sample_block.hpp"

namespace manoscope::io {
namespace {

constexpr std::uint64_t kScales = 388, kMeasurement = 428, kLayerCount = 489, kLayers = 500;
constexpr double kMissing = 1000001.0;
constexpr const char* kSaveAgain = "Save it in SensoSCAN as a topography (.plu or .plux) again";

enum Measurement { image = 0, profile = 1, profiles = 2, topography = 3, thickness = 5 };

/// "Fri Mar 10 16:35:59 2023" and a NUL: the only mark the format has.
bool begins_with_a_date(std::string_view head) {
  constexpr std::string_view kShape = "aaa aaa 99 99:99:99 9999";
  if (head.size() <= kShape.size() || head[kShape.size()] != '\0') return false;
  for (std::size_t i = 0; i < kShape.size(); ++i) {
    const char letter = head[i];
    const bool is_letter = (letter >= 'A' && letter <= 'Z') || (letter >= 'a' && letter <= 'z');
    const bool is_digit = (letter >= '0' && letter <= '9') || (i == 8 && letter == ' ');
    const bool fits = kShape[i] == 'a'   ? is_letter
                      : kShape[i] == '9' ? is_digit
                                         : letter == kShape[i];
    if (!fits) return false;
  }
  return true;
}

struct Header {
  double pitch_x = 0.0, pitch_y = 0.0, x0 = 0.0, y0 = 0.0, z0 = 0.0;
  std::uint32_t type = 0, algorithm = 0, objective = 0;
  std::uint8_t n_layers = 0;
  std::string date, comment;
};

Header read_header(ByteCursor& cursor) {
  Header header;
  header.date = cursor.text(128);
  cursor.skip(4);
  header.comment = cursor.text(256);
  cursor.seek(kScales + 16);
  header.pitch_x = cursor.f32(Endian::little);
  header.pitch_y = cursor.f32(Endian::little);
  header.x0 = cursor.f32(Endian::little);
  header.y0 = cursor.f32(Endian::little);
  cursor.skip(4);
  header.z0 = cursor.f32(Endian::little);
  cursor.seek(kMeasurement);
  header.type = cursor.u32(Endian::little);
  header.algorithm = cursor.u32(Endian::little);
  cursor.skip(4);
  header.objective = cursor.u32(Endian::little);
  cursor.seek(kLayerCount);
  header.n_layers = cursor.u8();
  cursor.seek(kLayers);
  return header;
}

class SensofarPluReader final : public Reader {
 public:
  std::string_view name() const override { return "sensofar-plu"; }
  std::string_view description() const override { return "Sensofar PLu"; }
  std::vector<std::string> extensions() const override { return {".plu"}; }
  int score(const Probe& probe) const override {
    if (probe.head.size() < kLayers + 8 || !begins_with_a_date(probe.head)) return 0;
    ByteCursor cursor(probe.head, {});
    cursor.seek(kLayers);
    const std::uint64_t ny = cursor.u32(Endian::little), nx = cursor.u32(Endian::little);
    return nx > 0 && ny > 0 && nx <= probe.size / 4 / ny ? 90 : 20;
  }

  std::vector<Channel> read(const std::filesystem::path& path, const ReadOptions&) const override {
    ByteCursor cursor(path);
    const Header header = read_header(cursor);
    const bool known = header.type == image || header.type == profile || header.type == profiles ||
                       header.type == topography || header.type == thickness;
    if (!known) {
      throw InputError(path.string(),
                       fmt::format("holds a measurement of type {}, which is no map", header.type),
                       kSaveAgain);
    }
    const int n_layers = std::max<int>(header.n_layers, 1);
    std::vector<Channel> channels;
    check_channel_count(static_cast<std::uint64_t>(n_layers), path.string());
    for (int i = 0; i < n_layers; ++i) {
      if (i > 0) cursor.skip(8);  // least and greatest height of the layer before
      const std::uint32_t ny = cursor.u32(Endian::little), nx = cursor.u32(Endian::little);
      Array2 heights = read_block(cursor, SampleType::f32, Endian::little, nx, ny, "heights");
      mark_missing(heights, [](double height) { return height == kMissing; });
      const bool is_image = header.type == image;
      const std::string kind = is_image ? "image" : "height";
      channels.push_back(make_channel(n_layers == 1 ? kind : fmt::format("{} {}", kind, i + 1),
                                      is_image ? "1" : "m", std::move(heights),
                                      is_image ? 1.0 : 1e-6, path.string()));
      finish(channels.back(), header, path.string());
    }
    return channels;
  }

 private:
  static void finish(Channel& channel, const Header& header, const std::string& where) {
    set_pitch(channel, std::abs(header.pitch_x) * 1e-6, std::abs(header.pitch_y) * 1e-6, where);
    add_setting(channel, "date", header.date);
    add_setting(channel, "comment", header.comment);
    add_setting(channel, "algorithm", header.algorithm);
    add_setting(channel, "objective number", header.objective);
    add_setting(channel, "x offset", header.x0, "um");
    add_setting(channel, "y offset", header.y0, "um");
    add_setting(channel, "z offset", header.z0, "um");
  }
};

}  // namespace

const Reader& sensofar_plu_reader() {
  static const SensofarPluReader reader;
  return reader;
}

}  // namespace manoscope::io

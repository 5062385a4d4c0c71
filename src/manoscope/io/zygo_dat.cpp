// Zygo MetroPro (.dat).
//
// Source: "MetroPro Reference Guide" OMP-0347, appendix "MetroPro data format". Big-endian. A
// header of 834 bytes (formats 1 and 2) or 4096 (format 3); n_buckets intensity images of 16-bit
// numbers; one phase image of 32-bit numbers. Rows run from the top.
//
//   height = -+ phase * S * O * W / R
//
// with S the interferometric scale factor, O the obliquity factor, W the wavelength and R = 4096,
// 32768, 131072 for a phase resolution of 0, 1, 2. The minus sign holds where the field `sign` is
// set. Phases from 2147483640 on are missing, as are intensities from 65412 on.
#include <fmt/format.h>

#include <algorithm>
#include <array>

#include "manoscope/core/error.hpp"
#include "manoscope/io/formats.hpp"
#include "manoscope/io/sample_block.hpp"

namespace manoscope::io {
namespace {

constexpr std::array<std::uint32_t, 3> kMagics{0x881b036fU, 0x881b0370U, 0x881b0371U};
constexpr double kMissingPhase = 2147483640.0;
constexpr double kMissingIntensity = 65412.0;
constexpr const char* kSaveAgain = "Save the map in MetroPro again";

/// A rectangle of camera pixels.
struct Window {
  std::int16_t x = 0, y = 0;
  std::uint16_t nx = 0, ny = 0;

  std::uint64_t pixels() const { return std::uint64_t{nx} * ny; }
};

struct Header {
  std::uint32_t size = 0;
  Window intensity_window, phase_window;
  std::uint16_t n_buckets = 0;
  std::uint32_t intensity_bytes = 0;
  double scale_factor = 0.0, wavelength = 0.0, obliquity = 0.0, lateral_resolution = 0.0;
  std::int16_t phase_resolution = 0, sign = 0;
};

Window read_window(ByteCursor& cursor) {
  Window window;
  window.x = cursor.i16(Endian::big);
  window.y = cursor.i16(Endian::big);
  window.nx = cursor.u16(Endian::big);
  window.ny = cursor.u16(Endian::big);
  return window;
}

template <class Read>
auto at(ByteCursor& cursor, std::uint64_t offset, Read read) {
  cursor.seek(offset);
  return read(cursor);
}

double f32_at(ByteCursor& cursor, std::uint64_t offset) {
  return at(cursor, offset, [](ByteCursor& c) { return c.f32(Endian::big); });
}

std::int16_t i16_at(ByteCursor& cursor, std::uint64_t offset) {
  return at(cursor, offset, [](ByteCursor& c) { return c.i16(Endian::big); });
}

Header read_header(ByteCursor& cursor) {
  cursor.seek(0);
  const std::uint32_t magic = cursor.u32(Endian::big);
  if (std::find(kMagics.begin(), kMagics.end(), magic) == kMagics.end()) {
    throw InputError(cursor.where(), "does not begin with the mark of a MetroPro file", kSaveAgain);
  }
  Header header;
  cursor.seek(6);
  header.size = cursor.u32(Endian::big);
  if (header.size < 834) {
    cursor.fail(fmt::format("announces a header of {} bytes, not of 834 or 4096", header.size),
                kSaveAgain);
  }
  cursor.seek(48);
  header.intensity_window = read_window(cursor);
  header.n_buckets = cursor.u16(Endian::big);
  cursor.seek(60);
  header.intensity_bytes = cursor.u32(Endian::big);
  header.phase_window = read_window(cursor);
  header.scale_factor = f32_at(cursor, 164);
  header.wavelength = f32_at(cursor, 168);
  header.obliquity = f32_at(cursor, 176);
  header.lateral_resolution = f32_at(cursor, 184);
  header.phase_resolution = i16_at(cursor, 218);
  header.sign = i16_at(cursor, 232);
  return header;
}

double height_per_count(const Header& header, const std::string& where) {
  double counts = 0.0;
  switch (header.phase_resolution) {
    case 0:
      counts = 4096.0;
      break;
    case 1:
      counts = 32768.0;
      break;
    case 2:
      counts = 131072.0;
      break;
    default:
      throw InputError(
          where,
          fmt::format("its phase resolution is {}; known are 0, 1 and 2", header.phase_resolution),
          kSaveAgain);
  }
  const double scale = header.scale_factor * header.obliquity * header.wavelength / counts;
  return header.sign != 0 ? -scale : scale;
}

void describe(Channel& channel, const Header& header, ByteCursor& cursor) {
  const auto text = [&](std::uint64_t offset, std::uint64_t n_bytes) {
    return at(cursor, offset, [n_bytes](ByteCursor& c) { return c.text(n_bytes); });
  };
  add_setting(channel, "wavelength", header.wavelength * 1e9, "nm");
  add_setting(channel, "interferometric scale factor", header.scale_factor);
  add_setting(channel, "obliquity factor", header.obliquity);
  add_setting(channel, "phase resolution", double(header.phase_resolution));
  add_setting(channel, "sign", header.sign != 0 ? "inverted" : "normal");
  add_setting(channel, "numerical aperture", f32_at(cursor, 172));
  add_setting(channel, "magnification", f32_at(cursor, 180));
  add_setting(channel, "camera width", double(i16_at(cursor, 234)), "px");
  add_setting(channel, "camera height", double(i16_at(cursor, 236)), "px");
  add_setting(channel, "phase averages", double(i16_at(cursor, 300)));
  add_setting(channel, "software date", text(12, 30));
  add_setting(channel, "comment", text(80, 82));
  add_setting(channel, "objective", text(246, 12));
  add_setting(channel, "part", text(258, 40));
  add_setting(channel, "part serial number", text(320, 40));
}

void place(Channel& channel, const Window& window, const Header& header, ByteCursor& cursor) {
  set_pitch(channel, header.lateral_resolution, header.lateral_resolution, cursor.where());
  channel.offset_x = window.x;
  channel.offset_y = window.y;
  describe(channel, header, cursor);
}

class ZygoDatReader final : public Reader {
 public:
  std::string_view name() const override { return "zygo-dat"; }
  std::string_view description() const override { return "Zygo MetroPro"; }
  std::vector<std::string> extensions() const override { return {".dat"}; }
  int score(const Probe& probe) const override {
    if (probe.head.size() < 4) return 0;
    ByteCursor cursor(probe.head, {});
    const std::uint32_t magic = cursor.u32(Endian::big);
    return std::find(kMagics.begin(), kMagics.end(), magic) != kMagics.end() ? 100 : 0;
  }

  std::vector<Channel> read(const std::filesystem::path& path,
                            const ReadOptions& options) const override {
    ByteCursor cursor(path);
    const Header header = read_header(cursor);
    const Window& light = header.intensity_window;
    const std::uint64_t n_images = light.pixels() == 0 ? 0 : header.n_buckets;
    check_channel_count(n_images, path.string());
    if (header.intensity_bytes != 2 * light.pixels() * n_images) {
      throw InputError(path.string(),
                       fmt::format("announces {} bytes of intensities, but {} images of {} x {} "
                                   "pixels take {}",
                                   header.intensity_bytes, n_images, light.nx, light.ny,
                                   2 * light.pixels() * n_images),
                       kSaveAgain);
    }

    std::vector<Channel> channels;
    const bool has_phases = header.phase_window.pixels() > 0;
    if (has_phases) {
      cursor.seek(std::uint64_t{header.size} + header.intensity_bytes);
      Array2 phase = read_block(cursor, SampleType::i32, Endian::big, header.phase_window.nx,
                                header.phase_window.ny, "phases");
      mark_missing(phase, [](double count) { return count >= kMissingPhase; });
      channels.push_back(make_channel("height", "m", std::move(phase),
                                      height_per_count(header, path.string()), path.string()));
      place(channels.back(), header.phase_window, header, cursor);
    }
    cursor.seek(header.size);
    for (std::uint64_t i = 0; i < n_images && is_wanted(options, false, has_phases); ++i) {
      Array2 image =
          read_block(cursor, SampleType::u16, Endian::big, light.nx, light.ny, "intensities");
      mark_missing(image, [](double count) { return count >= kMissingIntensity; });
      const std::string name = n_images == 1 ? "intensity" : fmt::format("intensity {}", i + 1);
      channels.push_back(make_channel(name, "1", std::move(image), 1.0, path.string()));
      const std::uint64_t next = cursor.offset();
      place(channels.back(), light, header, cursor);
      cursor.seek(next);
    }
    if (channels.empty()) {
      throw InputError(path.string(), "holds neither phases nor intensities", kSaveAgain);
    }
    return channels;
  }
};

}  // namespace

const Reader& zygo_dat_reader() {
  static const ZygoDatReader reader;
  return reader;
}

}  // namespace manoscope::io

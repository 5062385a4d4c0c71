// Maps in TIFF: one sample a pixel, integers of 8 to 32 bits or floats of 32 and 64, one channel a
// page; of an ImageJ stack with one page alone, one channel a frame (tiff_stack.hpp).
//
// Source: TIFF revision 6.0; the BigTIFF design; the description lines of ImageJ as its FileInfo
// documents them. Rows from the top unless the orientation tag says otherwise. NaN = missing.
#include <fmt/format.h>

#include <cfenv>
#include <cmath>
#include <cstring>
#include <limits>

#include "manoscope/core/error.hpp"
#include "manoscope/io/byte_cursor.hpp"
#include "manoscope/io/file_text.hpp"
#include "manoscope/io/file_units.hpp"
#include "manoscope/io/formats.hpp"
#include "manoscope/io/tiff_handle.hpp"
#include "manoscope/io/tiff_header.hpp"
#include "manoscope/io/tiff_stack.hpp"

namespace manoscope::io {
namespace {

constexpr const char* kExportAgain = "Save the image again";
constexpr int kMostPages = 10000;
/// No packing of TIFF that is read here makes more of a byte.
constexpr double kBestPacking = 4000.0;
/// A tile of 256 x 256 64-bit floats.
constexpr double kLargePiece = 512.0 * 1024.0;

/// libtiff converts damaged numbers without looking: no floating-point trap while it works.
class NoTraps {
 public:
  NoTraps() { std::feholdexcept(&before_); }
  ~NoTraps() { std::fesetenv(&before_); }
  NoTraps(const NoTraps&) = delete;
  NoTraps& operator=(const NoTraps&) = delete;

 private:
  std::fenv_t before_{};
};

/// Tags of one page.
struct Page {
  std::uint32_t nx = 0, ny = 0;
  std::uint16_t bits = 1, samples = 1, format = SAMPLEFORMAT_UINT, compression = 1;
  std::uint16_t resolution_unit = RESUNIT_INCH, orientation = ORIENTATION_TOPLEFT;
  double x_resolution = 0.0, y_resolution = 0.0;
  std::string description;
  std::vector<std::pair<std::string, std::string>> settings;

  explicit Page(TIFF* tiff) {
    TIFFGetField(tiff, TIFFTAG_IMAGEWIDTH, &nx);
    TIFFGetField(tiff, TIFFTAG_IMAGELENGTH, &ny);
    TIFFGetFieldDefaulted(tiff, TIFFTAG_BITSPERSAMPLE, &bits);
    TIFFGetFieldDefaulted(tiff, TIFFTAG_SAMPLESPERPIXEL, &samples);
    TIFFGetFieldDefaulted(tiff, TIFFTAG_SAMPLEFORMAT, &format);
    TIFFGetFieldDefaulted(tiff, TIFFTAG_COMPRESSION, &compression);
    TIFFGetFieldDefaulted(tiff, TIFFTAG_RESOLUTIONUNIT, &resolution_unit);
    TIFFGetFieldDefaulted(tiff, TIFFTAG_ORIENTATION, &orientation);
    float resolution = 0.0F;
    if (TIFFGetField(tiff, TIFFTAG_XRESOLUTION, &resolution) == 1) x_resolution = resolution;
    if (TIFFGetField(tiff, TIFFTAG_YRESOLUTION, &resolution) == 1) y_resolution = resolution;
    const char* text = nullptr;
    if (TIFFGetField(tiff, TIFFTAG_IMAGEDESCRIPTION, &text) == 1 && text != nullptr) {
      description = text;
    }
    for (const auto& [tag, name] :
         {std::pair{TIFFTAG_MAKE, "maker"}, std::pair{TIFFTAG_MODEL, "model"},
          std::pair{TIFFTAG_SOFTWARE, "software"}, std::pair{TIFFTAG_DATETIME, "date"}}) {
      if (TIFFGetField(tiff, static_cast<std::uint32_t>(tag), &text) == 1 && text != nullptr) {
        settings.emplace_back(name, one_line(std::string_view(text).substr(0, 200)));
      }
    }
  }

  SampleType sample_type() const {
    if (is_float()) return bits == 32 ? SampleType::f32 : SampleType::f64;
    const bool is_signed = format == SAMPLEFORMAT_INT;
    if (bits == 8) return is_signed ? SampleType::i8 : SampleType::u8;
    if (bits == 16) return is_signed ? SampleType::i16 : SampleType::u16;
    return is_signed ? SampleType::i32 : SampleType::u32;
  }
  bool is_float() const { return format == SAMPLEFORMAT_IEEEFP; }
  std::uint64_t bytes() const { return bits / 8U; }
};

double value_at(const unsigned char* at, const Page& page) {
  std::uint64_t raw = 0;
  // libtiff has put the bytes in the order of this machine.
  if (page.bits == 8) {
    raw = *at;
  } else if (page.bits == 16) {
    std::uint16_t narrow = 0;
    std::memcpy(&narrow, at, 2);
    raw = narrow;
  } else if (page.bits == 32) {
    std::uint32_t narrow = 0;
    std::memcpy(&narrow, at, 4);
    raw = narrow;
  } else {
    std::memcpy(&raw, at, 8);
  }
  if (page.is_float()) {
    return page.bits == 32 ? double_from_f32_bits(static_cast<std::uint32_t>(raw))
                           : double_from_f64_bits(raw);
  }
  if (page.format == SAMPLEFORMAT_INT) {
    const unsigned unused = 64U - page.bits;
    return static_cast<double>(static_cast<std::int64_t>(raw << unused) >> unused);
  }
  return static_cast<double>(raw);
}

class TiffMap {
 public:
  TiffMap(const std::filesystem::path& path, const ReadOptions& options)
      : options_(options),
        path_(path),
        where_(path.string()),
        handle_(path),
        n_bytes_(std::filesystem::file_size(path)) {}

  std::vector<Channel> run() {
    std::vector<Channel> channels;
    int n_pages = 0, n_pictures = 0;
    bool more = true;
    while (more) {
      if (++n_pages > kMostPages) {
        throw InputError(where_, fmt::format("has more than {} pages", kMostPages), kExportAgain);
      }
      const std::string place = fmt::format("{}: page {}", where_, n_pages);
      const Page page = [&] {
        const NoTraps no_traps;
        return Page(handle_.get());
      }();
      const TiffDescription description = read_tiff_description(page.description, place);
      // ImageJ describes a stack on its first page.
      if (n_pages == 1) first_ = description;
      if (is_picture(page)) {
        ++n_pictures;
      } else {
        const TiffStack stack = n_pages == 1 ? frames(page, place) : TiffStack{};
        for (std::uint64_t frame = 0; frame < stack.n_frames; ++frame) {
          if (frame > 0) ++n_pages;
          if (options_.page != 0 && options_.page != n_pages) continue;
          channels.push_back(channel(page, place, stack, frame));
          channels.back().name = fmt::format("page {}", n_pages);
          channels.back().page = n_pages;
        }
      }
      const NoTraps no_traps;
      more = TIFFReadDirectory(handle_.get()) == 1;
    }
    if (const std::string reason = handle_.complaint(); !reason.empty()) {
      throw InputError(where_, fmt::format("after page {}: {}", n_pages, reason),
                       "The file is incomplete or damaged; copy or export it again");
    }
    if (channels.empty() && n_pictures < n_pages) {
      throw InputError(where_,
                       options_.page > n_pages
                           ? fmt::format("has no page {}; it has {}", options_.page, n_pages)
                           : fmt::format("its page {} is a picture", options_.page),
                       "Name a page of heights; `manoscope inspect` lists them");
    }
    if (channels.empty()) {
      throw InputError(
          where_,
          fmt::format("holds {} picture(s) of colours or 8-bit grey levels, no heights",
                      n_pictures),
          "Save the heights as 32-bit floats");
    }
    if (channels.size() == 1 && options_.page == 0) channels.front().name = "height";
    if (first_.n_images > n_pages) {
      channels.front().warnings.push_back(fmt::format(
          "a stack of {:g} images is announced, {} are read", first_.n_images, n_pages));
    }
    return channels;
  }

 private:
  bool is_picture(const Page& page) const {
    return page.samples != 1 || page.bits < 8 || (page.bits == 8 && !first_.has_calibration);
  }

  /// Of the first page.
  TiffStack frames(const Page& page, const std::string& place) const {
    const NoTraps no_traps;
    if (!first_.is_imagej || TIFFLastDirectory(handle_.get()) == 0) return {};
    const double frame_bytes =
        static_cast<double>(page.nx) * page.ny * static_cast<double>(page.bytes());
    // No number of frames of more bytes than the file has is looked for, and none overflows.
    if (!(frame_bytes < static_cast<double>(n_bytes_))) return {};
    const TiffStack stack = find_tiff_stack(handle_.get(), n_bytes_, first_.n_images,
                                            static_cast<std::uint64_t>(frame_bytes), place);
    if (stack.n_frames > kMostPages) {
      throw InputError(where_, fmt::format("has more than {} images", kMostPages), kExportAgain);
    }
    return stack;
  }

  void check(const Page& page, const std::string& place) {
    const bool integer = page.format == SAMPLEFORMAT_UINT || page.format == SAMPLEFORMAT_INT;
    if (!(integer && (page.bits == 8 || page.bits == 16 || page.bits == 32)) &&
        !(page.is_float() && (page.bits == 32 || page.bits == 64))) {
      throw InputError(place,
                       fmt::format("has samples of {} bits, format {}", page.bits, page.format),
                       "Save the heights as 32-bit floats");
    }
    switch (page.compression) {
      case COMPRESSION_NONE:
      case COMPRESSION_LZW:
      case COMPRESSION_PACKBITS:
      case COMPRESSION_ADOBE_DEFLATE:
      case COMPRESSION_DEFLATE:
        break;
      default:
        throw InputError(place, fmt::format("is packed by method {}", page.compression),
                         "Save the image without compression");
    }
    check_pixel_counts(page.nx, page.ny, place);
    // What all pages unpack to, against what is there to unpack.
    n_unpacked_ += static_cast<double>(page.nx) * page.ny * static_cast<double>(page.bytes());
    packing_ = std::max(packing_, page.compression == COMPRESSION_NONE ? 1.0 : kBestPacking);
    if (n_unpacked_ > packing_ * static_cast<double>(n_bytes_)) {
      throw InputError(place,
                       fmt::format("announces {} x {} pixels, more than {} bytes can hold", page.nx,
                                   page.ny, n_bytes_),
                       "The file is incomplete or damaged; copy or export it again");
    }
  }

  [[noreturn]] void fail(const std::string& place) const {
    throw InputError(place, fmt::format("cannot be read: {}", handle_.complaint()),
                     "The file is incomplete or damaged; copy or export it again");
  }

  /// Makes room for row `iy` and some more. Rows that are not packed have all their bytes in the
  /// file (see check()): room for all. Packed ones get it as they come, since an announced size
  /// alone shall fill no memory.
  void grow(const Page& page, Array2& values, Index iy) const {
    if (iy < values.rows()) return;
    const auto n_justified = static_cast<Index>(n_bytes_ / (8 * std::uint64_t{page.nx}));
    const Index n_first = page.compression == COMPRESSION_NONE ? page.ny : n_justified;
    const Index wanted = std::max({iy + 1, 2 * iy, n_first});
    values.conservativeResize(std::min<Index>(wanted, page.ny), page.nx);
  }

  /// What unpacks as a whole, a row or a tile, is small or explained by the file's size.
  void check_piece(double n_bytes, const char* what, const std::string& place) const {
    const double most = std::max(kLargePiece, 2.0 * static_cast<double>(n_bytes_));
    if (n_bytes > most) {
      throw InputError(
          place,
          fmt::format("a {} of it has {:.0f} bytes, in a file of {}", what, n_bytes, n_bytes_),
          "Save the image without compression");
    }
  }

  void read_rows(const Page& page, Array2& values, const std::string& place) const {
    const NoTraps no_traps;
    TIFF* tiff = handle_.get();
    const std::uint64_t row_bytes = page.nx * page.bytes();
    if (TIFFScanlineSize64(tiff) != row_bytes) fail(place);
    check_piece(static_cast<double>(row_bytes), "row", place);
    std::vector<unsigned char> row(row_bytes);
    for (std::uint32_t iy = 0; iy < page.ny; ++iy) {
      if (TIFFReadScanline(tiff, row.data(), iy, 0) != 1) fail(place);
      grow(page, values, iy);
      for (std::uint32_t ix = 0; ix < page.nx; ++ix) {
        values(iy, ix) = value_at(row.data() + ix * page.bytes(), page);
      }
    }
  }

  void read_tiles(const Page& page, Array2& values, const std::string& place) const {
    const NoTraps no_traps;
    TIFF* tiff = handle_.get();
    std::uint32_t width = 0, height = 0;
    TIFFGetField(tiff, TIFFTAG_TILEWIDTH, &width);
    TIFFGetField(tiff, TIFFTAG_TILELENGTH, &height);
    const double tile_bytes =
        static_cast<double>(width) * height * static_cast<double>(page.bytes());
    if (width == 0 || height == 0 || static_cast<double>(TIFFTileSize64(tiff)) != tile_bytes) {
      fail(place);
    }
    check_piece(tile_bytes, "tile", place);
    std::vector<unsigned char> tile(static_cast<std::size_t>(tile_bytes));
    for (std::uint32_t y0 = 0; y0 < page.ny; y0 += height) {
      for (std::uint32_t x0 = 0; x0 < page.nx; x0 += width) {
        const std::uint32_t number = TIFFComputeTile(tiff, x0, y0, 0, 0);
        if (TIFFReadEncodedTile(tiff, number, tile.data(), static_cast<tmsize_t>(tile.size())) !=
            static_cast<tmsize_t>(tile.size())) {
          fail(place);
        }
        grow(page, values, std::min(page.ny, y0 + height) - 1);
        for (std::uint32_t iy = y0; iy < std::min(page.ny, y0 + height); ++iy) {
          for (std::uint32_t ix = x0; ix < std::min(page.nx, x0 + width); ++ix) {
            const std::size_t at = static_cast<std::size_t>(iy - y0) * width + (ix - x0);
            values(iy, ix) = value_at(tile.data() + at * page.bytes(), page);
          }
        }
        if (page.nx - x0 <= width) break;
      }
      if (page.ny - y0 <= height) break;
    }
  }

  /// 0 where the tags hold no scale, or only the resolution of a screen or printer.
  Length pitch(const Page& page, double resolution, const std::optional<double>& written,
               Channel& channel, const std::string& place) const {
    if (written) return Length::from_si(checked_pitch(*written, "its description", place));
    if (!(std::isfinite(resolution) && resolution > 1e-30 && resolution < 1e30)) return {};
    const std::string unit =
        !first_.lateral_unit.empty() ? first_.lateral_unit : options_.lateral_unit;
    if (first_.is_imagej || page.resolution_unit == RESUNIT_NONE) {
      // Without a calibration ImageJ writes 1 pixel per pixel.
      const auto scale = length_scale(unit);
      if (!scale || !(scale->factor < 1e30)) return {};
      return Length::from_si(checked_pitch(scale->factor / resolution, "its resolution", place));
    }
    for (const double screen : {72.0, 96.0, 100.0, 150.0, 200.0, 300.0, 400.0, 600.0, 1200.0}) {
      if (page.resolution_unit == RESUNIT_INCH && std::abs(resolution / screen - 1.0) < 1e-4) {
        channel.warnings.push_back(fmt::format(
            "its resolution of {:g} dots per inch is that of a screen or printer and is "
            "not taken for the size of a pixel",
            screen));
        return {};
      }
    }
    const double unit_m = page.resolution_unit == RESUNIT_CENTIMETER ? 1e-2 : 25.4e-3;
    return Length::from_si(checked_pitch(unit_m / resolution, "its resolution", place));
  }

  Channel channel(const Page& page, const std::string& place, const TiffStack& stack,
                  std::uint64_t frame) {
    check(page, place);
    Channel channel;
    channel.grid.nx = page.nx;
    channel.grid.ny = page.ny;
    channel.settings = page.settings;
    channel.settings.insert(channel.settings.end(), first_.settings.begin(), first_.settings.end());
    channel.grid.pitch_x = pitch(page, page.x_resolution, first_.pitch_x_m, channel, place);
    channel.grid.pitch_y = pitch(page, page.y_resolution, first_.pitch_y_m, channel, place);
    if (frame > 0) {
      channel.values =
          read_tiff_frame(path_, handle_.get(), stack, frame, page.sample_type(), page.nx, page.ny);
    } else if (TIFFIsTiled(handle_.get()) != 0) {
      read_tiles(page, channel.values, place);
    } else {
      read_rows(page, channel.values, place);
    }
    const bool mirrored =
        page.orientation == ORIENTATION_TOPRIGHT || page.orientation == ORIENTATION_BOTRIGHT;
    const bool upside_down =
        page.orientation == ORIENTATION_BOTLEFT || page.orientation == ORIENTATION_BOTRIGHT;
    if (mirrored) channel.values.rowwise().reverseInPlace();
    if (upside_down) channel.values.colwise().reverseInPlace();
    if (page.orientation > ORIENTATION_BOTLEFT) {
      channel.warnings.emplace_back(
          "its orientation tag asks for a transposed display; read as stored");
    }
    scale_values(channel.values, UnitScale{first_.value_factor, first_.value_offset}, place);
    channel.file_unit = first_.value_unit;
    const SiUnit unit = si_unit(first_.value_unit, place);
    channel.unit = unit.name;
    scale_values(channel.values, unit.scale, place);
    return channel;
  }

  const ReadOptions& options_;
  std::filesystem::path path_;
  std::string where_;
  TiffHandle handle_;
  std::uintmax_t n_bytes_;
  TiffDescription first_;
  double n_unpacked_ = 0.0, packing_ = 1.0;
};

class TiffReader final : public Reader {
 public:
  std::string_view name() const override { return "tiff"; }
  std::string_view description() const override { return "TIFF"; }
  std::vector<std::string> extensions() const override { return {".tif", ".tiff"}; }

  std::string_view orientation() const override {
    return "as its orientation tag says, heights positive upwards, as the file has them";
  }

  int score(const Probe& probe) const override {
    for (const std::string_view magic :
         {std::string_view("II*\0", 4), std::string_view("MM\0*", 4), std::string_view("II+\0", 4),
          std::string_view("MM\0+", 4)}) {
      if (probe.head.starts_with(magic)) return 60;  // formats of their own are built on it
    }
    return 0;
  }

  std::vector<Channel> read(const std::filesystem::path& path,
                            const ReadOptions& options) const override {
    return TiffMap(path, options).run();
  }
};

}  // namespace

const Reader& tiff_reader() {
  static const TiffReader reader;
  return reader;
}

}  // namespace manoscope::io

// Wyko's "ASCII Data File Format" (.asc), as Vision exports it.
//
// Source: the layout as the Gwyddion project and SurfaceTopography's documentation describe it. A
// magic line with three flags (the second: 1 = heights in nm, 0 = in wavelengths), the lines X Size
// and Y Size, then blocks of one line "name, type, length, value" parted by tabs. A block of data
// has X Size lines, one a column from the left, each with the column's Y Size values from the
// bottom row to the top one; "Bad" = missing. Pixel_size is in mm, Wavelength in nm; heights in
// wavelengths are divided by Mult. Heights are positive towards the instrument.
#include <fmt/format.h>

#include <algorithm>
#include <array>
#include <cmath>
#include <limits>
#include <map>

#include "manoscope/core/error.hpp"
#include "manoscope/core/provenance.hpp"
#include "manoscope/core/unit_text.hpp"
#include "manoscope/io/file_text.hpp"
#include "manoscope/io/file_units.hpp"
#include "manoscope/io/formats.hpp"
#include "manoscope/io/text_cells.hpp"

namespace manoscope::io {
namespace {

constexpr std::string_view kMagic = "Wyko ASCII Data File Format";
constexpr const char* kExportAgain = "Export the map from Vision again";
constexpr std::array<std::string_view, 4> kHeights{"OPD", "SAMPLE_DATA", "RAW_DATA", "RAW DATA"};
constexpr std::array<std::string_view, 3> kPictures{"Image", "Intensity", "SecArr_0"};

template <std::size_t N>
bool is_one_of(std::string_view name, const std::array<std::string_view, N>& names) {
  return std::find(names.begin(), names.end(), name) != names.end();
}

class WykoAscii {
 public:
  WykoAscii(std::string_view text, std::string where)
      : lines_(text), n_bytes_(text.size()), where_(std::move(where)) {}

  std::vector<Channel> run() {
    std::string_view line;
    lines_.next(line);
    read_flags(line.substr(std::min(line.size(), kMagic.size())));
    while (lines_.next(line)) {
      if (strip(line).empty()) continue;
      std::array<std::string_view, 4> cells{};
      Cells rest(line, '\t');
      for (std::string_view& cell : cells) {
        if (!rest.next(cell)) break;
      }
      const std::string_view name = cells[0];
      if (name == "X Size" || name == "Y Size") {
        (name == "X Size" ? nx_ : ny_) = number(cells[1], name);
      } else if (is_one_of(name, kHeights) || is_one_of(name, kPictures)) {
        channels_.push_back(read_block(name));
      } else if (name != "Block Name" && !cells[3].empty()) {
        fields_[std::string(name.substr(0, 100))] = std::string(cells[3].substr(0, 1000));
      }
    }
    if (channels_.empty()) throw InputError(where_, "holds no block of heights", kExportAgain);
    for (Channel& channel : channels_) {
      for (const auto& [name, value] : fields_) {
        channel.settings.emplace_back(one_line(name), one_line(value));
      }
    }
    return std::move(channels_);
  }

 private:
  std::string place() const { return fmt::format("{}:{}", where_, lines_.number()); }

  void read_flags(std::string_view flags) {
    Cells cells(flags, ' ');
    std::string_view cell;
    cells.next(cell);
    if (cells.next(cell)) in_nm_ = cell == "1";
  }

  double number(std::string_view text, std::string_view name) const {
    const auto value = parse_number(text);
    if (!value || !std::isfinite(*value) || std::abs(*value) > 1e30) {
      throw InputError(place(), fmt::format("{} is \"{}\", not a number", name, excerpt(text)),
                       kExportAgain);
    }
    return *value;
  }

  double field(const std::string& name, double otherwise) const {
    const auto found = fields_.find(name);
    return found == fields_.end() ? otherwise : number(found->second, name);
  }

  /// Factor from the numbers of the file to m.
  double height_scale() const {
    if (in_nm_) return 1e-9;
    const double wavelength = field("Wavelength", 0.0), mult = field("Mult", 1.0);
    if (!(wavelength > 0.0) || mult == 0.0) {
      throw InputError(where_,
                       "gives its heights in wavelengths, but no Wavelength (or a Mult of 0)",
                       kExportAgain);
    }
    return wavelength * 1e-9 / mult;
  }

  Channel read_block(std::string_view name) {
    if (nx_ != std::floor(nx_) || ny_ != std::floor(ny_)) nx_ = 0.0;
    check_pixel_counts(nx_, ny_, where_);
    // A digit and a delimiter each; every block takes its own share of the file.
    n_values_ += nx_ * ny_;
    if (n_values_ > 0.5 * static_cast<double>(n_bytes_) + 1.0) {
      throw InputError(
          place(),
          fmt::format("announces {:.10g} x {:.10g} pixels in {} bytes", nx_, ny_, n_bytes_),
          "The file is incomplete; copy or export it again");
    }
    Channel channel;
    channel.name = std::string(name);
    channel.grid.nx = static_cast<Index>(nx_);
    channel.grid.ny = static_cast<Index>(ny_);
    const double pixel_mm = field("Pixel_size", 0.0), aspect = field("Aspect", 1.0);
    if (pixel_mm != 0.0) {
      channel.grid.pitch_x = Length::from_si(checked_pitch(pixel_mm * 1e-3, "Pixel_size", where_));
      channel.grid.pitch_y = Length::from_si(
          checked_pitch(pixel_mm * 1e-3 * (aspect == 0.0 ? 1.0 : aspect), "Aspect", where_));
    }
    const bool heights = is_one_of(name, kHeights);
    const double scale = heights ? height_scale() : 1.0;
    channel.unit = heights ? "m" : "1";
    channel.file_unit = heights && in_nm_ ? "nm" : "";
    channel.values.resize(channel.grid.ny, channel.grid.nx);
    for (Index ix = 0; ix < channel.grid.nx; ++ix) read_column(channel.values, ix);
    scale_values(channel.values, UnitScale{scale, 0.0}, where_);
    return channel;
  }

  void read_column(Array2& values, Index ix) {
    std::string_view line;
    if (!lines_.next(line)) {
      throw InputError(where_, fmt::format("ends after {} of {} columns", ix, values.cols()),
                       "The file is incomplete; copy or export it again");
    }
    Cells cells(line, ' ');
    std::string_view cell;
    for (Index iy = values.rows() - 1; iy >= 0; --iy) {
      const auto value = cells.next(cell) && !cell.empty() ? cell_value(cell, true) : std::nullopt;
      if (!value) {
        throw InputError(place(),
                         fmt::format("\"{}\" is where height {} of {} should be", excerpt(cell),
                                     values.rows() - iy, values.rows()),
                         kExportAgain);
      }
      values(iy, ix) = *value;
    }
    if (cells.next(cell)) {
      throw InputError(place(), fmt::format("has more than {} heights", values.rows()),
                       kExportAgain);
    }
  }

  Lines lines_;
  std::size_t n_bytes_;
  std::string where_;
  double nx_ = 0.0, ny_ = 0.0, n_values_ = 0.0;
  bool in_nm_ = false;
  std::map<std::string, std::string> fields_;
  std::vector<Channel> channels_;
};

class WykoAsciiReader final : public Reader {
 public:
  std::string_view name() const override { return "wyko-ascii"; }
  std::string_view description() const override { return "Wyko ASCII text"; }
  std::vector<std::string> extensions() const override { return {".asc"}; }
  std::string_view orientation() const override {
    return "last value of a column on top, heights positive towards the instrument";
  }
  int score(const Probe& probe) const override { return probe.head.starts_with(kMagic) ? 100 : 0; }

  std::vector<Channel> read(const std::filesystem::path& path, const ReadOptions&) const override {
    const std::string text = read_file(path);
    if (!text.starts_with(kMagic)) {
      throw InputError(path.string(), "does not begin with \"Wyko ASCII Data File Format\"",
                       kExportAgain);
    }
    return WykoAscii(text, path.string()).run();
  }
};

}  // namespace

const Reader& wyko_ascii_reader() {
  static const WykoAsciiReader reader;
  return reader;
}

}  // namespace manoscope::io

// Zygo's "XYZ Data File - Format 1" (.xyz), as MetroPro exports it.
//
// Source: the MetroPro reference guide's description of ASCII data files. Fourteen header lines,
// then "#", then one line a pixel: column, row, height in um or "No Data"; then "#". Line 4 places
// the phase window in the camera frame, line 8 holds the size of a pixel in m. Row 0 of the camera
// is the top one; heights are positive towards the instrument.
#include <fmt/format.h>

#include <array>
#include <cmath>
#include <limits>

#include "manoscope/core/error.hpp"
#include "manoscope/core/provenance.hpp"
#include "manoscope/core/unit_text.hpp"
#include "manoscope/io/file_text.hpp"
#include "manoscope/io/file_units.hpp"
#include "manoscope/io/formats.hpp"
#include "manoscope/io/text_cells.hpp"

namespace manoscope::io {
namespace {

constexpr std::string_view kMagic = "Zygo XYZ Data File";
constexpr const char* kExportAgain = "Export the map from MetroPro again";

/// Number `which` (from 0) of a line of numbers.
double number_in(std::string_view line, std::size_t which, const std::string& where) {
  Cells cells(line, ' ');
  std::string_view cell;
  for (std::size_t i = 0; i <= which; ++i) {
    if (!cells.next(cell)) {
      throw InputError(where, fmt::format("has fewer than {} numbers", which + 1), kExportAgain);
    }
  }
  const auto value = parse_number(cell);
  if (!value || !std::isfinite(*value) || std::abs(*value) > 1e15) {
    throw InputError(where, fmt::format("\"{}\" is not a number", excerpt(cell)), kExportAgain);
  }
  return *value;
}

std::string unquoted(std::string_view line) {
  std::string_view bare = trimmed(line);
  if (bare.size() > 1 && bare.front() == '"' && bare.back() == '"') {
    bare = bare.substr(1, bare.size() - 2);
  }
  return one_line(trimmed(bare).substr(0, 1000));
}

class ZygoXyz {
 public:
  ZygoXyz(std::string_view text, std::string where)
      : lines_(text), n_bytes_(text.size()), where_(std::move(where)) {}

  Channel run() {
    read_header();
    std::string_view line;
    Index n_lines = 0;
    while (lines_.next(line)) {
      const std::string_view bare = strip(line);
      if (bare.starts_with('#')) return finish(n_lines);
      if (bare.empty()) continue;
      if (++n_lines > channel_.values.size()) {
        throw InputError(place(), fmt::format("more than {} pixels follow", channel_.values.size()),
                         kExportAgain);
      }
      read_pixel(bare);
    }
    throw InputError(where_, "no # ends its heights",
                     "The file is incomplete; copy or export it again");
  }

 private:
  std::string place() const { return fmt::format("{}:{}", where_, lines_.number()); }

  void read_header() {
    std::array<double, 4> window{};
    bool ended = false;
    std::string_view line;
    while (!ended && lines_.next(line)) {
      ended = strip(line) == "#";
      const int number = lines_.number();
      if (number == 4) {
        for (std::size_t i = 0; i < window.size(); ++i) window[i] = number_in(line, i, place());
      } else if (number == 5) {
        add("comment", unquoted(line));
      } else if (number == 6) {
        add("part serial number", unquoted(line));
      } else if (number == 7) {
        add("part", unquoted(line));
      } else if (number == 8) {
        add("wavelength", fmt::format("{:g} m", number_in(line, 2, place())));
        add("magnification", fmt::format("{:g}", number_in(line, 5, place())));
        pitch_ = number_in(line, 6, place());
      }
    }
    if (!ended || lines_.number() < 9) {
      throw InputError(where_, "its header is cut off or of another layout", kExportAgain);
    }
    for (const double value : window) {
      if (value < 0.0 || value > 1e7 || value != std::floor(value)) {
        throw InputError(where_ + ":4", fmt::format("{} is not a number of pixels", value),
                         kExportAgain);
      }
    }
    check_pixel_counts(window[2], window[3], where_);
    // "0 0 1" and a line end at least for each.
    if (window[2] * window[3] > static_cast<double>(n_bytes_) / 6.0 + 1.0) {
      throw InputError(
          where_,
          fmt::format("announces {} x {} pixels in {} bytes", window[2], window[3], n_bytes_),
          "The file is incomplete; copy or export it again");
    }
    channel_.offset_x = static_cast<Index>(window[0]);
    channel_.offset_y = static_cast<Index>(window[1]);
    channel_.grid.nx = static_cast<Index>(window[2]);
    channel_.grid.ny = static_cast<Index>(window[3]);
    if (pitch_ != 0.0) {
      channel_.grid.pitch_x = channel_.grid.pitch_y =
          Length::from_si(checked_pitch(pitch_, "CameraRes in line 8", where_));
    }
    channel_.values = Array2::Constant(channel_.grid.ny, channel_.grid.nx,
                                       std::numeric_limits<double>::quiet_NaN());
  }

  void add(const char* name, std::string value) {
    if (!value.empty()) channel_.settings.emplace_back(name, std::move(value));
  }

  void read_pixel(std::string_view line) {
    const double column = number_in(line, 0, place()) - static_cast<double>(channel_.offset_x);
    const double row = number_in(line, 1, place()) - static_cast<double>(channel_.offset_y);
    if (!(column >= 0.0 && column < static_cast<double>(channel_.grid.nx) && row >= 0.0 &&
          row < static_cast<double>(channel_.grid.ny)) ||
        column != std::floor(column) || row != std::floor(row)) {
      throw InputError(
          place(),
          fmt::format("\"{}\" lies outside the window that line 4 announces", excerpt(line)),
          kExportAgain);
    }
    if (line.find("No") != std::string_view::npos) return;
    channel_.values(static_cast<Index>(row), static_cast<Index>(column)) =
        number_in(line, 2, place());
  }

  Channel finish(Index n_lines) {
    if (n_lines != channel_.values.size()) {
      channel_.warnings.push_back(
          fmt::format("{} of its {} pixels are listed; the others are missing", n_lines,
                      channel_.values.size()));
    }
    channel_.name = "height";
    channel_.unit = "m";
    channel_.file_unit = "um";
    scale_values(channel_.values, UnitScale{1e-6, 0.0}, where_);
    return std::move(channel_);
  }

  Lines lines_;
  std::size_t n_bytes_;
  std::string where_;
  double pitch_ = 0.0;
  Channel channel_;
};

class ZygoXyzReader final : public Reader {
 public:
  std::string_view name() const override { return "zygo-xyz"; }
  std::string_view description() const override { return "Zygo XYZ text"; }
  std::vector<std::string> extensions() const override { return {".xyz"}; }
  std::string_view orientation() const override {
    return "row 0 of the camera on top, heights positive towards the instrument";
  }
  int score(const Probe& probe) const override { return probe.head.starts_with(kMagic) ? 100 : 0; }

  std::vector<Channel> read(const std::filesystem::path& path, const ReadOptions&) const override {
    const std::string text = read_file(path);
    if (!text.starts_with(kMagic)) {
      throw InputError(path.string(), "does not begin with \"Zygo XYZ Data File\"", kExportAgain);
    }
    std::vector<Channel> channels;
    channels.push_back(ZygoXyz(text, path.string()).run());
    return channels;
  }
};

}  // namespace

const Reader& zygo_xyz_reader() {
  static const ZygoXyzReader reader;
  return reader;
}

}  // namespace manoscope::io

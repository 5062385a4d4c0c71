// Zygo Mx (.datx): HDF5. In the process that reads HDF5 alone.
//
// Zygo publishes no description; the layout is as the open readers of prysm and SurfaceTopography
// find it. Data/Surface/<id> holds the heights, the top row first, with the attributes
//
//   Unit                        "NanoMeters", ..., or "Fringes"
//   No Data                     values from here on are missing
//   X Converter, Y Converter    {category, unit, parameters}: parameters[1] = m a pixel
//   Wavelength [m], Interferometric Scale Factor, Obliquity Factor
//
//   height = value * wavelength * scale factor * obliquity factor        (of Fringes)
//
// Data/Intensity/<id> holds a picture, Attributes/<id> what the instrument was set to.
#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <numbers>

#include "manoscope/core/error.hpp"
#include "manoscope/io/file_text.hpp"
#include "manoscope/io/file_units.hpp"
#include "manoscope/io/hdf5_file.hpp"
#include "manoscope/io/hdf5_formats.hpp"

namespace manoscope::io {
namespace {

constexpr const char* kSaveAgain = "Save it again in Mx, with the surface";

bool lies_in(const std::string& path, const std::string& kind) {
  return path.starts_with("Data/" + kind + "/") || path == "Measurement/" + kind;
}

class DatxMap {
 public:
  explicit DatxMap(const std::filesystem::path& path) : file_(path) {}

  bool is_datx() const {
    return std::any_of(file_.datasets().begin(), file_.datasets().end(), [&](const auto& set) {
      return lies_in(set.path, "Surface") &&
             (file_.converter(set.path, "Z Converter") || file_.text_attribute(set.path, "Unit"));
    });
  }

  std::vector<Channel> channels() const {
    std::vector<Channel> found;
    for (const char* kind : {"Surface", "Intensity"}) {
      const std::size_t first = found.size();
      for (const Hdf5File::Dataset& set : file_.datasets()) {
        if (!lies_in(set.path, kind) || !set.numeric || set.shape.size() != 2) continue;
        found.push_back(channel(set, kind));
      }
      if (found.size() - first < 2) continue;
      for (std::size_t i = first; i < found.size(); ++i) {
        found[i].name = fmt::format("{} {}", kind, i - first + 1);
      }
    }
    const bool any_heights = std::any_of(found.begin(), found.end(), [](const Channel& channel) {
      return channel.name.starts_with("Surface");
    });
    if (!any_heights) {
      throw InputError(file_.where(), "holds no surface of two dimensions", kSaveAgain);
    }
    return found;
  }

 private:
  Channel channel(const Hdf5File::Dataset& set, const std::string& kind) const {
    const std::string place = file_.where() + ": " + kind;
    Channel channel;
    channel.name = kind;
    check_pixel_counts(static_cast<double>(set.shape[1]), static_cast<double>(set.shape[0]), place);
    channel.grid.nx = static_cast<Index>(set.shape[1]);
    channel.grid.ny = static_cast<Index>(set.shape[0]);
    channel.grid.pitch_x = pitch(set, "X Converter", place);
    channel.grid.pitch_y = pitch(set, "Y Converter", place);
    channel.values.resize(channel.grid.ny, channel.grid.nx);
    file_.read(set, std::nullopt, channel.values.data());
    drop_missing(set, channel.values);
    channel.offset_x = offset(set, "ColumnStart");
    channel.offset_y = offset(set, "RowStart");
    channel.settings = file_.settings(set.path);
    for (const std::string& group : file_.groups()) {
      if (!group.starts_with("Attributes/")) continue;
      const auto more = file_.settings(group);
      channel.settings.insert(channel.settings.end(), more.begin(), more.end());
    }
    UnitScale scale;
    if (kind == "Surface") {
      scale = height_scale(set, channel, place);
    } else {
      channel.unit = "1";
    }
    scale_values(channel.values, scale, place);
    return channel;
  }

  void drop_missing(const Hdf5File::Dataset& set, Array2& values) const {
    const auto no_data = file_.number_attribute(set.path, "No Data");
    if (!no_data || std::isnan(*no_data)) return;
    for (Index i = 0; i < values.size(); ++i) {
      double& value = values.data()[i];
      if (!std::isnan(value) && value >= *no_data) {
        value = std::numeric_limits<double>::quiet_NaN();
      }
    }
  }

  UnitScale height_scale(const Hdf5File::Dataset& set, Channel& channel,
                         const std::string& place) const {
    std::string unit = file_.text_attribute(set.path, "Unit").value_or("");
    const auto converter = file_.converter(set.path, "Z Converter");
    if (unit.empty() && converter) unit = converter->unit;
    channel.file_unit = unit;
    const std::string small = lower_case(unit);
    if (small == "fringes" || small == "fringeradians") {
      const auto wavelength = file_.number_attribute(set.path, "Wavelength");
      const auto factor = file_.number_attribute(set.path, "Interferometric Scale Factor");
      if (!wavelength || !factor) {
        throw InputError(place, "is in fringes and names no wavelength or no scale factor",
                         kSaveAgain);
      }
      const double obliquity = file_.number_attribute(set.path, "Obliquity Factor").value_or(1.0);
      channel.unit = "m";
      const double radians = small == "fringes" ? 1.0 : 2.0 * std::numbers::pi;
      return {*wavelength * *factor * obliquity / radians, 0.0};
    }
    // Unit names of the file are words: NanoMeters, MicroInches.
    if (const auto length = length_scale(small)) {
      channel.unit = "m";
      return *length;
    }
    channel.warnings.push_back(
        fmt::format("its heights are in \"{}\", which is no known unit", excerpt(unit)));
    channel.file_unit.clear();
    return {};
  }

  Length pitch(const Hdf5File::Dataset& set, const char* converter_name,
               const std::string& place) const {
    const auto converter = file_.converter(set.path, converter_name);
    if (converter && lower_case(converter->unit) == "pixels" && converter->parameters.size() > 1 &&
        std::isfinite(converter->parameters[1]) && converter->parameters[1] > 0.0) {
      return Length::from_si(checked_pitch(converter->parameters[1], converter_name, place));
    }
    for (const std::string& group : file_.groups()) {
      if (!group.starts_with("Attributes/")) continue;
      const std::string name = "Data Context.Lateral Resolution:";
      const auto value = file_.number_attribute(group, name + "Value");
      if (!value || !std::isfinite(*value) || !(*value > 0.0)) continue;
      const auto unit = file_.text_attribute(group, name + "Unit");
      const auto scale = unit ? length_scale(lower_case(*unit)) : std::nullopt;
      const double pitch_m = scale && scale->factor < 1e30 ? *value * scale->factor : *value;
      return Length::from_si(checked_pitch(pitch_m, "Lateral Resolution", place));
    }
    return {};
  }

  Index offset(const Hdf5File::Dataset& set, const char* name) const {
    constexpr double kMost = 1e6;
    const auto start = file_.member(set.path, "Coordinates", name);
    if (!start || !std::isfinite(*start) || std::abs(*start) > kMost) return 0;
    return static_cast<Index>(*start);
  }

  Hdf5File file_;
};

}  // namespace

bool is_zygo_datx(const std::filesystem::path& path) { return DatxMap(path).is_datx(); }

std::vector<Channel> parse_zygo_datx(const std::filesystem::path& path, const ReadOptions&) {
  return DatxMap(path).channels();
}

}  // namespace manoscope::io

#pragma once

#include <optional>
#include <string>
#include <string_view>
#include <utility>
#include <vector>

namespace manoscope::io {

/// What the image description of a TIFF file says of scale and values: lines `key=value` as ImageJ
/// writes them, and our own pitch_x_m and pitch_y_m.
struct TiffDescription {
  bool is_imagej = false;
  std::string lateral_unit;                       ///< "" if none or counted in pixels
  std::string value_unit;                         ///< "" if none
  double value_offset = 0.0, value_factor = 1.0;  ///< value = offset + factor * stored
  bool has_calibration = false;                   ///< of the values
  std::optional<double> pitch_x_m, pitch_y_m;
  double n_images = 1.0;
  std::vector<std::pair<std::string, std::string>> settings;
};

/// @throws InputError(where, ...) for a calibration that is not a straight line or not finite.
TiffDescription read_tiff_description(std::string_view text, const std::string& where);

}  // namespace manoscope::io

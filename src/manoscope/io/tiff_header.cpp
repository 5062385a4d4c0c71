#include "manoscope/io/tiff_header.hpp"

#include <fmt/format.h>

#include <cmath>

#include "manoscope/core/error.hpp"
#include "manoscope/core/unit_text.hpp"
#include "manoscope/io/file_text.hpp"

namespace manoscope::io {
namespace {

constexpr std::size_t kMostSettings = 200;

/// ImageJ writes a micro sign as the six letters \u00B5.
std::string plain_unit(std::string_view text) {
  std::string unit(trimmed(text));
  for (const char* escape : {"\\u00B5", "\\u00b5"}) {
    const auto at = unit.find(escape);
    if (at != std::string::npos) unit.replace(at, 6, "\xC2\xB5");
  }
  const std::string small = lower_case(unit);
  if (small == "pixel" || small == "pixels" || small == "gray value") return {};
  return unit;
}

}  // namespace

TiffDescription read_tiff_description(std::string_view text, const std::string& where) {
  TiffDescription found;
  found.is_imagej = text.starts_with("ImageJ=");
  double function = 0.0;
  while (!text.empty()) {
    const auto end = text.find_first_of("\r\n");
    const std::string_view line = text.substr(0, end);
    text.remove_prefix(end == std::string_view::npos ? text.size() : end + 1);
    const auto equals = line.find('=');
    if (equals == std::string_view::npos) {
      if (!trimmed(line).empty() && found.settings.size() < kMostSettings) {
        found.settings.emplace_back("description", one_line(trimmed(line).substr(0, 1000)));
      }
      continue;
    }
    const std::string_view key = trimmed(line.substr(0, equals));
    const std::string_view value = trimmed(line.substr(equals + 1));
    const auto number = [&] {
      const auto parsed = parse_number(value);
      if (!parsed || !(std::abs(parsed.value_or(0.0)) < 1e30)) {
        throw InputError(where,
                         fmt::format("its description says {} = \"{}\", not a number", excerpt(key),
                                     excerpt(value)),
                         "Save the image again");
      }
      return *parsed;
    };
    const bool ours = key == "pitch_x_m" || key == "pitch_y_m";
    if (ours) {
      (key == "pitch_x_m" ? found.pitch_x_m : found.pitch_y_m) = number();
    } else if (!found.is_imagej) {
    } else if (key == "unit") {
      found.lateral_unit = plain_unit(value);
    } else if (key == "vunit") {
      found.value_unit = plain_unit(value);
    } else if (key == "images") {
      found.n_images = number();
    } else if (key == "cf") {
      function = number();
    } else if (key == "c0") {
      found.value_offset = number();
    } else if (key == "c1") {
      found.value_factor = number();
      found.has_calibration = true;
    }
    if (found.settings.size() < kMostSettings) {
      found.settings.emplace_back(one_line(key.substr(0, 100)), one_line(value.substr(0, 1000)));
    }
  }
  // ImageJ numbers its calibration functions; 0 is the straight line c0 + c1 v.
  if (found.has_calibration && function != 0.0) {
    throw InputError(where,
                     fmt::format("its values are calibrated by ImageJ's function {}, which is no "
                                 "straight line",
                                 function),
                     "Save the image with a linear calibration, or as 32-bit heights");
  }
  if (!found.has_calibration) found.value_offset = 0.0;
  return found;
}

}  // namespace manoscope::io

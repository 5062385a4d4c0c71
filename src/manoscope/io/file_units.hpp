#pragma once

#include <optional>
#include <string>
#include <string_view>

#include "manoscope/core/arrays.hpp"
#include "manoscope/core/unit_text.hpp"

namespace manoscope::io {

/// An SI unit and how to reach it from the unit a file names.
struct SiUnit {
  std::string name;  ///< "m", "V", "1", ... or the file's own unit where no SI name is listed
  UnitScale scale;
};

/// The unit text of an instrument file in the spelling that udunits-2 knows: blanks trimmed, a
/// Latin-1 micro or Angstrom sign made UTF-8, "microns" and the like made "micron".
std::string unit_from_file(std::string_view text);

/// Scale of a length unit towards m, nullopt if the text is no length.
std::optional<UnitScale> length_scale(std::string_view unit);

/// The SI unit of the same dimension as `unit`; an empty text stays empty, with scale 1.
/// @throws InputError(where, ...) if udunits-2 does not know the unit.
SiUnit si_unit(std::string_view unit, const std::string& where);

/// Values in SI above this count as missing: no instrument means them, programs mark holes by them,
/// and their squares would overflow.
inline constexpr double kLargestValue = 1e100;

/// Carries values to SI in place; what is not finite, or above kLargestValue, becomes NaN.
/// @throws InputError(where, ...) if the scale is absurd (beyond 1e-30 ... 1e30).
void scale_values(Array2& values, const UnitScale& scale, const std::string& where);

/// The largest map accepted, in pixels.
inline constexpr double kMostPixels = 1e9;

/// @throws InputError(where, ...) unless both counts are at least 1 and together at most
///         kMostPixels.
void check_pixel_counts(double nx, double ny, const std::string& where);

/// An untrusted number for a message: to print a NaN raises the invalid-operation exception in
/// libfmt.
std::string number_text(double value);

/// A pixel size in m from the size of n pixels.
/// @throws InputError(where, ...) unless it is finite, positive and between 1e-12 m and 1e3 m.
double checked_pitch(double pitch_m, std::string_view what, const std::string& where);

}  // namespace manoscope::io

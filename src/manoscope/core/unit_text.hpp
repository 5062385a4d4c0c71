#pragma once

#include <optional>
#include <string>
#include <string_view>

#include "manoscope/core/units.hpp"

namespace manoscope {

/// Factor and offset that carry a number in some unit to SI: si = factor * number + offset.
struct UnitScale {
  double factor = 1.0;
  double offset = 0.0;
  double to_si(double number) const { return factor * number + offset; }
};

/// Scale of `unit` (any udunits-2 spelling, e.g. "mL/min", "µm", "degC") towards `si_unit`.
///
/// @return nullopt if the unit is unknown or of another dimension.
std::optional<UnitScale> unit_scale(std::string_view unit, std::string_view si_unit);

/// True if udunits-2 knows the unit, whatever its dimension.
bool is_known_unit(std::string_view unit);

/// The SI value of a text such as "70 mL/min".
///
/// The error messages are short phrases for the caller to place: they name what was found and an
/// example, not the file.
///
/// @throws InputError(where, ...) for a missing or malformed number, a missing or unknown unit, a
///         unit of another dimension, or a value that is not finite.
double parse_si(std::string_view text, const char* si_unit, const char* kind, const char* example,
                const std::string& where);

template <class Q>
Q parse_quantity(std::string_view text, const std::string& where) {
  using Unit = UnitOf<Q>;
  return Q::from_si(parse_si(text, Unit::name, Unit::kind, Unit::example, where));
}

/// The whole of `text` as one finite or non-finite number, '.' as decimal mark, locale-free.
std::optional<double> parse_number(std::string_view text);

}  // namespace manoscope

#include "manoscope/twin/toml_text.hpp"

#include <fmt/format.h>

#include <cmath>
#include <initializer_list>

namespace manoscope::twin::toml_text {
namespace {

/// A quantity in the first of its units, from small to large, in which the number is below 1000.
struct Unit {
  double si;
  const char* name;
};

std::string in_best_unit(double si, std::initializer_list<Unit> units) {
  // Half a unit of the tenth digit: 999.99999999999 kPa is 1 MPa.
  constexpr double kBelow = 1000.0 * (1.0 - 5e-11);
  for (const Unit& unit : units) {
    const bool last = unit.si == (units.end() - 1)->si;
    if (last || std::abs(si) < kBelow * unit.si) return in_unit(si / unit.si, unit.name);
  }
  return {};
}

}  // namespace

std::string in_unit(double number, const char* unit) {
  return fmt::format("\"{:.10g} {}\"", number, unit);
}

std::string best(Pressure pressure) {
  return in_best_unit(pressure.si(), {{1.0, "Pa"}, {1e3, "kPa"}, {1e6, "MPa"}, {1e9, "GPa"}});
}

std::string best(Length length) {
  return in_best_unit(length.si(), {{1e-12, "pm"}, {1e-9, "nm"}, {1e-6, "um"}, {1e-3, "mm"}});
}

}  // namespace manoscope::twin::toml_text

#include "manoscope/io/bounds.hpp"

#include <fmt/format.h>

#include <cmath>

#include "manoscope/core/unit_text.hpp"

namespace manoscope::io {

bool check_bounds(double value, const Bounds& bounds, const std::string& written,
                  const char* si_unit, const Place& place, Faults& faults) {
  const auto with_unit = [&](double limit) {
    return si_unit == nullptr ? fmt::format("{:g}", limit) : fmt::format("{:g} {}", limit, si_unit);
  };
  std::string found;
  if (!std::isfinite(value)) {
    found = "is not finite";
  } else if (bounds.above_low ? value <= bounds.low : value < bounds.low) {
    found = bounds.low != 0.0  ? fmt::format("is {} {}", bounds.above_low ? "not above" : "below",
                                             with_unit(bounds.low))
            : bounds.above_low ? "is not positive"
                               : "is negative";
  } else if (value > bounds.high) {
    found = fmt::format("is above {}", with_unit(bounds.high));
  } else {
    return true;
  }
  faults.add(place, fmt::format("{} {}", written, found), bounds.mend);
  return false;
}

bool is_placeholder(const std::string& text) {
  const auto first = text.find_first_not_of(' ');
  return first != std::string::npos && text[first] == '?';
}

UnitInfo with_example(UnitInfo unit, const Bounds& bounds) {
  if (bounds.example != nullptr) unit.example = bounds.example;
  return unit;
}

std::optional<double> checked_quantity(const std::string& text, const UnitInfo& any_unit,
                                       const Bounds& bounds, const Place& place, Faults& faults) {
  const UnitInfo unit = with_example(any_unit, bounds);
  if (is_placeholder(text)) {
    faults.add(place, fmt::format("{} is still the placeholder of a draft", in_quotes(text)),
               fmt::format("Write the true value with its unit, like \"{}\"{}{}", unit.example,
                           *bounds.advice == '\0' ? "" : ": ", bounds.advice));
    return std::nullopt;
  }
  constexpr std::size_t kLongest = 200;
  if (text.size() > kLongest) {
    faults.add(place, fmt::format("{} is too long for a {}", in_quotes(text), unit.kind),
               fmt::format("Write the {} with its unit, e.g. \"{}\"", unit.kind, unit.example));
    return std::nullopt;
  }
  try {
    const double value = parse_si(text, unit.si, unit.kind, unit.example, "");
    if (check_bounds(value, bounds, in_quotes(text), unit.si, place, faults)) return value;
  } catch (const InputError& error) {
    faults.add(place, error.found(), error.mend());
  }
  return std::nullopt;
}

}  // namespace manoscope::io

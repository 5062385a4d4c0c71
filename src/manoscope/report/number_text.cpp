#include "manoscope/report/number_text.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <utility>

namespace manoscope::report {
namespace {

const char* const kMissing = "–";

DisplayUnit choose(double largest, const std::vector<DisplayUnit>& ascending) {
  DisplayUnit chosen = ascending.front();
  for (const DisplayUnit& unit : ascending) {
    if (std::isgreaterequal(std::abs(largest), unit.si * (1.0 - 1e-9))) chosen = unit;
  }
  return chosen;
}

/// Power of ten of the leading digit once the number is rounded to `digits` digits.
int leading_power(double value, int digits) {
  // The decimal conversion rounds as it will be printed: 9.96 with two digits is 10, power 1.
  const std::string text = fmt::format("{:.{}e}", std::abs(value), digits - 1);
  return std::stoi(text.substr(text.find('e') + 1));
}

}  // namespace

DisplayUnit pressure_unit(double largest) {
  return choose(largest, {{1.0, "Pa"}, {1e3, "kPa"}, {1e6, "MPa"}});
}

DisplayUnit length_unit(double largest) {
  return choose(largest, {{1e-9, "nm"}, {1e-6, "µm"}, {1e-3, "mm"}, {1.0, "m"}});
}

DisplayUnit flow_rate_unit(double largest) {
  constexpr double kMilliliterPerMinute = 1e-6 / 60.0;
  return choose(largest, {{1e-6 * kMilliliterPerMinute, "nL/min"},
                          {1e-3 * kMilliliterPerMinute, "µL/min"},
                          {kMilliliterPerMinute, "mL/min"},
                          {1e3 * kMilliliterPerMinute, "L/min"}});
}

std::string number_text(double value, int digits) {
  if (!std::isfinite(value)) return kMissing;
  if (value == 0.0) return "0";
  const int power = leading_power(value, digits);
  if (power >= 7 || power < -4) {
    return fmt::format("{}{:.{}e}", value < 0.0 ? "−" : "", std::abs(value), digits - 1);
  }
  return fixed_text(value, digits - 1 - power);
}

std::string fixed_text(double value, int decimals) {
  if (!std::isfinite(value)) return kMissing;
  if (decimals < 0) {
    const double step = std::pow(10.0, -decimals);
    value = std::round(value / step) * step;
  }
  std::string text = fmt::format("{:.{}f}", value, std::max(decimals, 0));
  if (text.front() == '-') {
    const bool zero = text.find_first_not_of("-0.") == std::string::npos;
    text = (zero ? "" : "−") + text.substr(1);
  }
  return text;
}

std::string signed_percent_text(double fraction) {
  if (!std::isfinite(fraction)) return kMissing;
  const double percent = 100.0 * fraction;
  if (std::abs(percent) < 0.005) return "0 %";
  const std::string text = fixed_text(percent, std::abs(percent) < 0.095 ? 2 : 1);
  return (percent > 0.0 ? "+" : "") + text + " %";
}

std::string short_number_text(double value, int digits) {
  std::string text = number_text(value, digits);
  if (text.find('.') == std::string::npos || text.find('e') != std::string::npos) return text;
  text.erase(text.find_last_not_of('0') + 1);
  if (text.back() == '.') text.pop_back();
  return text;
}

std::string number_text_with_uncertainty(double value, double uncertainty) {
  if (!std::isfinite(value)) return kMissing;
  if (!std::isfinite(uncertainty) || uncertainty <= 0.0) return number_text(value, 4);
  const int decimals = 1 - leading_power(uncertainty, 2);
  if (decimals > 12) return number_text(value, 4);  // far below any digit that means something
  return fixed_text(value, decimals) + " ± " + fixed_text(uncertainty, decimals);
}

std::string percent_text(double fraction) {
  if (!std::isfinite(fraction)) return kMissing;
  if (fraction == 0.0) return "0 %";
  if (std::abs(fraction) < 1e-4) return "< 0.01 %";
  const int power = leading_power(100.0 * fraction, 2);
  return fixed_text(100.0 * fraction, std::clamp(1 - power, 0, 2)) + " %";
}

}  // namespace manoscope::report

#include "manoscope/flow/duct_resistance.hpp"

#include <fmt/format.h>

#include <cmath>
#include <numbers>

#include "manoscope/core/error.hpp"

namespace manoscope::flow {
namespace {

constexpr double kWideDuct = 0.63;
constexpr double kPi = std::numbers::pi;
constexpr double kZeta5 = 1.03692775514336992633;  // Riemann zeta(5)
constexpr double kOddSum = 31.0 / 32.0 * kZeta5;   // sum over odd n of 1/n^5
constexpr const char* kWhere = "duct resistance";

struct Factor {
  double value = 0.0;  ///< F
  double slope = 0.0;  ///< dF/d(h/w)
};

/// F and its slope of a duct at most as high as wide, by the series.
Factor series_of_flat_duct(double ratio) {
  // tanh(y) = 1 - 2 e^(-2y) / (1 + e^(-2y)) with 2y = n pi / ratio >= n pi: n <= 11 reaches e^-34.
  const double scale = 192.0 / std::pow(kPi, 5);
  double sum = kOddSum, sum_slope = 0.0;
  for (int n = 1; n <= 11; n += 2) {
    const double decay = std::exp(-n * kPi / ratio);
    const double weight = 2.0 / std::pow(n, 5);
    sum -= weight * decay / (1.0 + decay);
    sum_slope -= weight * decay / ((1.0 + decay) * (1.0 + decay)) * n * kPi / (ratio * ratio);
  }
  return {1.0 - scale * ratio * sum, -scale * (sum + ratio * sum_slope)};
}

Factor flow_factor(double ratio, DuctFormula formula) {
  if (formula == DuctFormula::wide_duct) return {1.0 - kWideDuct * ratio, -kWideDuct};
  if (ratio <= 1.0) return series_of_flat_duct(ratio);
  // The duct turned over: w h^3 F(h/w) = h w^3 F(w/h).
  const double turned = 1.0 / ratio;
  const Factor flat = series_of_flat_duct(turned);
  const double square = turned * turned;
  return {square * flat.value, -square * turned * (2.0 * flat.value + turned * flat.slope)};
}

void check_duct(Viscosity eta, Length w) {
  if (!(eta.si() > 0.0) || !std::isfinite(eta.si())) {
    throw InputError(kWhere, fmt::format("viscosity is {:g} Pa s", eta.si()),
                     "Give a positive viscosity such as \"1.0 mPa s\"");
  }
  if (!(w.si() > 0.0) || !std::isfinite(w.si())) {
    throw InputError(kWhere, fmt::format("width is {:g} mm", w.in(mm)),
                     "Give a positive width such as \"1.7 mm\"");
  }
}

/// `index` names the gap in the message, -1 for a lone one.
void check_gap(Length w, double gap, DuctFormula formula, Index index) {
  const bool fits = gap > 0.0 && std::isfinite(gap);
  if (fits && (formula == DuctFormula::series || gap <= w.si())) return;
  const std::string which = index < 0 ? "gap" : fmt::format("gap at station {}", index);
  const char* allowed =
      formula == DuctFormula::series ? "be positive" : "lie in (0, width] for eq. (4)";
  throw InputError(
      kWhere, fmt::format("{} is {:.4g} um in a duct {:.4g} um wide", which, gap * 1e6, w.in(um)),
      fmt::format("The gap must {}; check the sign of zeta and the channel height", allowed));
}

double resistance(double eta, double w, double h, DuctFormula formula) {
  return 12.0 * eta / (w * h * h * h * flow_factor(h / w, formula).value);
}

double resistance_slope(double eta, double w, double h, DuctFormula formula) {
  const Factor factor = flow_factor(h / w, formula);
  const double r = 12.0 * eta / (w * h * h * h * factor.value);
  return -r * (3.0 / h + factor.slope / (w * factor.value));
}

template <class Function>
Array1 over_gaps(Function function, Viscosity eta, Length w, const Array1& gap,
                 DuctFormula formula) {
  check_duct(eta, w);
  Array1 result(gap.size());
  for (Index i = 0; i < gap.size(); ++i) {
    check_gap(w, gap(i), formula, i);
    result(i) = function(eta.si(), w.si(), gap(i), formula);
  }
  return result;
}

}  // namespace

double duct_flow_factor(double h_over_w, DuctFormula formula) {
  check_gap(Length::from_si(1.0), h_over_w, formula, -1);
  return flow_factor(h_over_w, formula).value;
}

double duct_resistance(Viscosity eta, Length w, Length h, DuctFormula formula) {
  check_duct(eta, w);
  check_gap(w, h.si(), formula, -1);
  return resistance(eta.si(), w.si(), h.si(), formula);
}

Array1 duct_resistance(Viscosity eta, Length w, const Array1& gap, DuctFormula formula) {
  return over_gaps(resistance, eta, w, gap, formula);
}

double duct_resistance_slope(Viscosity eta, Length w, Length h, DuctFormula formula) {
  check_duct(eta, w);
  check_gap(w, h.si(), formula, -1);
  return resistance_slope(eta.si(), w.si(), h.si(), formula);
}

Array1 duct_resistance_slope(Viscosity eta, Length w, const Array1& gap, DuctFormula formula) {
  return over_gaps(resistance_slope, eta, w, gap, formula);
}

}  // namespace manoscope::flow

#include "manoscope/wall/crest_power.hpp"

#include <fmt/format.h>

#include <boost/math/special_functions/gamma.hpp>
#include <cmath>
#include <vector>

#include "manoscope/core/error.hpp"

namespace manoscope::wall {

CrestPower crest_power(const HydrostaticData& data, const PressureRange& range) {
  data.validate();
  const auto refuse = [](const std::string& found, const char* mend) {
    throw InputError("power law of the wall", found, mend);
  };
  std::vector<Index> inside;
  for (Index i = 0; i < data.pressure.size(); ++i) {
    if (data.pressure(i) < range.low.si() || data.pressure(i) > range.high.si()) continue;
    if (!(data.pressure(i) > 0.0 && data.deflection(i) > 0.0)) {
      refuse(fmt::format("point {} has {:g} Pa and {:g} um", i, data.pressure(i),
                         1e6 * data.deflection(i)),
             "Choose a range where the wall is bowed outward by positive pressure");
    }
    inside.push_back(i);
  }
  const auto n = static_cast<Index>(inside.size());
  if (n < 3) {
    refuse(fmt::format("{} points lie between {:g} Pa and {:g} Pa", n, range.low.si(),
                       range.high.si()),
           "Give a range with at least 3 pressures");
  }
  const Array1 p = data.pressure(inside), z = data.deflection(inside);
  const Array1 x = p.log(), y = z.log();
  const Array1 error_x = data.sigma_pressure(inside) / p;
  const Array1 error_y = data.sigma_deflection(inside) / z;

  CrestPower made;
  made.n_points = n;
  made.range = {Pressure::from_si(p.minCoeff()), Pressure::from_si(p.maxCoeff())};
  if (!(made.range.high > made.range.low)) {
    refuse("all pressures of the range are the same", "Give a range with several pressures");
  }
  made.exponent = 0.5;
  for (int k = 0; k < 100; ++k) {
    const Array1 weight = (error_y.square() + (made.exponent * error_x).square()).inverse();
    const double centre_x = (weight * x).sum() / weight.sum();
    const double centre_y = (weight * y).sum() / weight.sum();
    const double spread = (weight * (x - centre_x).square()).sum();
    const double before = made.exponent;
    made.exponent = (weight * (x - centre_x) * (y - centre_y)).sum() / spread;
    made.sigma = 1.0 / std::sqrt(spread);
    made.scale = std::exp(centre_y - made.exponent * centre_x);
    made.chi2 = (weight * (y - centre_y - made.exponent * (x - centre_x)).square()).sum();
    if (std::abs(made.exponent - before) < 1e-13) break;
  }
  made.probability = boost::math::gamma_q(0.5 * static_cast<double>(n - 2), 0.5 * made.chi2);
  return made;
}

}  // namespace manoscope::wall

#include "manoscope/validation/roof_effect.hpp"

#include <fmt/format.h>

#include <cmath>
#include <numbers>
#include <vector>

#include "manoscope/core/error.hpp"
#include "manoscope/flow/cross_section.hpp"
#include "manoscope/flow/section_family.hpp"
#include "manoscope/numerics/quadrature.hpp"

namespace manoscope::validation {
namespace {

constexpr Index kStations = 33;

/// Positions from 0 to the length, four times as dense at the ends.
Array1 stations_of(const flow::Channel& channel) {
  const Array1 t = Array1::LinSpaced(kStations, -1.0, 1.0);
  constexpr double kDenser = 0.75;
  const Array1 bent = (1.0 + 0.5 * kDenser) * t - 0.5 * kDenser * t.cube();
  return 0.5 * channel.length.si() * (1.0 + bent / bent[kStations - 1]);
}

/// Section below height + amounts of the modes.
flow::Roof section(const SmoothRoof& roof, const Eigen::VectorXd& amounts) {
  const double height = roof.channel().height.si();
  const auto sum = [amounts](const Matrix& modes) {
    return (modes.leftCols(amounts.size()) * amounts)(0, 0);
  };
  const AcrossModes& modes = roof.modes();
  return {roof.channel().width,
          [height, sum, modes](double s) { return height + sum(modes.at(Array1::Constant(1, s))); },
          [sum, modes](double s) { return sum(modes.slopes(Array1::Constant(1, s))); }};
}

}  // namespace

RoofEffect roof_effect(const SmoothRoof& roof, const flow::WallShape& shape, Viscosity viscosity,
                       FlowRate flow_rate) {
  const flow::Channel& channel = roof.channel();
  const double height = channel.height.si();
  RoofEffect effect;
  effect.x = stations_of(channel);
  const Array1 s = Array1::LinSpaced(201, -1.0, 1.0);  // fifteen a wave of the highest departure
  const Array1 z = 0.5 * channel.width.si() * s;
  require_open_gap(effect.x, z, roof.zeta(effect.x, z), channel.height);

  const Array1 zeta = roof.along().zeta(effect.x);
  const Matrix departures = roof.departures(effect.x);
  const Matrix doubts = roof.departures_standard(effect.x);
  const Matrix modes = roof.modes().at(s);
  const Array1 weight = numerics::trapezoid_weights(s);
  const Array2 gap = height + roof.even(effect.x, z);
  const auto family = flow::SectionFamily::of(channel, shape, zeta);
  const Index n_even = roof.modes().n_even(), n = roof.modes().size();
  Array1 one_shape(kStations), even(kStations), odd = Array1::Zero(kStations), doubt(kStations);
  for (Index i = 0; i < kStations; ++i) {
    Eigen::VectorXd amounts(1 + n);
    amounts << zeta[i], departures.row(i).transpose();
    one_shape[i] = family.at(Length::from_si(zeta[i])).resistance(viscosity);
    even[i] =
        flow::solve_cross_section(section(roof, amounts.head(1 + n_even))).resistance(viscosity);
    constexpr double kMatters = 1e-5;
    const double square = departures.row(i).tail(n - n_even).squaredNorm();
    if (square > kMatters * height * height / 3.0) {
      odd[i] =
          flow::solve_cross_section(section(roof, amounts)).resistance(viscosity) / even[i] - 1.0;
    }
    const Array1 h = gap.row(i).transpose();
    // Flow over flow between plates: it falls to 0 within a layer at either side.
    const Array1 layer =
        1.0 - (-0.5 * std::numbers::pi * channel.width.si() * (1.0 - s.abs()) / h).exp();
    const Eigen::VectorXd moves =
        -3.0 * (modes.rightCols(n).transpose() * (weight * (h * layer).square()).matrix()) /
        (weight * h.cube() * layer).sum();
    doubt[i] =
        std::sqrt(moves.cwiseProduct(doubts.row(i).transpose()).squaredNorm() + odd[i] * odd[i]);
  }
  const Array1 along = numerics::trapezoid_weights(effect.x);
  const double drop = (along * even).sum();
  effect.departure = drop / (along * one_shape).sum() - 1.0;
  effect.odd = (along * even * odd).sum() / drop;
  effect.pressure_error = Array1::Zero(kStations);
  const Array1 slope = flow_rate.si() * even * doubt;  // Pa/m
  for (Index i = kStations - 1; i-- > 0;) {
    effect.pressure_error[i] = effect.pressure_error[i + 1] +
                               0.5 * (slope[i] + slope[i + 1]) * (effect.x[i + 1] - effect.x[i]);
  }
  return effect;
}

void require_open_gap(const Array1& x, const Array1& z, const Array2& zeta, Length height) {
  Index i = 0, k = 0;
  const double least = height.si() + zeta.minCoeff(&i, &k);
  if (least > 0.0 && zeta.isFinite().all()) return;
  throw InputError("roof of the channel",
                   fmt::format("the gap is {:.4g} um at x = {:.4g} mm, z = {:.4g} mm", least * 1e6,
                               x[i] * 1e3, z[k] * 1e3),
                   "The gap must stay open everywhere; check the sign of zeta, the height, and the "
                   "map at this place");
}

}  // namespace manoscope::validation

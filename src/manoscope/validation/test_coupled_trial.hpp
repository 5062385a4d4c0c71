// A flow past a wall whose answer is local and known exactly, coupled here by hand: what the flow
// models of the library are held against.
#pragma once

#include <cmath>
#include <numbers>

#include "manoscope/flow/cross_section.hpp"
#include "manoscope/validation/test_trial.hpp"

namespace manoscope::validation {

/// Oil ten times as thick as water: the flow creeps (Re h/l = 0.06) while the wall bends by 20 um.
inline constexpr flow::Fluid kOil{10.0 * mPa_s, 900.0 * kg_per_m3};
inline constexpr FlowRate kOilFlow = 4.5 * mL_per_min;

/// r of a rectangle by the Fourier series, summed term by term: the wall moves as a whole
/// (WallShape::rigid()), so that this is the true section.
inline double series_resistance(double eta, double width, double gap) {
  double sum = 0.0;
  for (int n = 1; n < 20; n += 2)  // n^-5: 1e-8 of r is left
  {
    sum += std::tanh(n * std::numbers::pi * width / (2.0 * gap)) / std::pow(n, 5);
  }
  const double factor = 1.0 - 192.0 / std::pow(std::numbers::pi, 5) * gap / width * sum;
  return 12.0 * eta / (width * gap * gap * gap * factor);
}

/// One run with the errors of one seed, its pressure coupled to the wall by a fixed point on a fine
/// grid of its own.
struct CoupledTrial : Trial {
  flow::Channel channel = kChannel;  ///< the true one
  flow::Fluid fluid = kOil;
  FlowRate flow_rate = kOilFlow;
  Pressure outlet = 600.0 * Pa;
  bool inertia = false;  ///< with the gain of momentum of developed profiles

  static constexpr Index kFine = 311;  // 50 um: the trapezoid rule leaves below 1e-4 inside

  /// p on the fine grid.
  Array1 fine_pressure() const {
    const double w = channel.width.si(), H = channel.height.si(), Q = flow_rate.si();
    const Array1 fine = Array1::LinSpaced(kFine, 0.0, wall.length);
    // beta of rectangles is straight in h/w over the few per cent that the gap changes.
    const auto beta_of = [&](double gap) {
      return flow::solve_cross_section(flow::flat_roof(channel.width, Length::from_si(gap)))
          .momentum_factor;
    };
    const double low = inertia ? beta_of(H) : 0.0, high = inertia ? beta_of(H + 30e-6) : 0.0;
    Array1 p = Array1::Constant(kFine, outlet.si());
    for (int sweep = 0; sweep < 200; ++sweep) {
      Array1 gap(kFine), r(kFine);
      for (Index i = 0; i < kFine; ++i) {
        gap[i] = H + wall.zeta(fine[i], p[i]);
        r[i] = series_resistance(fluid.viscosity.si(), w, gap[i]);
      }
      Array1 next(kFine);
      next[kFine - 1] = outlet.si();
      for (Index i = kFine - 1; i-- > 0;) {
        const double step = fine[i + 1] - fine[i];
        next[i] = next[i + 1] + 0.5 * Q * (r[i] + r[i + 1]) * step;
        if (!inertia) continue;
        // A dp = -d(beta rho Q^2/A): flux behind less flux before, over the mean area.
        const auto flux = [&](Index k) {
          const double beta = low + (high - low) * (gap[k] - H) / 30e-6;
          return beta * fluid.density.si() * Q * Q / (w * gap[k]);
        };
        next[i] += (flux(i + 1) - flux(i)) / (w * 0.5 * (gap[i] + gap[i + 1]));
      }
      const double change = (next - p).abs().maxCoeff();
      p = 0.5 * (p + next);  // halved: the fixed point of a soft wall swings
      if (change < 1e-4) break;
    }
    return p;
  }

  double at(const Array1& fine, double place) const {
    const double share = place / wall.length * (kFine - 1);
    const auto i = std::min<Index>(static_cast<Index>(share), kFine - 2);
    return fine[i] + (share - static_cast<double>(i)) * (fine[i + 1] - fine[i]);
  }
  Profile state(const Array1& fine) const {
    return map(
        test::exact_profile(x, [&](double place) { return wall.zeta(place, at(fine, place)); }),
        "flow", flow_errors);
  }
};

/// What the observer takes the channel for. The section is known to be a rectangle and the profile
/// at the inlet to be developed.
inline FlowSetup observed(const flow::Channel& channel, const flow::Fluid& fluid,
                          const FlowUncertainty& uncertainty = {kHeightUncertainty}) {
  FlowSetup setup;
  setup.channel = channel;
  setup.fluid = fluid;
  setup.uncertainty = uncertainty;
  setup.shape = flow::WallShape::rigid();
  setup.inlet_spread = 0.0;
  if (channel != kChannel) return with_tables(setup, -1.0 * um, 32.0 * um);
  static const auto kOnce = with_tables(setup, -1.0 * um, 32.0 * um).tables;  // free of the fluid
  setup.tables = kOnce;
  return setup;
}

}  // namespace manoscope::validation

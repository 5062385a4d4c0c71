// Walls whose shape across changes along the channel, and the cells of a map of them.
#pragma once

#include <cmath>
#include <cstdint>
#include <functional>
#include <numbers>

#include "manoscope/core/cross_sections.hpp"
#include "manoscope/core/profile.hpp"
#include "manoscope/core/random.hpp"
#include "manoscope/flow/channel.hpp"

namespace manoscope::validation {

inline constexpr flow::Channel kRoofChannel{15.5 * mm, 1.7 * mm, 175.0 * um};

/// zeta(x, s) in m, s = 2 z/w.
using TrueRoof = std::function<double(double x, double s)>;

/// 1 inside, 0 at the clamped ends, within w/pi.
inline double end_rise(double x) {
  const double l = kRoofChannel.length.si(), reach = kRoofChannel.width.si() / std::numbers::pi;
  return (1.0 - std::exp(-x / reach)) * (1.0 - std::exp((x - l) / reach));
}

/// A stretched wall of 33 um that falls along x, flatter across at its ends, and a little askew.
inline double stretched_roof(double x, double s) {
  const double l = kRoofChannel.length.si(), rise = end_rise(x);
  const double flat = 0.5 * (1.0 - rise), askew = 0.02 * std::sin(7.0 * x / l);
  return 50e-6 * (1.0 - 0.6 * x / l) * rise * (1.0 - s * s) *
         (1.0 + flat * (s * s - 0.2) + askew * s);
}

/// A buckled wall: a plate's shape inwards, a second wave across, and a mean that passes 0.
inline double buckled_roof(double x, double s) {
  const double l = kRoofChannel.length.si(), plate = std::pow(1.0 - s * s, 2);
  return end_rise(x) * (12e-6 * (0.5 - 1.2 * x / l) * plate -
                        2e-6 * plate * std::cos(1.5 * std::numbers::pi * s));
}

/// Under tension with a layer of bending at the sides, 1/12 of the half width thick.
inline double layered_roof(double x, double s) {
  constexpr double kTension = 12.0;
  const double layer = 2.0 / (kTension * std::tanh(kTension)) *
                       (1.0 - std::cosh(kTension * s) / std::cosh(kTension));
  return 20e-6 * end_rise(x) * (1.0 - s * s - layer);
}

/// Mean of f over [a, b] by the middle rule.
template <class Function>
double mean_over(double a, double b, int n, const Function& f) {
  double sum = 0.0;
  for (int i = 0; i < n; ++i) sum += f(a + (b - a) * (i + 0.5) / n);
  return sum / n;
}

/// Cells of a map, each with noise of its own (seed 0: none drawn); 16 across, or fewer.
inline CrossSections cells_of(const TrueRoof& roof, double noise, std::uint64_t seed,
                              Index n_across = 16) {
  RandomStream stream(seed, "cells", 1);
  const double l = kRoofChannel.length.si(), w = kRoofChannel.width.si();
  constexpr double kShown = 0.96;  // of the width
  const auto n = static_cast<Index>(std::lround(8.0 * l / w));
  const double dx = l / static_cast<double>(n), ds = 2.0 * kShown / static_cast<double>(n_across);
  CrossSections cells;
  cells.x = Array1::LinSpaced(n, 0.5 * dx, l - 0.5 * dx);
  const Array1 s = Array1::LinSpaced(n_across, -kShown + 0.5 * ds, kShown - 0.5 * ds);
  cells.z = 0.5 * w * s;
  cells.zeta = Array2(n_across, n);
  cells.sigma = Array2::Constant(n_across, n, noise);
  cells.flags = Flags2::Zero(n_across, n);
  for (Index b = 0; b < n_across; ++b) {
    for (Index j = 0; j < n; ++j) {
      cells.zeta(b, j) = mean_over(cells.x[j] - 0.5 * dx, cells.x[j] + 0.5 * dx, 6, [&](double x) {
        return mean_over(s[b] - 0.5 * ds, s[b] + 0.5 * ds, 6,
                         [&](double at) { return roof(x, at); });
      });
      if (seed != 0) cells.zeta(b, j) += noise * stream.normal();
    }
  }
  return cells;
}

/// The width average of the same map, noise as of all its pixels.
inline Profile profile_of(const TrueRoof& roof, double noise, std::uint64_t seed) {
  RandomStream stream(seed, "profile", 1);
  constexpr Index kStations = 512;
  Profile state;
  state.x = Array1::LinSpaced(kStations, 0.01e-3, kRoofChannel.length.si() - 0.01e-3);
  state.zeta = Array1(kStations);
  for (Index i = 0; i < kStations; ++i) {
    state.zeta[i] = mean_over(-1.0, 1.0, 400, [&](double s) { return roof(state.x[i], s); });
    if (seed != 0) state.zeta[i] += noise * stream.normal();
  }
  state.uncertainty.independent = Array1::Constant(kStations, noise);
  state.flags = Flags1::Zero(kStations);
  return state;
}

}  // namespace manoscope::validation

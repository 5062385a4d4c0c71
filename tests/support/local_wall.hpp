#pragma once

#include <cmath>
#include <string>
#include <utility>
#include <vector>

#include "manoscope/calibration/levels.hpp"
#include "manoscope/core/arrays.hpp"
#include "manoscope/core/flags.hpp"
#include "manoscope/core/profile.hpp"

namespace manoscope::test {

/// A wall whose deflection at x depends on the pressure at x alone, solved exactly.
///
///   p = (stiffness zeta + stretching zeta^3) / taper(x),   taper = 1 - e^(-x/L) - e^(-(l-x)/L)
///
/// (long membrane; pascals and metres), so that any error of a reading is the reading's own.
struct LocalWall {
  double length = 15.5e-3;     ///< m
  double stiffness = 1e8;      ///< Pa/m
  double stretching = 1.2e18;  ///< Pa/m3
  double decay = 0.5e-3;       ///< m

  Array1 stations(Index n) const { return Array1::LinSpaced(n, 0.5e-3, length - 0.5e-3); }
  double taper(double x) const {
    return 1.0 - std::exp(-x / decay) - std::exp(-(length - x) / decay);
  }
  double pressure(double x, double zeta) const {
    return (stiffness + stretching * zeta * zeta) * zeta / taper(x);
  }
  /// By Newton's method, which converges from above because p(zeta) is convex there.
  double zeta(double x, double p) const {
    const double load = std::abs(p) * taper(x);
    double z = std::min(load / stiffness, std::cbrt(load / stretching));
    for (int step = 0; step < 60; ++step) {
      const double next = z - ((stiffness + stretching * z * z) * z - load) /
                                  (stiffness + 3.0 * stretching * z * z);
      if (next == z) break;
      z = next;
    }
    return std::copysign(z, p);
  }
};

/// A noise-free profile without uncertainty: zeta(x_i) = f(x_i).
template <class F>
Profile exact_profile(const Array1& x, const F& f) {
  Profile profile;
  profile.x = profile.zeta = x;
  for (double& zeta : profile.zeta) zeta = f(zeta);
  profile.uncertainty.independent = Array1::Zero(x.size());
  profile.flags = Flags1::Zero(x.size());
  return profile;
}

/// A level at 0 Pa without uncertainty is one vented to air.
inline calibration::Level level(std::string name, double pressure_Pa, double uncertainty_Pa,
                                Profile profile) {
  return {std::move(name), Pressure::from_si(pressure_Pa), Pressure::from_si(uncertainty_Pa),
          std::move(profile), pressure_Pa == 0.0 && uncertainty_Pa == 0.0 ? 0.0 : 1.0};
}

/// A calibration of one station: pressures and deflections, all with the same uncertainties.
inline std::vector<calibration::Level> one_station(const std::vector<double>& pressures,
                                                   const std::vector<double>& zetas,
                                                   double zeta_sigma = 0.0,
                                                   double label_sigma = 0.0) {
  std::vector<calibration::Level> levels;
  for (std::size_t k = 0; k < pressures.size(); ++k) {
    Profile profile = exact_profile(Array1::Constant(1, 7e-3), [&](double) { return zetas[k]; });
    profile.uncertainty.independent.setConstant(zeta_sigma);
    levels.push_back(level("h" + std::to_string(k), pressures[k], label_sigma, profile));
  }
  return levels;
}

/// n pressures from 0 (vented) to `highest` Pa, the others in equal ratios from `lowest` up.
inline std::vector<double> log_spaced(int n, double lowest, double highest) {
  std::vector<double> pressures{0.0};
  for (int k = 0; k + 1 < n; ++k) {
    pressures.push_back(lowest * std::pow(highest / lowest, static_cast<double>(k) / (n - 2)));
  }
  return pressures;
}

/// n pressures in equal steps.
inline std::vector<double> even(int n, double lowest, double highest) {
  std::vector<double> pressures;
  for (int k = 0; k < n; ++k) pressures.push_back(lowest + (highest - lowest) * k / (n - 1));
  return pressures;
}

}  // namespace manoscope::test

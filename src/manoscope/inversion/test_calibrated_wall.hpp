#pragma once

#include <cmath>
#include <string>
#include <vector>

#include "manoscope/calibration/fit_curves.hpp"
#include "manoscope/core/random.hpp"
#include "manoscope/inversion/read_nonlocal.hpp"
#include "manoscope/wall/continuation.hpp"
#include "tests/support/local_wall.hpp"

namespace manoscope::inversion::test_support {

/// A short elastomer channel, solved once on a grid other than that of WallResponse: levels, and
/// one state under a p(x) that falls, bends and has a dip of half a width behind the inlet.
struct CalibratedChannel {
  wall::ClampedWall wall{8.0 * mm, 1.0 * mm, 100.0 * um, 1.5 * MPa, 0.49, 20.0 * kPa, 5.0 / 6.0};
  Array1 x = Array1::LinSpaced(400, 0.01e-3, 7.99e-3);
  std::vector<double> pressures = test::even(12, 0.0, 6600.0);
  std::vector<Profile> levels;
  Profile state;

  static double true_pressure(double x) {
    const double s = x / 8e-3;
    return 6000.0 - 4000.0 * s - 1200.0 * s * s + 150.0 * (1.0 - std::exp(-x / 0.5e-3));
  }

  CalibratedChannel() {
    wall::FopplVonKarmanOptions options;
    options.n_cells_x = 36;
    options.n_cells_z = 6;
    options.design_pressure = 6.6 * kPa;
    options.tolerance = 1e-8;
    const wall::FopplVonKarman model(wall, options);
    const Array1 steps =
        Eigen::Map<const Array1>(pressures.data(), static_cast<Index>(pressures.size()));
    const auto start = model.equilibrium(wall::WallLoad::uniform(Pressure{}));
    const auto path = wall::follow_pressure(model, start, steps);
    for (const wall::WallState& solved : path.states) {
      levels.push_back(
          test::exact_profile(x, [&](double at) { return solved.average_deflection(at); }));
    }
    const Array1 along = Array1::LinSpaced(401, 0.0, 8e-3);
    const auto loaded = model.equilibrium(
        wall::WallLoad::along(along, along.unaryExpr([](double at) { return true_pressure(at); })),
        path.states[8]);
    state = test::exact_profile(x, [&](double at) { return loaded.average_deflection(at); });
  }

  /// Noise of every column, and of every label, with the uncertainties to go with it.
  calibration::ConstitutiveCurves curves(double noise, double label_noise,
                                         std::uint64_t seed) const {
    RandomStream stream(seed, "calibration");
    std::vector<calibration::Level> noisy;
    for (std::size_t k = 0; k < levels.size(); ++k) {
      const double label = pressures[k] + (k == 0 ? 0.0 : label_noise * stream.normal());
      noisy.push_back(test::level("h" + std::to_string(k), label, k == 0 ? 0.0 : label_noise,
                                  with_noise(levels[k], noise, stream)));
    }
    return calibration::fit_curves(noisy);
  }
  Profile flow(double noise, std::uint64_t seed) const {
    RandomStream stream(seed, "flow");
    return with_noise(state, noise, stream);
  }
  WallKnowledge known() const { return {wall.length, wall.width, wall.thickness, 0.49}; }

  static Profile with_noise(Profile profile, double noise, RandomStream& stream) {
    for (double& zeta : profile.zeta) zeta += noise * stream.normal();
    profile.uncertainty.independent.setConstant(std::max(noise, 1e-12));
    return profile;
  }
};

inline const CalibratedChannel& channel() {
  static const CalibratedChannel made;
  return made;
}

}  // namespace manoscope::inversion::test_support

// One flow experiment on a wall whose answer is local and known exactly, for the tests of this
// folder.
#pragma once

#include <cmath>
#include <string>

#include "manoscope/calibration/fit_curves.hpp"
#include "manoscope/core/random.hpp"
#include "manoscope/validation/drop_agreement.hpp"
#include "tests/support/local_wall.hpp"

namespace manoscope::validation {

using calibration::Level;
using inversion::GaugeErrors;
using inversion::PressureReading;
using inversion::TestSection;
using test::LocalWall;

inline constexpr Index kStations = 25;
inline constexpr TestSection kSection{3, 21};
inline constexpr flow::Channel kChannel{15.5 * mm, 1.7 * mm, 175.0 * um};
inline constexpr flow::Fluid kWater{1.0 * mPa_s, 998.0 * kg_per_m3};
inline constexpr Length kHeightUncertainty = 0.5 * um;

/// r by hand: 12 eta/(w h^3 (1 - 0.63 h/w)), eq. (4).
inline double resistance_by_hand(double gap) {
  return 12.0 * 1e-3 / (1.7e-3 * gap * gap * gap * (1.0 - 0.63 * gap / 1.7e-3));
}

/// One standard deviation of each kind of error of a map.
struct MapErrors {
  double noise, offset, tilt, shift;  // m: of one column; of the plane, in the middle and at the
                                      // ends; along x
};

/// One experiment on a wall whose answer is local, with the errors of one seed (0 = none).
struct Trial {
  LocalWall wall;
  Array1 x = wall.stations(kStations);
  MapErrors level_errors{2e-9, 2e-9, 2e-9, 1e-6}, flow_errors = level_errors;
  double label = 10.0, gain = 0.0, zero = 0.0;  // Pa, relative, Pa
  std::uint64_t seed = 0;

  /// Pressure under flow, bent as in a wall that yields.
  double truth(double at) const {
    const double s = at / wall.length;
    return 12e3 - 11e3 * (0.8 * s + 0.2 * s * s);
  }

  Profile map(const Profile& exact, const std::string& name, const MapErrors& errors) const {
    RandomStream stream(seed, name);
    const auto draw = [&] { return seed == 0 ? 0.0 : stream.normal(); };
    Profile result = exact;
    const Index n = x.size();
    result.uncertainty.independent.setConstant(errors.noise);
    for (Index i = 0; i < n; ++i) result.zeta[i] += errors.noise * draw();
    Array1 slope(n);
    for (Index i = 0; i < n; ++i) {
      const Index before = std::max<Index>(i - 1, 0), after = std::min(i + 1, n - 1);
      slope[i] = (exact.zeta[after] - exact.zeta[before]) / (x[after] - x[before]);
    }
    const auto share = [&](const char* what, const char* source, const Array1& effect) {
      result.zeta += draw() * effect;
      result.uncertainty.modes.push_back({what + name, source, effect});
    };
    share("level plane, offset, ", "leveling", Array1::Constant(n, errors.offset));
    share("level plane, tilt, ", "leveling", errors.tilt * Array1::LinSpaced(n, -1.0, 1.0));
    share("shift of ", "registration", errors.shift * slope);
    return result;
  }

  calibration::ConstitutiveCurves curves() const {
    RandomStream stream(seed, "gauge");
    const auto draw = [&] { return seed == 0 ? 0.0 : stream.normal(); };
    const double scale = 1.0 + gain * draw(), offset = zero * draw();
    std::vector<Level> levels;
    for (const double p : test::log_spaced(16, 200.0, 20e3)) {
      const auto exact = test::exact_profile(x, [&](double at) { return wall.zeta(at, p); });
      const std::string name = "h" + std::to_string(levels.size());
      const bool vented = p == 0.0;
      const double read = vented ? 0.0 : scale * p + offset + label * draw();
      levels.push_back(
          test::level(name, read, vented ? 0.0 : label, map(exact, name, level_errors)));
    }
    // Each label an error variable of its own, so that it can be told in the drops.
    calibration::FitCurvesOptions options;
    options.joint_labels = false;
    return calibration::fit_curves(levels, options);
  }
  Profile state() const {
    return map(test::exact_profile(x, [&](double at) { return wall.zeta(at, truth(at)); }), "flow",
               flow_errors);
  }
  PressureReading reading(const Profile& profile) const {
    return inversion::read_pressure(curves(), profile, {gain, Pressure::from_si(zero)});
  }
};

inline DropAgreement compare(const PressureReading& reading, const Profile& state,
                             FlowRate flow_rate, const flow::Channel& channel = kChannel,
                             const FlowUncertainty& uncertainty = {kHeightUncertainty}) {
  return compare_drops(channel, kWater, flow_rate, uncertainty, state, reading, kSection);
}

}  // namespace manoscope::validation

// A finished calibration and a run of it: of the stages and of the reading against scipy.
#pragma once

#include <cmath>
#include <string>
#include <vector>

#include "inputs.hpp"
#include "manoscope/calibration/levels.hpp"
#include "manoscope/core/profile.hpp"
#include "manoscope/core/random.hpp"

namespace manoscope::bench {

/// 974 stations and 25 levels of a stretching wall, with the error modes that reduced maps have.
inline Profile profile_at(double pressure_Pa, const std::string& name) {
  constexpr Index kStations = 974;
  constexpr double kStretching = 2.5e-7;  // m / Pa^(1/3): 9 um at 50 kPa
  Profile profile;
  profile.x = Array1::LinSpaced(kStations, 0.01e-3, 15.49e-3);
  const Array1 ends = 1.0 - (-profile.x / 0.5e-3).exp() - ((profile.x - 15.5e-3) / 0.5e-3).exp();
  RandomStream stream(kSeed, name);
  profile.zeta = kStretching * std::cbrt(pressure_Pa) * ends.max(1e-3);
  for (double& value : profile.zeta) value += 1.75e-9 * stream.normal();
  profile.flags = Flags1::Zero(kStations);
  profile.uncertainty.independent = Array1::Constant(kStations, 1.75e-9);
  for (const char* what : {"offset", "tilt x", "tilt z", "shift"}) {
    profile.uncertainty.modes.push_back(
        {what + (" of " + name), "leveling", Array1::Constant(kStations, 0.1e-9)});
  }
  return profile;
}

inline std::vector<calibration::Level> calibration_levels() {
  std::vector<calibration::Level> levels;
  for (int k = 0; k < 25; ++k) {
    const double pressure_Pa = k == 0 ? 0.0 : 100.0 * std::pow(500.0, (k - 1) / 23.0);
    const std::string name = "h" + std::to_string(k);
    levels.push_back({name, Pressure::from_si(pressure_Pa), k == 0 ? Pressure{} : 10.0 * Pa,
                      profile_at(pressure_Pa, name)});
  }
  return levels;
}

}  // namespace manoscope::bench

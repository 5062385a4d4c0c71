// Walls and instruments to plan for, made in no time.
#pragma once

#include "manoscope/design/place_levels.hpp"
#include "manoscope/twin/scenario.hpp"

namespace manoscope::design::test_support {

/// What a camera of 512 x 96 pixels of 20 nm leaves.
inline MapQuality usual_maps() {
  MapQuality maps;
  maps.n_stations = 480;
  maps.spacing = 32e-6;
  maps.station_noise = 2.5e-9;
  maps.leveling = 0.1e-9;
  maps.flow_shift = 0.2e-6;
  return maps;
}

/// The small S1: a nitride membrane bowed in by 700 Pa, up to 20 kPa.
inline Apparatus bowed_membrane() {
  const twin::Scenario scenario = twin::small_s1();
  return {survey_wall(scenario, 20.0 * kPa, 0.1 * Pa).curve(), usual_maps(), scenario.gauge};
}

/// A plate that bends and stretches, p = a zeta + b zeta^3 - c zeta^5: no law that labels are
/// smoothed by.
inline Apparatus bending_plate() {
  std::vector<WallCurve::Node> nodes;
  constexpr double kA = 4e7, kB = 2.2e15, kC = 5e22;
  for (int k = 0; k <= 60; ++k) {
    const double z = 1.6e-6 * k, z2 = z * z;
    nodes.push_back(
        {z * (kA + z2 * (kB - kC * z2)), z, 1.0 / (kA + z2 * (3.0 * kB - 5.0 * kC * z2))});
  }
  return {WallCurve(std::move(nodes)), usual_maps(), twin::GaugeOptions{}};
}

/// To be read from 300 Pa to 4 kPa (17.5 kPa of the membrane).
inline PlacementTask task_of(Apparatus apparatus, double highest) {
  PlacementTask task{std::move(apparatus), {{300.0, highest}, {}}};
  task.lowest_top = highest + 30.0;
  task.highest_level = 1.1 * highest;
  task.wall_doubt = 0.0;
  return task;
}

}  // namespace manoscope::design::test_support

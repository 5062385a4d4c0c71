#pragma once

#include <functional>
#include <vector>

#include "manoscope/core/monitor.hpp"
#include "manoscope/twin/coupled.hpp"
#include "manoscope/twin/scenario.hpp"
#include "manoscope/twin/truth.hpp"
#include "manoscope/twin/wall_model.hpp"

namespace manoscope::twin {

/// The mechanics of a scenario: its wall at every level and under every flow. Hangs on no seed:
/// many experiments can be made of it (record_experiment()) that differ in the errors of instrument
/// and gauges alone.
struct SolvedScenario {
  struct Level {
    WallAtRest wall;
    SnapTruth snaps;  ///< since the level before; the first, since rest
  };
  struct Run {
    CoupledFlow flow;
    SnapTruth snaps;  ///< since the run before; the first, since rest
  };
  WallModel wall;
  std::vector<Level> levels;  ///< in the order of the scenario
  std::vector<Run> runs;
};

/// Solves a scenario for the wall of each level and run, in the order in which an experimenter
/// meets them, levels and runs each from rest: the wall remembers where it comes from.
///
/// @param n_threads  0 = all the machine has; the result is the same for any.
/// @param done       called after each level and run, from several threads at once.
/// @throws InputError, naming the scenario and where in it, if it is out of range, its channel
///         closes or chokes (solve_coupled()), or a crest rises beyond the wall's theory.
/// @throws Interrupted if the monitor says so.
SolvedScenario solve_scenario(const Scenario& scenario, int n_threads = 0,
                              const Monitor& monitor = {}, const std::function<void()>& done = {});

/// A run again at a flow rate near its own: of a pump that pulsates.
CoupledFlow solve_nearby(const Scenario& scenario, const SolvedScenario& solved,
                         const CoupledFlow& run, FlowRate flow_rate, const Monitor& monitor = {});

}  // namespace manoscope::twin

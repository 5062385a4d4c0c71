#pragma once

#include <cstdint>
#include <functional>
#include <string>
#include <vector>

#include "manoscope/core/height_map.hpp"
#include "manoscope/core/monitor.hpp"
#include "manoscope/twin/scenario.hpp"
#include "manoscope/twin/solved_scenario.hpp"
#include "manoscope/twin/truth.hpp"
#include "manoscope/twin/truth_netcdf.hpp"

namespace manoscope::twin {

/// A map and the name it goes by in the experiment's lists.
struct NamedMap {
  std::string name;   ///< "h00.gsf", "f03.gsf"
  std::string title;  ///< "S1 hydrostatic 0 Pa"
  HeightMap map;
};

/// A whole experiment with its truth apart.
struct VirtualExperiment {
  std::vector<NamedMap> maps;   ///< calibration levels, then flow runs, in the scenario's order
  std::string experiment_toml;  ///< what a user would have written
  std::string hydrostatic_csv;
  std::string flow_csv;

  Truth truth;                      ///< of every run and level
  std::vector<RunScalars> scalars;  ///< one a run
  TruthHeader header;               ///< true sizes; the experiment states the gap with an error
};

/// Runs a scenario: each level and each flow rate once, seen through the instrument's errors.
///
/// A reading of a hydrostatic level is p (1 + gain) + zero + noise; a level of 0 Pa is vented and
/// exactly 0. The same (scenario, seed) gives the same bytes on any number of threads.
///
/// @param n_threads  0 = all the machine has.
/// @throws InputError if the scenario is out of range or its channel closes (see solve_coupled()).
/// @throws Interrupted if the monitor says so.
VirtualExperiment make_virtual_experiment(const Scenario& scenario, std::uint64_t seed,
                                          int n_threads = 0, const Monitor& monitor = {});

/// The same of a scenario whose walls are solved: the second half of make_virtual_experiment().
///
/// @param solved  of solve_scenario() of a scenario with the same channel, wall, fluid, levels and
///                flow rates; camera, gauges and pump may differ.
/// @param done    called after each map, from several threads at once.
VirtualExperiment record_experiment(const Scenario& scenario, const SolvedScenario& solved,
                                    std::uint64_t seed, int n_threads = 0,
                                    const Monitor& monitor = {},
                                    const std::function<void()>& done = {});

}  // namespace manoscope::twin

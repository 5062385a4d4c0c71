#pragma once

#include <string>
#include <vector>

#include "manoscope/core/monitor.hpp"
#include "manoscope/design/forecast.hpp"
#include "manoscope/twin/scenario.hpp"

namespace manoscope::design {

/// One flow rate of a scenario as it will be.
struct SolvedRun {
  std::string name;
  FlowRate flow_rate{};
  PressureSpan whole;       ///< over the channel
  Array1 pressure;          ///< (n) Pa, at even stations of the test section, first to last
  double gradient = 0.0;    ///< Pa/m, mean
  double deflection = 0.0;  ///< m, largest
  double speed_index = 0.0;
};

/// Solves the flow rates of a scenario over its wall.
///
/// @throws InputError as twin::solve_scenario(), e.g. where the channel chokes; Interrupted.
std::vector<SolvedRun> solve_runs(const twin::Scenario& scenario, int n_threads = 0,
                                  const Monitor& monitor = {});

/// What is expected of the reading of a run, Pa; infinite where levels do not reach.
struct RunForecast {
  std::string name;
  FlowRate flow_rate{};
  double inlet = 0.0, outlet = 0.0;  ///< ends of the test section
  double worst = 0.0, rms = 0.0, rms_error = 0.0;
  double drop_uncertainty = 0.0, drop_error = 0.0;  ///< of inlet - outlet
  double speed_index = 0.0, deflection = 0.0;       ///< of the solved run
};

RunForecast forecast_run(const Apparatus& apparatus, const std::vector<double>& levels,
                         const SolvedRun& run);

/// Uncertainty of the drop from the upper to the lower end of a range, Pa.
double range_drop_uncertainty(const Apparatus& apparatus, const std::vector<double>& levels,
                              const PressureSpan& range);

}  // namespace manoscope::design

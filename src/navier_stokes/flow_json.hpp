#pragma once

#include <string>

#include "flow_simulation.hpp"
#include "manoscope/core/error.hpp"
#include "passage_flow.hpp"

namespace manoscope::navier_stokes {

/// What a simulation took beside its results.
struct Effort {
  int n_processes = 1;
  double seconds = 0.0;
  double peak_megabytes = 0.0;  ///< most memory held at a time by all processes, 10^6 bytes
};

/// Which roof the flow is below, for whoever gave a table.
struct RoofNote {
  std::string across;     ///< "map", "shape" or, in two dimensions, ""
  double odd_part = 0.0;  ///< m, rms of the map's part that is odd across, which is left out
};

/// One object, SI units: "dim", "drop_Pa", "drop_numerical_uncertainty_Pa", "x_m", "gap_m",
/// "wall_pressure_Pa", "mean_pressure_Pa" and more, as docs/simulation.md lists them.
std::string flow_json(const SimulatedFlow& flow, const Effort& effort, const RoofNote& roof = {});
/// The same of a passage: "dim", the drop with what is known of it, unknowns and effort.
std::string passage_json(const PassageFlow& flow, const Effort& effort);
/// {"error": {"where", "found", "mend"}}
std::string error_json(const InputError& error);
/// {"fault": text}, what no user can mend.
std::string fault_json(const std::string& text);

}  // namespace manoscope::navier_stokes

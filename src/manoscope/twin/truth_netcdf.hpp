#pragma once

#include <cstdint>
#include <filesystem>
#include <string>

#include "manoscope/flow/channel.hpp"
#include "manoscope/twin/truth.hpp"

namespace manoscope::twin {

/// What truth.nc tells besides the curves.
struct TruthHeader {
  std::string name;        ///< of the experiment
  std::uint64_t seed = 0;  ///< of the errors of the instrument
  flow::Channel channel;   ///< true sizes
  std::string inputs;      ///< one "name  sha256" of a map a line, as in the result file
  /// What the flow obeys, as CoupledOptions has it.
  std::string flow_model = "rectangle", inlet_profile = "developed";
};

/// Writes truth.nc, atomically: NetCDF-4 with CF attributes, float64, SI, and the names of the
/// result file where both tell of the same thing.
///
/// Global attributes: Conventions, title, experiment_name, seed, inputs (as in the result file);
/// flow_model and inlet_profile where the flow obeys another model than the rectangle.
/// Dimensions x, run, level. Coordinates x (m), run (label), flow_rate; pressure, deflection (run,
/// x); level_pressure (true), level_label (as the gauge read it), level_map, static_deflection
/// and, where every level has it, static_compliance (level, x); inlet_pressure, outlet_pressure,
/// parasitic_drop, transducer_drop, largest_deflection, reynolds, speed_index (run); level_snaps,
/// level_snap_jump, level_snap_position (level) and the same of runs: snap-throughs of the wall
/// since the level or run before, how far the furthest jumped, and where; channel_length,
/// channel_width, channel_height (true). The same content gives the same bytes.
///
/// @param scalars  one a run, in the order of the truth.
/// @throws InputError naming the file if it cannot be written.
void write_truth_netcdf(const std::filesystem::path& path, const Truth& truth,
                        const std::vector<RunScalars>& scalars, const TruthHeader& header);

/// Reads what write_truth_netcdf() wrote of runs and levels.
/// @throws InputError naming file and variable if something is missing, has another shape, is not
///         finite, or x does not grow.
Truth read_truth_netcdf(const std::filesystem::path& path);

}  // namespace manoscope::twin

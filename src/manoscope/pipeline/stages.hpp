#pragma once

#include <optional>
#include <string>
#include <vector>

#include "manoscope/calibration/levels.hpp"
#include "manoscope/core/cross_sections.hpp"
#include "manoscope/core/frame.hpp"
#include "manoscope/core/grid.hpp"
#include "manoscope/core/monitor.hpp"
#include "manoscope/experiment/experiment.hpp"
#include "manoscope/maps/reduce.hpp"
#include "manoscope/maps/region.hpp"
#include "manoscope/maps/response_picture.hpp"

namespace manoscope::pipeline {

/// The reduced maps of an experiment, in the order of its lists.
struct ReducedExperiment {
  ChannelFrame frame;
  CameraGrid grid;  ///< of every map
  std::vector<maps::ReducedMap> hydrostatic, flow;
  std::vector<std::string> hash;                        ///< SHA-256 of each map, hydrostatic first
  std::vector<std::vector<std::string>> file_warnings;  ///< of each map, in the same order
  std::string reference_hash;  ///< of the instrument's reference map, "" if there is none
  /// Where the middle of the wall lies against that of the frame, along the flow.
  std::optional<maps::MapShift> offset;
  /// The same across the flow, and its angle to the frame's axis: median of the hydrostatic maps
  /// that show it.
  std::optional<maps::CentreLine> centre;
  maps::ResponsePicture response;  ///< highest level minus lowest
  int level_order = 1;             ///< of the surface through the rim that was subtracted
};

/// Where the channel lies: as the experiment says, what it leaves out found from the maps of lowest
/// and highest pressure and of the largest flow rate.
maps::FoundPlace place_channel(const experiment::Experiment& experiment);

/// Reads and reduces every map, and takes back the shifts between them.
/// @throws InputError naming the first map whose pixels differ from those of the first map.
ReducedExperiment reduce_maps(const experiment::Experiment& experiment, const ChannelFrame& frame,
                              const maps::ReduceOptions& options, int n_threads,
                              const Monitor& monitor);

/// Name and SHA-256 of every map, one a line: what a result was made of.
std::string inputs_text(const experiment::Experiment& experiment, const ReducedExperiment& reduced);

/// The calibration levels of an experiment, one a map.
std::vector<calibration::Level> make_levels(const experiment::Experiment& experiment,
                                            const std::vector<maps::ReducedMap>& reduced);

/// One flow run: the mean of its maps.
struct FlowRun {
  std::string name;
  FlowRate flow_rate{};
  Profile profile;
  CrossSections sections;  ///< mean of its maps, x from the inlet edge as that of the profile
  std::optional<Pressure> transducer_drop;         ///< mean over the maps that have one
  std::optional<Pressure> transducer_uncertainty;  ///< standard, of that mean; none if not told
  std::optional<Pressure> outlet_pressure;         ///< mean over the maps that have one
};

/// Runs in the order of their first map.
std::vector<FlowRun> make_runs(const experiment::Experiment& experiment,
                               const std::vector<maps::ReducedMap>& reduced);

}  // namespace manoscope::pipeline

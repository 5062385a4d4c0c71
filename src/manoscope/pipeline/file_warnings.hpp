#pragma once

#include <string>
#include <vector>

#include "manoscope/core/error.hpp"
#include "manoscope/core/monitor.hpp"
#include "manoscope/experiment/experiment.hpp"
#include "manoscope/io/reader.hpp"

namespace manoscope::pipeline {

/// How the maps of an experiment are to be read: what section [instrument] says of them.
io::ReadOptions reading_options(const experiment::Experiment& experiment);

/// What is doubtful in the map files, each doubt once: "h03.x3p and 2 other maps: <doubt>".
/// @param warnings  of each map, hydrostatic first, in the order of the lists.
std::vector<std::string> file_warnings(const experiment::Experiment& experiment,
                                       const std::vector<std::vector<std::string>>& warnings);

/// What reading every map of an experiment shows before it is measured.
struct MapCheck {
  std::vector<std::string> warnings;  ///< as file_warnings()
  std::vector<InputError> faults;     ///< of maps that cannot be read, in the order of the lists
};

/// Reads every map, at most `n_threads` at a time (0 = all the machine has).
/// @throws Interrupted when the monitor asks to stop.
MapCheck check_maps(const experiment::Experiment& experiment, int n_threads = 0,
                    const Monitor& monitor = {});

}  // namespace manoscope::pipeline

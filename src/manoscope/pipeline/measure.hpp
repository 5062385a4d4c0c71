#pragma once

#include <string>

#include "manoscope/core/monitor.hpp"
#include "manoscope/experiment/experiment.hpp"
#include "manoscope/pipeline/measure_options.hpp"
#include "manoscope/results/measurement.hpp"

namespace manoscope::pipeline {

/// The title of the result of an experiment of that name.
std::string title_of(const std::string& experiment_name);

/// The whole chain: maps -> profiles -> constitutive curves -> p(x) -> agreement with the flow.
///
/// Maps are read and reduced one after another (at most `n_threads` at a time, 0 = all the machine
/// has); the result has the same bytes on any number of threads.
/// @throws InputError for maps that cannot be used; Interrupted when the monitor asks to stop.
results::Measurement measure(const experiment::Experiment& experiment,
                             const MeasureOptions& options = {}, int n_threads = 0,
                             const Monitor& monitor = {});

}  // namespace manoscope::pipeline

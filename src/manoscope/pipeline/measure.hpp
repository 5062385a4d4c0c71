#pragma once

#include <string>

#include "manoscope/calibration/fit_curves.hpp"
#include "manoscope/core/monitor.hpp"
#include "manoscope/experiment/experiment.hpp"
#include "manoscope/inversion/intersections.hpp"
#include "manoscope/inversion/read_nonlocal.hpp"
#include "manoscope/inversion/read_pressure.hpp"
#include "manoscope/inversion/test_section.hpp"
#include "manoscope/maps/reduce.hpp"
#include "manoscope/results/measurement.hpp"

namespace manoscope::pipeline {

/// Every option of a measurement, stage by stage.
struct MeasureOptions {
  maps::ReduceOptions reduce;
  calibration::FitCurvesOptions curves;
  inversion::ReadPressureOptions reading;
  inversion::ReadNonlocalOptions nonlocal;
  inversion::TestSectionOptions section;
  inversion::IntersectionOptions intersections;

  template <class Visitor>
  void describe(Visitor&& visit) {
    reduce.describe(visit);
    curves.describe(visit);
    reading.describe(visit);
    nonlocal.describe(visit);
    section.describe(visit);
    intersections.describe(visit);
  }
  /// @throws InputError naming the first option out of range.
  void validate() const;
};

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

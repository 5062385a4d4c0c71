#pragma once

#include "manoscope/calibration/fit_curves.hpp"
#include "manoscope/inversion/intersections.hpp"
#include "manoscope/inversion/read_nonlocal.hpp"
#include "manoscope/inversion/read_pressure.hpp"
#include "manoscope/inversion/test_section.hpp"
#include "manoscope/maps/reduce.hpp"
#include "manoscope/pipeline/compare_flow.hpp"

namespace manoscope::pipeline {

/// Every option of a measurement, stage by stage.
struct MeasureOptions {
  maps::ReduceOptions reduce;
  calibration::FitCurvesOptions curves;
  inversion::ReadPressureOptions reading;
  inversion::ReadNonlocalOptions nonlocal;
  inversion::TestSectionOptions section;
  inversion::IntersectionOptions intersections;
  CompareFlowOptions flow;

  template <class Visitor>
  void describe(Visitor&& visit) {
    reduce.describe(visit);
    curves.describe(visit);
    reading.describe(visit);
    nonlocal.describe(visit);
    section.describe(visit);
    intersections.describe(visit);
    flow.describe(visit);
  }
  /// @throws InputError naming the first option out of range.
  void validate() const;
};

}  // namespace manoscope::pipeline

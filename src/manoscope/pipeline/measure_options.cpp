#include "manoscope/pipeline/measure_options.hpp"

namespace manoscope::pipeline {

void MeasureOptions::validate() const {
  reduce.validate();
  curves.validate();
  reading.validate();
  nonlocal.validate();
  section.validate();
  intersections.validate();
  flow.validate();
}

}  // namespace manoscope::pipeline

#pragma once

#include <string>
#include <vector>

#include "manoscope/report/figure_data.hpp"
#include "manoscope/report/flow_verdict.hpp"
#include "manoscope/report/plot_script.hpp"

namespace manoscope::report {

/// Flow models of one run as the figure of p(x) shows them: one that the others are drawn against.
struct ModelsOfRun {
  struct Line {
    ModelStyle style;
    Array1 pressure;  ///< (n_x) Pa, tied to the reading at x_end
  };
  ModelStyle reference_style{"", kGreen};
  Array1 reference;          ///< (n_x) Pa, tied likewise; empty where there is no model
  std::vector<Line> others;  ///< eq. (4) and what else was run of momentum and creeping flow
  bool found() const { return reference.size() > 0; }
};

/// The verdict's model as the reference; where it has nothing to say of this run, momentum or
/// creeping flow.
ModelsOfRun models_of_run(const results::Measurement& measurement, Index run);

/// One panel: reading with its interval, and the other models, all less the reference.
void draw_differences(PlotScript& script, const results::Measurement& measurement, Index run,
                      const ModelsOfRun& models, const ReportUnits& units);

/// What the panel shows, as sentences of the caption.
std::string difference_words(const ModelsOfRun& models);

}  // namespace manoscope::report

#pragma once

#include <string>
#include <vector>

#include "manoscope/results/measurement.hpp"
#include "manoscope/results/write.hpp"

namespace manoscope::report {

struct ReportOptions {
  bool pdf = false;         ///< figures as PDF too
  bool interactive = true;  ///< maps, numbers and a script in the page

  template <class Visitor>
  void describe(Visitor&& visit) {
    visit("pdf", pdf, "write each figure as PDF too");
    visit("interactive", interactive,
          "report.html holds the maps and a script to explore them; a small page without");
  }
};

/// The figures (figures/*.svg, *.pdf) and report.html of a measurement, ready for write_result().
///
/// Figures are drawn by gnuplot, started as a separate process; where it is missing the report says
/// so and holds the tables only.
std::vector<results::ExtraFile> make_report(const results::Measurement& measurement,
                                            const ReportOptions& options = {});

}  // namespace manoscope::report

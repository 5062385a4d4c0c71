#pragma once

#include <string>
#include <vector>

#include "manoscope/report/figures.hpp"
#include "manoscope/results/measurement.hpp"

namespace manoscope::report {

/// A figure as the page shows it.
struct ShownFigure {
  Figure figure;
  std::string svg;
};

/// report.html: one page that needs no other file and no network. What is said in it is there
/// without scripts, and prints; `interactive` adds the script, the numbers and the maps that let a
/// reader explore them.
/// @param notes  what the reader should know about the page itself, e.g. that gnuplot was missing.
std::string html_page(const results::Measurement& measurement,
                      const std::vector<ShownFigure>& shown, const std::vector<std::string>& notes,
                      bool interactive);

}  // namespace manoscope::report

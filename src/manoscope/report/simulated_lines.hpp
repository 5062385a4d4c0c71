#pragma once

#include <string>
#include <vector>

#include "manoscope/report/figure_data.hpp"
#include "manoscope/report/plot_script.hpp"

namespace manoscope::report {

/// A Navier-Stokes simulation of one run as figures and tables show it.
struct SimulatedLine {
  const results::Simulation* simulation = nullptr;
  Index variant = 0;  ///< row of it
  std::string words;  ///< "Navier-Stokes 2-D", "..., side walls added", "Navier-Stokes 3-D"
  std::string label;  ///< the same for a narrow key
  int point = 1;      ///< of gnuplot
  Array1 pressure;    ///< (n_x) Pa on the measurement's stations, tied to the reading at x_end
};

/// Those of one run: in the plane first, as solved, then with what side walls add.
std::vector<SimulatedLine> simulated_lines(const results::Measurement& measurement, Index run);

/// Crosses of the lines, less a reference.
/// @param reference  (n_x) Pa; empty: nothing is taken off.
/// @param titled     whether the key names them.
void draw_crosses(PlotScript& script, const results::Measurement& measurement,
                  const std::vector<SimulatedLine>& lines, const Array1& reference,
                  const ReportUnits& units, double pressure_unit, bool titled);

/// What the crosses are, as sentences of a caption; "" without any.
std::string crosses_words(const std::vector<SimulatedLine>& lines);

}  // namespace manoscope::report

#include "manoscope/report/simulated_lines.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>

namespace manoscope::report {
namespace {

using results::Measurement;
using results::Simulation;

/// Straight between the simulation's stations; NaN outside them.
Array1 on_stations(const Simulation& s, Index variant, const Array1& x) {
  Array1 pressure = Array1::Constant(x.size(), std::nan(""));
  for (Index i = 0; i < x.size(); ++i) {
    if (s.x.size() < 2 || x[i] < s.x[0] || x[i] > s.x[s.x.size() - 1]) continue;
    const Index above = std::upper_bound(s.x.begin(), s.x.end(), x[i]) - s.x.begin();
    const Index right = std::clamp<Index>(above, 1, s.x.size() - 1);
    const double share = (x[i] - s.x[right - 1]) / (s.x[right] - s.x[right - 1]);
    pressure[i] =
        (1.0 - share) * s.pressure(variant, right - 1) + share * s.pressure(variant, right);
  }
  return pressure;
}

/// Shifted so that it meets the reading at the end of the test section; as it is where there is
/// none.
Array1 tied(const Measurement& m, Index run, const Array1& pressure) {
  for (Index ix = m.x.size(); ix-- > 0;) {
    const double shift = m.pressure(run, ix) - pressure[ix];
    if (std::islessequal(m.x[ix], m.test_section(run, 1)) && std::isfinite(shift)) {
      return pressure + shift;
    }
  }
  return pressure;
}

}  // namespace

std::vector<SimulatedLine> simulated_lines(const Measurement& m, Index run) {
  constexpr int kPlus = 1, kCross = 2, kStar = 3;
  std::vector<SimulatedLine> lines;
  for (const int dim : {2, 3}) {
    for (const Simulation& s : m.simulations) {
      if (s.run != m.run[static_cast<std::size_t>(run)] || s.dim != dim) continue;
      for (Index v = 0; v < s.pressure.rows(); ++v) {
        SimulatedLine line;
        line.simulation = &s;
        line.variant = v;
        line.words = fmt::format("Navier-Stokes {}-D{}", dim, v == 0 ? "" : ", side walls added");
        line.label = v == 0 ? line.words : fmt::format("{}-D and side walls", dim);
        line.point = dim == 3 ? kStar : v == 0 ? kPlus : kCross;
        line.pressure = tied(m, run, on_stations(s, v, m.x));
        lines.push_back(std::move(line));
      }
    }
  }
  return lines;
}

void draw_crosses(PlotScript& script, const Measurement& m, const std::vector<SimulatedLine>& lines,
                  const Array1& reference, const ReportUnits& units, double pressure_unit,
                  bool titled) {
  constexpr Index kCrosses = 32;
  for (const SimulatedLine& line : lines) {
    std::vector<Index> shown;
    const Index step = std::max<Index>(1, m.x.size() / kCrosses);
    for (Index ix = step / 2; ix < m.x.size(); ix += step) shown.push_back(ix);
    const Array1 pressure =
        reference.size() > 0 ? Array1(line.pressure - reference) : line.pressure;
    script.draw(script.add_data({at(m.x, shown) / units.x.si, at(pressure, shown) / pressure_unit}),
                fmt::format("using 1:2 with points pt {} ps 0.9 lw 1.6 lc rgb '{}' {}", line.point,
                            kBlack, titled ? title(line.label) : "notitle"));
  }
}

std::string crosses_words(const std::vector<SimulatedLine>& lines) {
  if (lines.empty()) return {};
  std::string words =
      " Crosses: Navier-Stokes flow below the measured wall, tied like the models to the reading "
      "at "
      "the end of the test section";
  const bool plane = std::any_of(lines.begin(), lines.end(), [](const SimulatedLine& line) {
    return line.simulation->variant.size() > 1;
  });
  if (plane) {
    words += "; in two dimensions there are no side walls: + as solved, x with what they add";
  }
  return words + ".";
}

}  // namespace manoscope::report

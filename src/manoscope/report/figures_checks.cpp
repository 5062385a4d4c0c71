#include <fmt/format.h>

#include <algorithm>
#include <cmath>

#include "manoscope/report/check_summary.hpp"
#include "manoscope/report/figure_data.hpp"
#include "manoscope/report/figures.hpp"
#include "manoscope/report/plot_script.hpp"

namespace manoscope::report {
namespace {

using results::Measurement;

/// Levels that have a number.
std::vector<Index> numbered_levels(const Measurement& m) {
  std::vector<Index> levels;
  for (Index k = 0; k < m.left_out_mean_error.size(); ++k) {
    if (std::isfinite(m.left_out_mean_error[k]) && m.level_pressure[k] > 0.0) levels.push_back(k);
  }
  return levels;
}

/// Error of every level against its pressure, the pulls beyond three in red.
void level_panel(PlotScript& script, const Measurement& m, const std::vector<Index>& levels) {
  const Array1 p = at(m.level_pressure, levels), error = at(m.left_out_mean_error, levels);
  const Array1 u = at(m.left_out_mean_uncertainty, levels);
  Array1 wide = error;
  for (Index i = 0; i < wide.size(); ++i) {
    if (!(std::abs(error[i]) > 3.0 * u[i])) wide[i] = std::nan("");
  }
  script.set(logarithmic_axis("x", 0.7 * p.minCoeff(), 1.4 * p.maxCoeff()));
  script.set("set xlabel 'level (Pa)'\nset ylabel 'left out minus label (Pa)'");
  script.set(fmt::format("set xzeroaxis lt 1 lw 0.8 lc rgb '{}'", kPale));
  script.draw(script.add_data({p, error, kExpansion * u}),
              fmt::format("using 1:2:3 with yerrorbars pt 7 ps 0.6 lc rgb '{}'", kBlue));
  script.draw(script.add_data({p, wide}),
              fmt::format("using 1:2 with points pt 6 ps 1.4 lw 1.6 lc rgb '{}'", kRed));
  script.plot();
}

/// Error of every level along the channel, its mean taken off: what differs from place to place.
void along_panel(PlotScript& script, const Measurement& m, const std::vector<Index>& levels) {
  const ReportUnits units = report_units(m);
  script.set("unset logscale x\nset xtics auto\nset format x '%g'");
  script.set(fmt::format("set xrange [0:{}]", plain(m.channel_length / units.x.si)));
  script.set(fmt::format("set xlabel '{{/:Italic x}} ({})'", units.x.name));
  script.set("set ylabel 'the same, less its mean (Pa)'");
  for (std::size_t i = 0; i < levels.size(); ++i) {
    const Array1 error =
        m.left_out_error.row(levels[i]).transpose() - m.left_out_mean_error[levels[i]];
    script.draw(
        script.add_data({m.left_out_x / units.x.si, error}),
        fmt::format("using 1:2 with lines lw 1.2 lc rgb '{}'",
                    ordered_colour(static_cast<Index>(i), static_cast<Index>(levels.size()))));
  }
  script.plot();
}

}  // namespace

std::optional<Figure> levels_left_out(const Measurement& m) {
  const std::vector<Index> levels = numbered_levels(m);
  if (levels.size() < 2) return std::nullopt;
  PlotScript script;
  script.set(common_settings()).set("unset key");
  script.set("set multiplot layout 1,2\nset bmargin 4\nset tmargin 1");
  level_panel(script, m, levels);
  along_panel(script, m, levels);
  script.set("unset multiplot");
  return Figure{
      "check_levels_left_out",
      "Levels read on the curves of the others",
      "Left: what the map of each level reads on curves made without it, minus its label; "
      "bars: expanded uncertainty (k = 2), the label's in it; red rings: off by more than "
      "three standard uncertainties. Right: the same along the channel, less each level's "
      "mean, from low (dark) to high pressure: a line that leaves the others points to one "
      "place in one map.",
      900,
      420,
      script.text()};
}

std::optional<Figure> cross_sections(const Measurement& m) {
  const Index n_x = m.section_x.size(), n_maps = m.shape_chi_square.rows();
  if (n_x < 2 || n_maps < 2 || !m.shape_chi_square.isFinite().any()) return std::nullopt;
  const ReportUnits units = report_units(m);
  const Array1 x = m.section_x / units.x.si;
  const Array1 number = Array1::LinSpaced(n_maps, 1.0, static_cast<double>(n_maps));
  const Array2 ratio = (m.shape_chi_square / m.shape_dof).unaryExpr([](double value) {
    return std::isfinite(value) ? std::min(std::max(value, 0.1), 1e3) : std::nan("");
  });
  PlotScript script;
  script.set(common_settings()).set("unset key").set(viridis_palette());
  script.set(fmt::format("set xlabel '{{/:Italic x}} ({})'", units.x.name));
  script.set("set ylabel 'map, levels first'\nset cblabel 'χ^2/ν'");
  script.set("set logscale cb\nset cbrange [0.5:20]\nset ytics 5 out");
  script.set(fmt::format("set yrange [{}:0.5]", plain(static_cast<double>(n_maps) + 0.5)));
  const double half = 0.5 * (x[1] - x[0]);
  script.set(fmt::format("set xrange [{}:{}]", plain(x[0] - half), plain(x[n_x - 1] + half)));
  const Index n_levels = std::count(m.map_run.begin(), m.map_run.end(), -1);
  const double border = static_cast<double>(n_levels) + 0.5;
  script.set(fmt::format("set arrow 1 from {},{} to {},{} nohead front lw 1.6 lc rgb '{}'",
                         plain(x[0] - half), plain(border), plain(x[n_x - 1] + half), plain(border),
                         kRed));
  script.draw(script.add_grid(x, number, ratio), "using 1:2:3 with image pixels");
  script.plot();
  return Figure{
      "check_cross_sections",
      "Is it pressure that bends this wall?",
      "Chi-square per degree of freedom of the wall's cross-section against the calibrated "
      "shape of the same width average, in stretches of an eighth of the width: a row a "
      "map, in the order of the table of maps, levels above the red line. About 1 (dark) "
      "where pressure alone bends the wall; a bright spot is dust, heat, a fault of the "
      "bond or of the map. White: nothing to compare with.",
      900,
      420,
      script.text()};
}

std::optional<Figure> worst_cross_section(const Measurement& m) {
  const ShapeSummary summary = summarise_shapes(m);
  if (summary.unlike.empty()) return std::nullopt;
  const Index map = summary.unlike.front();
  const Array2& misfit = m.shape_misfit[static_cast<std::size_t>(map)];
  const Index n_x = m.section_x.size(), n_z = m.section_z.size();
  if (n_x < 2 || n_z < 2) return std::nullopt;
  const ReportUnits units = report_units(m);
  const Array1 x = m.section_x / units.x.si, z = m.section_z / units.x.si;
  const double largest = largest_magnitude(misfit);
  const DisplayUnit height = length_unit(largest);
  PlotScript script;
  script.set(common_settings()).set("unset key");
  script.set(fmt::format("set palette defined (-1 '{}', 0 '#ffffff', 1 '{}')", kBlue, kRed));
  script.set(fmt::format("set xlabel '{{/:Italic x}} ({})'", units.x.name));
  script.set(fmt::format("set ylabel '{{/:Italic z}} ({})'", units.x.name));
  script.set(fmt::format("set cblabel 'misfit ({})'", height.name));
  const double bound = std::max(largest / height.si, 1e-3);
  script.set(fmt::format("set cbrange [{}:{}]", plain(-bound), plain(bound)));
  const double half_x = 0.5 * (x[1] - x[0]), half_z = 0.5 * (z[1] - z[0]);
  script.set(fmt::format("set xrange [{}:{}]", plain(x[0] - half_x), plain(x[n_x - 1] + half_x)));
  script.set(fmt::format("set yrange [{}:{}]", plain(z[0] - half_z), plain(z[n_z - 1] + half_z)));
  script.set(fmt::format(
      "set object 1 rectangle from {},graph 0 to {},graph 1 front fillstyle empty border rgb '{}' "
      "lw 1.6",
      plain(m.shape_worst(map, 0) / units.x.si), plain(m.shape_worst(map, 1) / units.x.si),
      kBlack));
  script.draw(script.add_grid(x, z, misfit / height.si), "using 1:2:3 with image pixels");
  script.plot();
  return Figure{
      "check_worst_cross_section",
      fmt::format("Misfit of the map that stands out most (number {})", map + 1),
      "Deflection minus the calibrated shape of the same width average, in the cells of the check; "
      "framed: the worst stretch. What pressure does to a wall is even across and smooth along; a "
      "spot is something else. x and z are drawn to different scales.",
      900,
      330,
      script.text()};
}

}  // namespace manoscope::report

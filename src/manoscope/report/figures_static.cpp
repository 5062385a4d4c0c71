#include <fmt/format.h>

#include <algorithm>
#include <cmath>

#include "manoscope/report/figure_data.hpp"
#include "manoscope/report/figures.hpp"
#include "manoscope/report/plot_script.hpp"

namespace manoscope::report {
namespace {

using results::Measurement;

/// Pressure labels on the profiles near mid-channel, left out where they would overlap.
void label_levels(PlotScript& script, const Measurement& m, const ReportUnits& units) {
  const double range = m.static_deflection.size() == 0
                           ? 0.0
                           : 2.0 * largest_magnitude(m.static_deflection) / units.deflection.si;
  const Index middle = m.x.size() / 2;
  double last = -10.0 * range;
  Index n_labels = 0;
  for (Index level = m.level_pressure.size() - 1; level >= 0; --level) {
    const double height = m.static_deflection(level, middle) / units.deflection.si;
    if (!std::isfinite(height)) continue;
    if (n_labels > 0 && std::abs(height - last) < 0.04 * range) continue;
    // Neighbours stand in two columns, so that a label never covers the next curve's.
    const double place = n_labels % 2 == 0 ? 0.42 : 0.58;
    const auto ix = static_cast<Index>(place * static_cast<double>(m.x.size() - 1));
    const double at_label = m.static_deflection(level, ix) / units.deflection.si;
    if (!std::isfinite(at_label)) continue;
    const DisplayUnit unit = pressure_unit(m.level_pressure(level));
    script.set(fmt::format(
        "set label '{} {}' at {},{} center front boxed font ',12' textcolor rgb \'#1c2430\'",
        short_number_text(m.level_pressure(level) / unit.si, 3), unit.name,
        plain(m.x(ix) / units.x.si), plain(at_label)));
    last = height;
    ++n_labels;
  }
}

/// Highest and lowest of the positive values at positive pressure, for the reference slopes.
struct LogRange {
  double p_low = 0.0, z_low = 0.0, p_high = 0.0, z_high = 0.0;  // at the ends in p
  double z_lowest = 0.0, z_highest = 0.0;
  Index n = 0;
};

LogRange positive_range(const Array1& p, const Array1& z) {
  LogRange range;
  for (Index i = 0; i < p.size(); ++i) {
    if (!std::isgreater(p(i), 0.0) || !std::isgreater(z(i), 0.0)) continue;
    if (range.n == 0) {
      range.p_low = p(i);
      range.z_low = range.z_lowest = z(i);
    }
    range.z_lowest = std::min(range.z_lowest, z(i));
    range.z_highest = std::max(range.z_highest, z(i));
    range.p_high = p(i);
    range.z_high = z(i);
    ++range.n;
  }
  return range;
}

Array1 only_positive(const Array1& values) {
  return values.unaryExpr(
      [](double value) { return std::isgreater(value, 0.0) ? value : std::nan(""); });
}

void log_panel(PlotScript& script, const Array1& p, const Array1& z, const Array1& expanded) {
  const LogRange range = positive_range(p, z);
  if (range.n < 2 || range.p_high <= range.p_low) return;
  script.set("set key inside bottom right vertical\nset offsets 0, 0, 0, 0");
  script.set(logarithmic_axis("x", 0.6 * range.p_low, 1.7 * range.p_high));
  script.set(logarithmic_axis("y", 0.4 * range.z_lowest, 2.0 * range.z_highest));
  const double span = std::sqrt(range.p_high / range.p_low);
  const Array1 upper{{range.p_high / span, range.p_high}};
  const Array1 lower{{range.p_low, range.p_low * std::min(span, 4.0)}};
  const auto third =
      script.add_data({upper, 1.25 * range.z_high * (upper / range.p_high).pow(1.0 / 3.0)});
  const auto first = script.add_data({lower, 0.75 * range.z_low * (lower / range.p_low)});
  script.draw(script.add_data({only_positive(p), only_positive(z), expanded}),
              fmt::format("using 1:2:3 with yerrorbars pt 7 ps 0.55 lc rgb '{}' notitle", kBlue));
  script.draw(third, fmt::format("using 1:2 with lines dt 2 lw 1.6 lc rgb '{}' {}", kBlack,
                                 title("slope 1/3 (stretching)")));
  script.draw(first, fmt::format("using 1:2 with lines dt 4 lw 1.6 lc rgb '{}' {}", kGrey,
                                 title("slope 1 (linear)")));
  script.plot();
}

}  // namespace

std::optional<Figure> static_profiles(const Measurement& m) {
  const ReportUnits units = report_units(m);
  PlotScript script;
  script.set(common_settings());
  script.set(fmt::format("set xlabel '{{/:Italic x}} ({})'", units.x.name));
  script.set(fmt::format("set ylabel '{{/:Italic ζ}} ({})'", units.deflection.name));
  script.set(fmt::format("set xrange [0:{}]", plain(m.channel_length / units.x.si)));
  script.set("unset key");
  label_levels(script, m, units);
  const Index n_levels = m.level_pressure.size();
  for (Index level = 0; level < n_levels; ++level) {
    const Array1 zeta = m.static_deflection.row(level).transpose();
    script.draw(
        script.add_data({thinned(m.x) / units.x.si, thinned(zeta) / units.deflection.si}),
        fmt::format("using 1:2 with lines lw 1.4 lc rgb '{}'", ordered_colour(level, n_levels)));
  }
  script.plot();
  if (!script.has_content()) return std::nullopt;
  return Figure{
      "fig1d_static_profiles",
      "Static deflection profiles",
      "Width-averaged deflection ζ(x) of the wall at each known uniform pressure, outlet closed. "
      "These are the local constitutive curves. Labels give the gauge pressure; a negative "
      "deflection points into the channel. As fig. 1(d) of Ozsun et al. (2013).",
      640,
      480,
      script.text()};
}

std::optional<Figure> crest_deflection(const Measurement& m) {
  const ReportUnits units = report_units(m);
  const DisplayUnit length = length_unit(largest_magnitude(m.crest_deflection));
  const Array1 p = m.level_pressure / units.pressure.si;
  const Array1 z = m.crest_deflection / length.si;
  const Array1 expanded = kExpansion * m.crest_deflection_uncertainty / length.si;
  PlotScript script;
  script.set(common_settings())
      .set("unset key")
      .set("set multiplot layout 1,2\nset bmargin 4\nset tmargin 1");
  script.set(fmt::format("set xlabel '{{/:Italic p}} ({})'", units.pressure.name));
  script.set(fmt::format("set ylabel '{{/:Italic ζ}}_p ({})'", length.name));
  const double largest = std::max(largest_magnitude(p), 1e-6);
  script.set(fmt::format("set xrange [{}:{}]", plain(-0.03 * largest), plain(1.04 * largest)));
  script.set("set xzeroaxis lt 1 lw 0.8 lc rgb '#b4b4b4'");
  const auto data = script.add_data({p, z, expanded});
  script.draw(data, fmt::format("using 1:2 with lines lw 1 lc rgb '{}'", kPale));
  script.draw(data, fmt::format("using 1:2:3 with yerrorbars pt 7 ps 0.55 lc rgb '{}'", kBlue));
  script.plot();
  if (!script.has_content()) return std::nullopt;
  log_panel(script, p, z, expanded);
  script.set("unset multiplot");
  return Figure{
      "fig1ef_crest_deflection",
      "Crest deflection against pressure",
      "Deflection ζ_p at mid-channel on the centre line against the applied pressure: left on "
      "linear axes, right on logarithmic ones, where only positive values can be shown. A "
      "stretching membrane follows the slope 1/3, a plate or a tense membrane the slope 1. Bars: "
      "expanded uncertainty, mostly smaller than the symbols. As fig. 1(e), (f) of Ozsun et al. "
      "(2013).",
      900,
      420,
      script.text()};
}

}  // namespace manoscope::report

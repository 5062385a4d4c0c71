#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <utility>

#include "manoscope/report/figure_data.hpp"
#include "manoscope/report/figures.hpp"
#include "manoscope/report/model_panel.hpp"
#include "manoscope/report/plot_script.hpp"
#include "manoscope/report/simulated_lines.hpp"

namespace manoscope::report {
namespace {

using results::Measurement;

Array1 row(const Array2& values, Index index) { return thinned(values.row(index).transpose()); }

/// Stations, pressures and bars of one run's crossings with the static profiles.
struct Crossings {
  Array1 x, pressure, bar;
};

Crossings crossings_of(const Measurement& m, Index run) {
  std::vector<Index> own;
  for (std::size_t i = 0; i < m.crossing_run.size(); ++i) {
    if (m.crossing_run[i] == run) own.push_back(static_cast<Index>(i));
  }
  return {at(m.crossing_x, own), at(m.crossing_pressure, own),
          kExpansion * at(m.crossing_x_uncertainty, own)};
}

/// Deflection of a run at any x, by a straight line between stations; NaN beside a gap.
double deflection_at(const Measurement& m, Index run, double x) {
  for (Index ix = 1; ix < m.x.size(); ++ix) {
    if (m.x(ix) < x || x < m.x(ix - 1)) continue;
    const double t = (x - m.x(ix - 1)) / (m.x(ix) - m.x(ix - 1));
    return (1.0 - t) * m.deflection(run, ix - 1) + t * m.deflection(run, ix);
  }
  return std::nan("");
}

/// Least-squares line p = c0 + c1 x through the reading in the test section; nullopt if under 2
/// points.
std::optional<std::pair<double, double>> linear_fit(const Measurement& m, Index run) {
  double n = 0, sx = 0, sp = 0, sxx = 0, sxp = 0;
  const double origin = m.test_section(run, 0);
  for (Index ix = 0; ix < m.x.size(); ++ix) {
    const double x = m.x(ix) - origin, p = m.pressure(run, ix);
    const bool inside = std::isgreaterequal(m.x(ix), m.test_section(run, 0)) &&
                        std::islessequal(m.x(ix), m.test_section(run, 1));
    if (!inside || !std::isfinite(p)) continue;
    n += 1.0;
    sx += x;
    sp += p;
    sxx += x * x;
    sxp += x * p;
  }
  const double determinant = n * sxx - sx * sx;
  if (n < 2.0 || determinant <= 0.0) return std::nullopt;
  const double slope = (n * sxp - sx * sp) / determinant;
  return std::pair{(sp - slope * sx) / n - slope * origin, slope};
}

void shade_test_section(PlotScript& script, const Measurement& m, Index run,
                        const ReportUnits& units) {
  const double start = m.test_section(run, 0), end = m.test_section(run, 1);
  if (!std::isfinite(start) || !std::isfinite(end)) return;
  script.set(
      fmt::format("set object rectangle from {}, graph 0 to {}, graph 1 behind fillcolor rgb "
                  "'#e9eef3' fillstyle solid noborder",
                  plain(start / units.x.si), plain(end / units.x.si)));
}

/// "[low:high]" of the pressures that matter in the figure: the intervals in the test section and
/// what QR gives. Near the ends, where the wall hardly answers, intervals may be far wider: they
/// are cut.
std::string pressure_range(const Measurement& m, const std::vector<Index>& runs, double unit) {
  double low = 0.0, high = 0.0;
  const auto include = [&](double value) {
    if (!std::isfinite(value)) return;
    low = std::min(low, value);
    high = std::max(high, value);
  };
  for (const Index run : runs) {
    for (Index ix = 0; ix < m.x.size(); ++ix) {
      include(m.resistance_pressure(run, ix));
      if (!std::isgreaterequal(m.x(ix), m.test_section(run, 0)) ||
          !std::islessequal(m.x(ix), m.test_section(run, 1))) {
        continue;
      }
      include(m.pressure_lower(run, ix));
      include(m.pressure_upper(run, ix));
    }
  }
  if (high <= low) return "[*:*]";
  const double room = 0.08 * (high - low);
  return fmt::format("[{}:{}]", plain((low < 0.0 ? low - room : 0.0) / unit),
                     plain((high + room) / unit));
}

void draw_linear_fit(PlotScript& script, const Measurement& m, Index run, const ReportUnits& units,
                     const DisplayUnit& pressure) {
  const auto fit = linear_fit(m, run);
  if (!fit) return;
  const Array1 x = m.test_section.row(run).transpose();
  const Array1 p = fit->first + fit->second * x;
  const double slope = fit->second * units.x.si / pressure.si;
  script.draw(script.add_data({x / units.x.si, p / pressure.si}),
              fmt::format("using 1:2 with lines dt 3 lw 1.6 lc rgb '{}' {}", kBlack,
                          title(fmt::format("linear fit, {} {}/{}", number_text(slope, 3),
                                            pressure.name, units.x.name))));
}

std::optional<Figure> pressure_of_run(const Measurement& m, Index run, Figure figure) {
  const ReportUnits units = report_units(m);
  const DisplayUnit unit = pressure_unit(largest_magnitude(row(m.pressure, run)));
  const ModelsOfRun models = models_of_run(m, run);
  const std::vector<SimulatedLine> simulated = simulated_lines(m, run);
  PlotScript script;
  script.set(common_settings());
  script.set("set key maxrows 3 width -9 font ',13'");
  if (models.found()) {
    script.set(fmt::format("set key at screen 0.5,0.995 center top vertical maxrows {} width -4",
                           simulated.empty() ? 4 : 5));
    script.set("set multiplot\nset lmargin at screen 0.12\nset rmargin at screen 0.87");
    script.set(fmt::format("set tmargin at screen {}\nset bmargin at screen 0.47\nset format x ''",
                           simulated.empty() ? "0.875" : "0.85"));
  } else {
    script.set(fmt::format("set xlabel '{{/:Italic x}} ({})'", units.x.name));
  }
  script.set(fmt::format("set ylabel '{{/:Italic p}} ({})' textcolor rgb '{}'", unit.name, kBlue));
  script.set(fmt::format("set y2label '{{/:Italic ζ}} ({})' textcolor rgb '{}'",
                         units.deflection.name, kRed));
  script.set("set ytics nomirror\nset y2tics in scale 0.8");
  script.set(fmt::format("set xrange [0:{}]", plain(m.channel_length / units.x.si)));
  script.set("set yrange " + pressure_range(m, {run}, unit.si));
  shade_test_section(script, m, run, units);
  const Array1 x = thinned(m.x) / units.x.si;
  script.draw(script.add_data({x, row(m.deflection, run) / units.deflection.si}),
              fmt::format("using 1:2 axes x1y2 with lines lw 1.4 lc rgb '{}' {}", kRed,
                          title("deflection {/:Italic ζ} (right axis)")));
  const auto band = script.add_data(
      {x, row(m.pressure_lower, run) / unit.si, row(m.pressure_upper, run) / unit.si});
  script.draw(band,
              fmt::format("using 1:2:3 with filledcurves fc rgb '{}' fs transparent solid 0.3 "
                          "noborder {}",
                          kBlue, title(fmt::format("{:.3g} % interval", 100.0 * m.coverage))));
  const auto pressure = script.add_data({x, row(m.pressure, run) / unit.si});
  script.draw(pressure, fmt::format("using 1:2 with lines lw 2.4 lc rgb '{}' {}", kBlue,
                                    title("{/:Italic p}({/:Italic x}) read off the wall")));
  script.draw(script.add_data({x, row(m.resistance_pressure, run) / unit.si}),
              fmt::format("using 1:2 with lines dt 2 lw 2 lc rgb '{}' {}", kGrey,
                          title("from {/:Italic QR} of the measured gap")));
  if (models.found()) {
    script.draw(script.add_data({x, thinned(models.reference) / unit.si}),
                fmt::format("using 1:2 with lines lw 1.4 lc rgb '{}' {}",
                            models.reference_style.colour, title(models.reference_style.words)));
  }
  draw_linear_fit(script, m, run, units, unit);
  draw_crosses(script, m, simulated, {}, units, unit.si, true);
  const Crossings crossings = crossings_of(m, run);
  if (crossings.x.size() > 0) {
    script.draw(script.add_data({crossings.x / units.x.si, crossings.pressure / unit.si,
                                 crossings.bar / units.x.si}),
                fmt::format("using 1:2:3 with xerrorbars pt 6 ps 0.8 lw 1.5 lc rgb '{}' {}", kBlack,
                            title("crossings with static profiles")));
  }
  if (pressure.empty() && crossings.x.size() == 0) return std::nullopt;
  script.plot();
  if (models.found()) {
    script.set(
        "unset y2tics\nunset y2label\nset tmargin at screen 0.4\nset bmargin at screen 0.09");
    script.set(
        "set key at screen 0.5,0.45 center top maxrows 1 width -2 samplen 2\nset format x '%g'");
    script.set(fmt::format("set xlabel '{{/:Italic x}} ({})'", units.x.name));
    draw_differences(script, m, run, models, units);
    script.set("unset multiplot");
  }
  figure.title = "Pressure along the channel at " + flow_rate_label(m, run, units);
  figure.caption = fmt::format(
      "Gauge pressure p(x) at {} read off the wall (blue) with its {:.3g} % interval; circles: "
      "where the flow profile crosses a static profile of known pressure. Dashed: what the "
      "hydraulic resistance of the measured gap gives, tied to the reading at the end of the "
      "test section; dotted: straight line through the reading. Red: deflection. The test "
      "section is shaded; a gap in the line is a station where the wall gives no answer. Near "
      "the ends the interval may leave the frame.{}{} As fig. 3{} of Ozsun et al. (2013).",
      flow_rate_label(m, run, units), 100.0 * m.coverage, crosses_words(simulated),
      models.found() ? difference_words(models) : std::string(), figure.caption);
  figure.width = 640;
  figure.height = (models.found() ? 740 : 500) + (simulated.empty() ? 0 : 20);
  figure.script = script.text();
  return figure;
}

}  // namespace

std::optional<Figure> profiles_overlaid(const Measurement& m) {
  const ReportUnits units = report_units(m);
  const auto runs = runs_by_flow_rate(m);
  if (runs.empty() || m.level_pressure.size() == 0) return std::nullopt;
  PlotScript script;
  script.set(common_settings());
  script.set(fmt::format("set xlabel '{{/:Italic x}} ({})'", units.x.name));
  script.set(fmt::format("set ylabel '{{/:Italic ζ}} ({})'", units.deflection.name));
  script.set(fmt::format("set xrange [0:{}]", plain(m.channel_length / units.x.si)));
  const Array1 x = thinned(m.x) / units.x.si;
  bool titled = false;
  for (Index level = 0; level < m.level_pressure.size(); ++level) {
    const auto data = script.add_data({x, row(m.static_deflection, level) / units.deflection.si});
    if (data.empty()) continue;
    script.draw(data, fmt::format("using 1:2 with lines lw 0.9 lc rgb '{}' {}", kPale,
                                  titled ? "notitle" : title("static profiles")));
    titled = true;
  }
  std::vector<std::pair<Index, const char*>> shown{{runs.back(), kBlue}};
  if (runs.size() > 1) shown.emplace_back(runs.front(), kGreen);
  for (const auto& [run, colour] : shown) {
    script.draw(script.add_data({x, row(m.deflection, run) / units.deflection.si}),
                fmt::format("using 1:2 with lines lw 2.6 lc rgb '{}' {}", colour,
                            title(flow_rate_label(m, run, units))));
    const Crossings crossings = crossings_of(m, run);
    if (crossings.x.size() == 0) continue;
    const Index which = run;
    const Array1 height = crossings.x.unaryExpr(
        [&](double place) { return deflection_at(m, which, place) / units.deflection.si; });
    script.draw(
        script.add_data({crossings.x / units.x.si, height}),
        fmt::format("using 1:2 with points pt 6 ps 0.7 lw 1.4 lc rgb '{}' notitle", kBlack));
  }
  script.plot();
  if (!script.has_content()) return std::nullopt;
  return Figure{
      "fig3a_profiles_overlaid",
      "Flow profiles over static profiles",
      "Deflection at the lowest and the highest flow rate (thick) over the static profiles of "
      "known pressure (grey). Where they cross (circles), the pressure in the flow is that of "
      "the static profile. As fig. 3(a) of Ozsun et al. (2013).",
      640,
      480,
      script.text()};
}

std::optional<Figure> pressure_at_lowest_flow(const Measurement& m) {
  const auto runs = runs_by_flow_rate(m);
  if (runs.size() < 2) return std::nullopt;  // the only run is the highest
  Figure figure;
  figure.name = "fig3b_pressure_lowest_flow";
  figure.caption = "(b)";
  return pressure_of_run(m, runs.front(), std::move(figure));
}

std::optional<Figure> pressure_at_highest_flow(const Measurement& m) {
  const auto runs = runs_by_flow_rate(m);
  if (runs.empty()) return std::nullopt;
  Figure figure;
  figure.name = "fig3c_pressure_highest_flow";
  figure.caption = "(c)";
  return pressure_of_run(m, runs.back(), std::move(figure));
}

std::optional<Figure> pressure_of_all_runs(const Measurement& m) {
  const ReportUnits units = report_units(m);
  const auto runs = runs_by_flow_rate(m);
  const auto named = spread(runs, 10);
  const DisplayUnit unit = pressure_unit(largest_magnitude(m.pressure));
  PlotScript script;
  script.set(common_settings());
  script.set("set key outside right center vertical");
  script.set(fmt::format("set xlabel '{{/:Italic x}} ({})'", units.x.name));
  script.set(fmt::format("set ylabel '{{/:Italic p}} ({})'", unit.name));
  script.set(fmt::format("set xrange [0:{}]", plain(m.channel_length / units.x.si)));
  script.set("set yrange " + pressure_range(m, runs, unit.si));
  if (!runs.empty()) shade_test_section(script, m, runs.back(), units);
  const Array1 x = thinned(m.x) / units.x.si;
  for (std::size_t i = runs.size(); i-- > 0;) {
    const Index run = runs[i];
    const auto colour = ordered_colour(static_cast<Index>(i), static_cast<Index>(runs.size()));
    const bool is_named = std::find(named.begin(), named.end(), run) != named.end();
    script.draw(script.add_data({x, row(m.pressure_lower, run) / unit.si,
                                 row(m.pressure_upper, run) / unit.si}),
                fmt::format("using 1:2:3 with filledcurves fc rgb '{}' fs transparent solid 0.3 "
                            "noborder notitle",
                            colour));
    script.draw(script.add_data({x, row(m.pressure, run) / unit.si}),
                fmt::format("using 1:2 with lines lw 1.6 lc rgb '{}' {}", colour,
                            is_named ? title(flow_rate_label(m, run, units)) : "notitle"));
  }
  script.plot();
  if (!script.has_content()) return std::nullopt;
  return Figure{
      "pressure_all_runs",
      "Pressure along the channel, all runs",
      fmt::format("Gauge pressure p(x) read off the wall at every flow rate, with {:.3g} % "
                  "intervals (bands, often thinner than the lines). The test section of the "
                  "highest flow rate is shaded.",
                  100.0 * m.coverage),
      640,
      440,
      script.text()};
}

}  // namespace manoscope::report

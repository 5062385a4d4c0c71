#include "manoscope/report/judged_figures.hpp"

#include <fmt/format.h>
#include <fmt/ranges.h>

#include <algorithm>
#include <cmath>
#include <limits>
#include <numbers>
#include <optional>
#include <utility>

#include "manoscope/core/error.hpp"
#include "manoscope/core/uncertainty.hpp"
#include "manoscope/report/figure_data.hpp"
#include "manoscope/report/plot_script.hpp"

namespace manoscope::report {
namespace {

using results::Measurement;

constexpr double kNan = std::numeric_limits<double>::quiet_NaN();
constexpr const char* kShade = "#e9eef3";  // of the stretch that is judged

bool is_inside(const JudgedRun& run, double x) {
  return std::isgreaterequal(x, run.x_start) && std::islessequal(x, run.x_end);
}

/// Smallest and largest of what matters in the stretch, 0 included.
struct Range {
  double low = 0.0, high = 0.0;

  void include(const Measurement& m, const JudgedRun& run, const Array1& values) {
    for (Index i = 0; i < values.size(); ++i) {
      if (!is_inside(run, m.x[i]) || !std::isfinite(values[i])) continue;
      low = std::min(low, values[i]);
      high = std::max(high, values[i]);
    }
  }
  /// "[low:high]" with some room; anything if the range is empty.
  std::string text() const {
    if (high <= low) return "[*:*]";
    const double room = 0.08 * (high - low);
    return fmt::format("[{}:{}]", plain(low - room), plain(high + room));
  }
};

struct Part {
  const Array1* values;
  const char* name;
  const char* colour;
  const char* dash;
};

std::vector<Part> parts_of(const JudgedRun& run) {
  std::vector<Part> parts;
  const auto add = [&](const Array1& values, const char* name, const char* colour,
                       const char* dash) {
    if (values.size() > 0) parts.push_back({&values, name, colour, dash});
  };
  add(run.labels, "labels", kRed, "dt 1");
  add(run.maps, "maps", kGreen, "dt 1");
  if (run.locality.size() > 0) {
    add(run.curve_shape, "curve shape", kPurple, "dt 2");
    add(run.locality, "locality", kBlack, "dt 4");
  } else {
    add(run.curve_shape_and_locality, "shape and locality", kPurple, "dt 2");
  }
  if ((run.neighbourhood.isNaN() || run.neighbourhood == 0.0).all()) return parts;
  add(run.neighbourhood, "neighbourhood", kGrey, "dt 4");
  return parts;
}

/// Pulls of one run in its stretch.
std::vector<double> pulls_of(const Measurement& m, const JudgedRun& run, Index r) {
  std::vector<double> values;
  for (Index i = 0; i < m.x.size(); ++i) {
    const double pull = (m.pressure(r, i) - run.true_pressure[i]) / m.pressure_uncertainty(r, i);
    if (is_inside(run, m.x[i]) && std::isfinite(pull)) values.push_back(pull);
  }
  return values;
}

void shade_stretch(PlotScript& script, const JudgedRun& run, const ReportUnits& units) {
  if (!std::isfinite(run.x_start) || !std::isfinite(run.x_end)) return;
  script.set(
      fmt::format("set object 1 rectangle from {}, graph 0 to {}, graph 1 behind fillcolor rgb "
                  "'{}' fillstyle solid noborder",
                  plain(run.x_start / units.x.si), plain(run.x_end / units.x.si), kShade));
}

void draw_error_panel(PlotScript& script, const Measurement& m, const JudgedRun& run, Index r,
                      const Array1& x) {
  const Array1 error = m.pressure.row(r).transpose() - run.true_pressure;
  const Array1 lower = m.pressure_lower.row(r).transpose() - run.true_pressure;
  const Array1 upper = m.pressure_upper.row(r).transpose() - run.true_pressure;
  Range range;
  for (const Array1* values : {&error, &lower, &upper}) range.include(m, run, *values);
  script.set("set yrange " + range.text());
  script.draw(script.add_data({x, thinned(lower), thinned(upper)}),
              fmt::format("using 1:2:3 with filledcurves fc rgb '{}' fs transparent solid 0.3 "
                          "noborder {}",
                          kBlue, title(fmt::format("{:.3g} % interval", 100.0 * m.coverage))));
  script.draw(script.add_data({x, thinned(error)}),
              fmt::format("using 1:2 with lines lw 2 lc rgb '{}' {}", kBlue,
                          title("error at " + flow_rate_label(m, r, report_units(m)))));
  if (error.isFinite().any() && std::isfinite(run.x_start) && std::isfinite(run.x_end)) {
    script.draw("keyentry", fmt::format("with boxes fc rgb '{}' fs solid border lc rgb '{}' {}",
                                        kShade, kGrey, title("judged")));
  }
  script.plot();
}

void draw_parts_panel(PlotScript& script, const Measurement& m, const JudgedRun& run,
                      const std::vector<Part>& parts, const Array1& x) {
  Range range;
  for (const Part& part : parts) range.include(m, run, *part.values);
  script.set("set yrange " + range.text());
  for (const Part& part : parts) {
    script.draw(script.add_data({x, thinned(*part.values)}),
                fmt::format("using 1:2 with lines lw 2 {} lc rgb '{}' {}", part.dash, part.colour,
                            title(part.name)));
  }
  script.plot();
}

}  // namespace

std::optional<Figure> error_of_run(const Measurement& m, const std::vector<JudgedRun>& judged,
                                   Index r) {
  const JudgedRun& run = judged[static_cast<std::size_t>(r)];
  const ReportUnits units = report_units(m);
  const std::vector<Part> parts = parts_of(run);
  const bool has_parts = std::any_of(
      parts.begin(), parts.end(), [](const Part& part) { return part.values->isFinite().any(); });
  PlotScript script;
  script.set(common_settings());
  if (has_parts) script.set("set multiplot");
  script.set("set lmargin at screen 0.12\nset rmargin at screen 0.97");
  script.set(fmt::format("set xrange [0:{}]", plain(m.channel_length / units.x.si)));
  script.set(fmt::format("set xzeroaxis lt 1 lw 1 lc rgb '{}'", kGrey));
  script.set("set ylabel 'error (Pa)' offset 0.5");
  shade_stretch(script, run, units);
  const Array1 x = thinned(m.x) / units.x.si;
  const std::string x_label = fmt::format("set xlabel '{{/:Italic x}} ({})'", units.x.name);
  if (has_parts) {
    script.set("set tmargin at screen 0.935\nset bmargin at screen 0.56\nset format x ''");
    script.set("set key at screen 0.545,0.98 center top maxrows 1 samplen 2 width -2 font ',12'");
  } else {
    script.set(x_label);
  }
  draw_error_panel(script, m, run, r, x);
  if (has_parts) {
    script.set("set tmargin at screen 0.47\nset bmargin at screen 0.09\nset format x '%g'");
    script.set("set key at screen 0.545,0.525 center top maxrows 2 samplen 2 width -2 font ',12'");
    script.set(x_label).set("set ylabel 'its parts (Pa)' offset 0.5");
    draw_parts_panel(script, m, run, parts, x);
    script.set("unset multiplot");
  }
  if (!script.has_content()) return std::nullopt;
  Figure figure;
  figure.name = fmt::format("judge_error_run{:02d}", r + 1);
  figure.title = "Error of the pressure at " + flow_rate_label(m, r, units);
  figure.caption = fmt::format(
      "Pressure read off the wall minus true pressure at {}, in its {:.3g} % interval"
      "{}. The stretch that is judged is shaded.",
      flow_rate_label(m, r, units), 100.0 * m.coverage,
      has_parts ? ", and below it the parts that add up to it" : "");
  figure.width = 640;
  figure.height = has_parts ? 660 : 360;
  figure.script = script.text();
  return figure;
}

std::optional<Figure> pulls(const Measurement& m, const std::vector<JudgedRun>& judged) {
  constexpr double kWidth = 0.5, kEnd = 4.0;
  constexpr auto kBins = static_cast<Index>(2.0 * kEnd / kWidth);
  Array1 density = Array1::Zero(kBins);
  double n_runs = 0.0, below = 0.0, above = 0.0;  // the last two: shares beyond the ends
  for (Index r = 0; r < static_cast<Index>(judged.size()); ++r) {
    const std::vector<double> values = pulls_of(m, judged[static_cast<std::size_t>(r)], r);
    if (values.empty()) continue;
    n_runs += 1.0;
    const double share = 1.0 / static_cast<double>(values.size());
    for (const double pull : values) {
      if (pull < -kEnd) {
        below += share;
      } else if (pull >= kEnd) {
        above += share;
      } else {
        const auto place = static_cast<Index>(std::floor((pull + kEnd) / kWidth));
        density[std::min(place, kBins - 1)] += share / kWidth;
      }
    }
  }
  if (n_runs == 0.0) return std::nullopt;
  density /= n_runs;
  const Array1 beyond{{below / n_runs, above / n_runs}};
  const Array1 centre = Array1::LinSpaced(kBins, -kEnd + 0.5 * kWidth, kEnd - 0.5 * kWidth);
  const Array1 t = Array1::LinSpaced(161, -kEnd, kEnd);
  const Array1 normal = (-0.5 * t.square()).exp() / std::sqrt(2.0 * std::numbers::pi);
  PlotScript script;
  script.set(common_settings());
  script.set("set xlabel 'pull: error / standard uncertainty'\nset ylabel 'density'");
  // What lies beyond stands apart, outside the axis of pulls.
  constexpr double kBeyond = kEnd + 2.0 * kWidth;
  const double top =
      1.12 * std::max({density.maxCoeff(), normal.maxCoeff(), beyond.maxCoeff() / kWidth});
  script.set(fmt::format("set xrange [{}:{}]\nset xtics 1", plain(-kBeyond - 1.5 * kWidth),
                         plain(kBeyond + 1.5 * kWidth)));
  script.set(fmt::format("set xtics ('< −4' {}, -4, -3, -2, -1, 0, 1, 2, 3, 4, '> 4' {})",
                         plain(-kBeyond), plain(kBeyond)));
  script.set(fmt::format("set yrange [0:{}]", plain(top)));
  for (const int side : {0, 1}) {
    if (beyond[side] == 0.0) continue;
    script.set(fmt::format("set label '{} %' at {},{} center font ',12' front",
                           short_number_text(100.0 * beyond[side], 2),
                           plain(side == 0 ? -kBeyond : kBeyond),
                           plain(beyond[side] / kWidth + 0.03 * top)));
  }
  script.draw(script.add_data({centre, density}),
              fmt::format("using 1:2:({}) with boxes fc rgb '{}' fs transparent solid 0.35 border "
                          "lc rgb '{}' {}",
                          plain(kWidth), kBlue, kBlue, title("pulls of all stations")));
  const Array1 places{{-kBeyond, kBeyond}};
  script.draw(
      beyond.maxCoeff() > 0.0 ? script.add_data({places, Array1(beyond / kWidth)}) : "",
      fmt::format("using 1:2:({}) with boxes fc rgb '{}' fs transparent solid 0.5 border lc "
                  "rgb '{}' {}",
                  plain(kWidth), kPale, kGrey, title("all beyond ±4")));
  script.draw(script.add_data({t, normal}), fmt::format("using 1:2 with lines lw 2 lc rgb '{}' {}",
                                                        kBlack, title("normal law, width 1")));
  script.plot();
  return Figure{
      "judge_pulls",
      "Pulls of the pressure",
      "Error over stated standard uncertainty at all stations of the judged stretches, "
      "each run with the same weight; the grey bars apart hold all that lies beyond 4 either way. "
      "Stations share the errors of labels and maps, so that one experiment rarely fills "
      "the normal law.",
      640,
      420,
      script.text()};
}

std::optional<Figure> pulls_along(const Measurement& m, const std::vector<JudgedRun>& judged) {
  constexpr double kEnd = 5.0;
  const ReportUnits units = report_units(m);
  const Index n_x = m.x.size();
  // Means over the runs at each station: of the square of the pull, and of what its bars hold.
  Array1 squares = Array1::Zero(n_x), held = squares, count = squares;
  PlotScript script;
  script.set(common_settings());
  script.set("set multiplot\nset lmargin at screen 0.12\nset rmargin at screen 0.97");
  script.set(fmt::format("set xrange [0:{}]", plain(m.channel_length / units.x.si)));
  script.set("set tmargin at screen 0.935\nset bmargin at screen 0.53\nset format x ''");
  script.set("set key at screen 0.545,0.985 center top maxrows 1 samplen 2 font ',12'");
  script.set(fmt::format("set yrange [{}:{}]\nset ylabel 'pull'", plain(-kEnd), plain(kEnd)));
  const Array1 x = thinned(m.x) / units.x.si;
  for (Index r = 0; r < static_cast<Index>(judged.size()); ++r) {
    const JudgedRun& run = judged[static_cast<std::size_t>(r)];
    Array1 pull = Array1::Constant(n_x, kNan);
    for (Index i = 0; i < n_x; ++i) {
      const double one = (m.pressure(r, i) - run.true_pressure[i]) / m.pressure_uncertainty(r, i);
      if (!is_inside(run, m.x[i]) || !std::isfinite(one)) continue;
      pull[i] = one;
      count[i] += 1.0;
      squares[i] += one * one;
      if (m.pressure_lower(r, i) <= run.true_pressure[i] &&
          run.true_pressure[i] <= m.pressure_upper(r, i)) {
        held[i] += 1.0;
      }
    }
    if (!pull.isFinite().any()) continue;
    script.draw(script.add_data({x, thinned(pull)}),
                fmt::format("using 1:2 with lines lw 1 lc rgb '{}' notitle", kBlue));
  }
  if (count.maxCoeff() == 0.0) return std::nullopt;
  const Array1 ends{{0.0, m.channel_length / units.x.si}};
  for (const double sign : {-1.0, 1.0}) {
    script.draw(script.add_data({ends, Array1::Constant(2, sign * kExpansion)}),
                fmt::format("using 1:2 with lines dt 2 lw 1.4 lc rgb '{}' notitle", kGrey));
  }
  const Array1 mean = (count > 0.0).select(1.0 / count.max(1.0), Array1::Constant(n_x, kNan));
  script.draw(
      script.add_data({x, thinned(Array1((squares * mean).sqrt()))}),
      fmt::format("using 1:2 with lines lw 2 lc rgb '{}' {}", kBlack, title("rms over the runs")));
  script.plot();
  script.set("set tmargin at screen 0.445\nset bmargin at screen 0.11\nset format x '%g'");
  script.set("set key at screen 0.545,0.5 center top maxrows 1 samplen 2 font ',12'");
  script.set(fmt::format("set xlabel '{{/:Italic x}} ({})'", units.x.name));
  script.set("set yrange [0:106]\nset ytics 20\nset ylabel 'runs within their bars (%)'");
  script.draw(script.add_data({ends, Array1::Constant(2, 100.0 * m.coverage)}),
              fmt::format("using 1:2 with lines dt 2 lw 1.4 lc rgb '{}' {}", kGrey,
                          title(fmt::format("nominal {:.3g} %", 100.0 * m.coverage))));
  script.draw(script.add_data({x, thinned(Array1(100.0 * held * mean))}),
              fmt::format("using 1:2 with lines lw 2 lc rgb '{}' notitle", kRed));
  script.plot();
  script.set("unset multiplot");
  return Figure{
      "judge_along",
      "Pulls and coverage along the channel",
      "Above: error over stated standard uncertainty at every station, a line for each run, their "
      "rms in black, dashed the ends of the 95 % interval. Below: the share of the runs whose "
      "interval holds the truth, station by station. Runs share the errors of the calibration: "
      "where one is off the others often are, too.",
      640,
      620,
      script.text()};
}

std::optional<Figure> coverage_by_run(const Measurement& m, const std::vector<JudgedRun>& judged) {
  const ReportUnits units = report_units(m);
  const auto n = static_cast<Index>(judged.size());
  Array1 share_68 = Array1::Constant(n, kNan), share = share_68;
  std::vector<std::string> ticks;
  const Index step = std::max<Index>(1, (n + 11) / 12);
  for (Index r = 0; r < n; ++r) {
    const JudgedRun& run = judged[static_cast<std::size_t>(r)];
    if (r % step == 0) {
      ticks.push_back(
          fmt::format("'{}' {}", short_number_text(m.flow_rate(r) / units.flow_rate.si), r + 1));
    }
    if (pulls_of(m, run, r).empty()) continue;
    share_68[r] = 100.0 * run.coverage_68;
    share[r] = 100.0 * run.coverage;
  }
  if (!share.isFinite().any()) return std::nullopt;
  const Array1 place = Array1::LinSpaced(n, 1.0, static_cast<double>(n));
  const Array1 ends{{0.4, static_cast<double>(n) + 0.6}};
  PlotScript script;
  script.set(common_settings());
  script.set(fmt::format("set xlabel 'run: {{/:Italic Q}} ({})'", units.flow_rate.name));
  script.set("set ylabel 'stations within their bars (%)'\nset yrange [0:106]\nset ytics 20");
  script.set(fmt::format("set xrange [{}:{}]\nset xtics ({})", plain(ends[0]), plain(ends[1]),
                         fmt::join(ticks, ", ")));
  const double nominal = 100.0 * m.coverage;
  // Each nominal share is written on its line, in the colour of the points that belong to it.
  const auto level = [&](double percent, const char* colour) {
    script.draw(script.add_data({ends, Array1::Constant(2, percent)}),
                fmt::format("using 1:2 with lines dt 2 lw 1.4 lc rgb '{}' notitle", colour));
    script.set(
        fmt::format("set label 'nominal {:.3g} %' at graph 1.01, first {} left font ',12' "
                    "textcolor rgb '{}'",
                    percent, plain(percent), colour));
  };
  script.set("set rmargin at screen 0.825");
  level(nominal, kBlue);
  level(68.27, kRed);
  script.draw(script.add_data({place, share}),
              fmt::format("using 1:2 with points pt 7 ps 0.9 lc rgb '{}' {}", kBlue,
                          title(fmt::format("in the {:.3g} % interval", nominal))));
  script.draw(script.add_data({place, share_68}),
              fmt::format("using 1:2 with points pt 5 ps 0.9 lc rgb '{}' {}", kRed,
                          title("within one standard uncertainty")));
  script.plot();
  return Figure{
      "judge_coverage",
      "Coverage, run by run",
      "Share of the stations of the judged stretch whose interval holds the truth: blue circles "
      "the "
      "interval of the result, red squares one standard uncertainty; dashed in the same colour the "
      "share that is nominal. Stations share the errors of labels and maps: the share of one "
      "run scatters widely about it.",
      640,
      400,
      script.text()};
}

std::vector<results::ExtraFile> judged_figures(const Measurement& m,
                                               const std::vector<JudgedRun>& judged) {
  MANO_ASSERT(static_cast<Index>(judged.size()) == m.flow_rate.size());
  std::vector<std::optional<Figure>> list;
  for (Index r = 0; r < m.flow_rate.size(); ++r) list.push_back(error_of_run(m, judged, r));
  list.push_back(pulls(m, judged));
  list.push_back(pulls_along(m, judged));
  list.push_back(coverage_by_run(m, judged));
  std::vector<results::ExtraFile> files;
  for (const auto& figure : list) {
    if (!figure) continue;
    auto drawn = draw(*figure, false);
    if (!drawn) return {};
    files.push_back({"figures/" + figure->name + ".svg", std::move(drawn->svg)});
  }
  return files;
}

}  // namespace manoscope::report

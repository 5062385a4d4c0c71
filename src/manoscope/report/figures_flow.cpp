#include <fmt/format.h>

#include <algorithm>
#include <cmath>

#include "manoscope/report/figure_data.hpp"
#include "manoscope/report/figures.hpp"
#include "manoscope/report/plot_script.hpp"

namespace manoscope::report {
namespace {

using results::Measurement;

/// Transducer reading minus the parasitic part; the whole reading where that is not known.
Array1 without_parasitic(const Measurement& m) {
  return Array1::NullaryExpr(m.transducer_drop.size(), [&](Index run) {
    const double parasitic = m.parasitic_drop(run);
    return m.transducer_drop(run) - (std::isnan(parasitic) ? 0.0 : parasitic);
  });
}

/// Draws everything of fig. 2(a) into the present panel.
void draw_drops(PlotScript& script, const Measurement& m, const ReportUnits& units, bool titled) {
  const auto runs = runs_by_flow_rate(m);
  const Array1 Q = at(m.flow_rate, runs) / units.flow_rate.si;
  const auto drop = [&](const Array1& values) -> Array1 {
    return at(values, runs) / units.drop.si;
  };
  const Array1 expanded = kExpansion * drop(m.extracted_drop_uncertainty);
  const Array1 transducer = drop(m.transducer_drop), parasitic = drop(m.parasitic_drop);
  const Array1 uncorrected = Array1::NullaryExpr(
      Q.size(), [&](Index i) { return std::isnan(parasitic(i)) ? transducer(i) : std::nan(""); });
  const auto name = [&](const char* words) {
    return titled ? title(words) : std::string("notitle");
  };
  script.draw(script.add_data({Q, drop(m.channel_resistance_drop)}),
              fmt::format("using 1:2 with lines dt 3 lw 2 lc rgb '{}' {}", kGrey,
                          name("{/:Italic QR}, whole channel")));
  script.draw(script.add_data({Q, transducer - parasitic}),
              fmt::format("using 1:2 with points pt 9 ps 0.8 lc rgb '{}' {}", kRed,
                          name("transducer − parasitic, whole channel")));
  script.draw(script.add_data({Q, uncorrected}),
              fmt::format("using 1:2 with points pt 8 ps 0.8 lc rgb '{}' {}", kRed,
                          name("transducer, parasitic part included")));
  script.draw(script.add_data({Q, drop(m.resistance_drop)}),
              fmt::format("using 1:2 with lines dt 2 lw 2 lc rgb '{}' {}", kBlack,
                          name("{/:Italic QR}, test section")));
  script.draw(script.add_data({Q, drop(m.extracted_drop), expanded}),
              fmt::format("using 1:2:3 with yerrorbars pt 7 ps 0.6 lw 1.4 lc rgb '{}' {}", kBlue,
                          name("Δ{/:Italic p}_e read off the wall, test section")));
}

/// Settings of a logarithmic axis around the positive numbers, with some room; "" without any.
std::string axis_around(const char* axis, const std::vector<Array1>& lists, double scale) {
  double low = 0.0, high = 0.0;
  for (const Array1& list : lists) {
    for (Index i = 0; i < list.size(); ++i) {
      if (!std::isgreater(list(i), 0.0)) continue;
      low = high == 0.0 ? list(i) : std::min(low, list(i));
      high = std::max(high, list(i));
    }
  }
  return high == 0.0 ? std::string()
                     : logarithmic_axis(axis, low / 1.4 / scale, 1.4 * high / scale);
}

}  // namespace

std::optional<Figure> pressure_drop(const Measurement& m) {
  const ReportUnits units = report_units(m);
  PlotScript script;
  script.set(common_settings()).set("set multiplot layout 1,2\nset bmargin 4\nset tmargin 1");
  script.set("set key inside top left vertical spacing 1.05");
  script.set(fmt::format("set xlabel '{{/:Italic Q}} ({})'", units.flow_rate.name));
  script.set(fmt::format("set ylabel 'Δ{{/:Italic p}} ({})'", units.drop.name));
  script.set("set xrange [0:*]\nset yrange [0:*]\nset offsets graph 0, graph 0.05, graph 0.55, 0");
  draw_drops(script, m, units, true);
  script.plot();
  if (!script.has_content()) return std::nullopt;
  const auto x_axis = axis_around("x", {m.flow_rate}, units.flow_rate.si);
  const auto y_axis = axis_around(
      "y", {m.extracted_drop, m.resistance_drop, m.channel_resistance_drop, without_parasitic(m)},
      units.drop.si);
  if (!x_axis.empty() && !y_axis.empty()) {
    script.set("unset key\nset offsets 0, 0, 0, 0");
    script.set(x_axis).set(y_axis);
    draw_drops(script, m, units, false);
    script.plot();
  }
  script.set("unset multiplot");
  return Figure{
      "fig2a_pressure_drop",
      "Pressure drop against flow rate",
      "Pressure drop against flow rate on linear (left) and logarithmic axes (right). Blue: Δp_e "
      "between the ends of the test section, read off the wall, with its expanded uncertainty; "
      "dashed: flow rate times hydraulic resistance R of the measured gap over the same section. "
      "Red: what the transducer gives for the whole channel, beside QR of the whole channel "
      "(dotted). As fig. 2(a) of Ozsun et al. (2013).",
      900,
      440,
      script.text()};
}

std::optional<Figure> flow_profiles(const Measurement& m) {
  const ReportUnits units = report_units(m);
  const auto runs = runs_by_flow_rate(m);
  const auto named = spread(runs, 10);
  PlotScript script;
  script.set(common_settings());
  script.set("set key outside right center vertical");
  script.set(fmt::format("set xlabel '{{/:Italic x}} ({})'", units.x.name));
  script.set(fmt::format("set ylabel '{{/:Italic ζ}} ({})'", units.deflection.name));
  script.set(fmt::format("set xrange [0:{}]", plain(m.channel_length / units.x.si)));
  script.set("set xzeroaxis lt 1 lw 0.8 lc rgb '#b4b4b4'");
  for (std::size_t i = runs.size(); i-- > 0;) {
    const Index run = runs[i];
    const Array1 zeta = m.deflection.row(run).transpose();
    const bool is_named = std::find(named.begin(), named.end(), run) != named.end();
    script.draw(script.add_data({thinned(m.x) / units.x.si, thinned(zeta) / units.deflection.si}),
                fmt::format("using 1:2 with lines lw 1.6 lc rgb '{}' {}",
                            ordered_colour(static_cast<Index>(i), static_cast<Index>(runs.size())),
                            is_named ? title(flow_rate_label(m, run, units)) : "notitle"));
  }
  script.plot();
  if (!script.has_content()) return std::nullopt;
  return Figure{
      "fig2b_flow_profiles",
      "Deflection under flow",
      "Width-averaged deflection ζ(x) at each flow rate. It falls along the channel with the "
      "pressure. As fig. 2(b) of Ozsun et al. (2013).",
      640,
      440,
      script.text()};
}

std::optional<Figure> drop_agreement(const Measurement& m) {
  const ReportUnits units = report_units(m);
  const auto runs = runs_by_flow_rate(m);
  const Array1 extracted = at(m.extracted_drop, runs), calculated = at(m.resistance_drop, runs);
  const Array1 u_extracted = kExpansion * at(m.extracted_drop_uncertainty, runs);
  const Array1 u_calculated = kExpansion * at(m.resistance_drop_uncertainty, runs);
  double high = 0.0, low = 0.0;
  for (Index i = 0; i < extracted.size(); ++i) {
    for (const double end : {extracted(i) + u_extracted(i), extracted(i) - u_extracted(i),
                             calculated(i) + u_calculated(i), calculated(i) - u_calculated(i)}) {
      if (!std::isfinite(end)) continue;
      high = std::max(high, 1.08 * end);
      low = std::min(low, 1.08 * end);
    }
  }
  if (high <= low) high = units.drop.si;
  PlotScript script;
  script.set(common_settings()).set("set multiplot layout 1,2\nset bmargin 4\nset tmargin 1");
  script.set("set key inside top left vertical");
  script.set(fmt::format("set xlabel 'Δ{{/:Italic p}}_e ({})'", units.drop.name));
  script.set(fmt::format("set ylabel '{{/:Italic QR}} ({})'", units.drop.name));
  const auto points = script.add_data({extracted / units.drop.si, calculated / units.drop.si,
                                       u_extracted / units.drop.si, u_calculated / units.drop.si});
  if (points.empty()) return std::nullopt;
  const Array1 diagonal{{low / units.drop.si, high / units.drop.si}};
  script.set(fmt::format("set xrange [{0}:{1}]\nset yrange [{0}:{1}]", plain(diagonal(0)),
                         plain(diagonal(1))));
  script.draw(script.add_data({diagonal, diagonal}),
              fmt::format("using 1:2 with lines lw 1.4 lc rgb '{}' {}", kGrey,
                          title("{/:Italic QR} = Δ{/:Italic p}_e")));
  script.draw(points,
              fmt::format("using 1:2:3:4 with xyerrorbars pt 7 ps 0.6 lw 1.4 lc rgb '{}' {}", kBlue,
                          title("runs")));
  script.plot();

  // Relative difference; its bar takes the two as independent, the E_n number does not.
  Array1 difference(extracted.size()), bar(extracted.size());
  for (Index i = 0; i < extracted.size(); ++i) {
    const bool usable = std::isgreater(extracted(i), 0.0) && std::isfinite(calculated(i));
    difference(i) = usable ? 100.0 * (calculated(i) / extracted(i) - 1.0) : std::nan("");
    bar(i) = usable
                 ? 100.0 *
                       std::hypot(u_calculated(i), u_extracted(i) * calculated(i) / extracted(i)) /
                       extracted(i)
                 : std::nan("");
  }
  const auto relative =
      script.add_data({at(m.flow_rate, runs) / units.flow_rate.si, difference, bar});
  script.set(
      "unset key\nset xrange [0:*]\nset yrange [*:*]\nset offsets 0, graph 0.06, graph 0.1, graph "
      "0.1");
  script.set(fmt::format("set xlabel '{{/:Italic Q}} ({})'", units.flow_rate.name));
  script.set("set ylabel '{/:Italic QR} / Δ{/:Italic p}_e − 1 (%)'");
  script.set(fmt::format("set xzeroaxis lt 1 lw 1.4 lc rgb '{}'", kGrey));
  script.draw(relative,
              fmt::format("using 1:2:3 with yerrorbars pt 7 ps 0.6 lw 1.4 lc rgb '{}'", kBlue));
  script.plot();
  script.set("unset multiplot");
  return Figure{
      "fig4_drop_agreement",
      "Does the flow agree?",
      "Left: pressure drop QR that the flow should have in the measured gap of the test section, "
      "against the drop Δp_e read off the wall; the line is QR = Δp_e. Right: their relative "
      "difference. Bars: expanded uncertainties; those on the right take both as independent, "
      "while the E_n number of the table knows their correlation. As fig. 4 of Ozsun et al. "
      "(2013).",
      900,
      440,
      script.text()};
}

}  // namespace manoscope::report

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

/// Flow rates, in SI, at which the fits are drawn: through those of the runs that have a drop.
Array1 flow_rates_of_fit(const Measurement& m) {
  constexpr Index kPoints = 60;
  const Array1 drop = without_parasitic(m);
  double low = 0.0, high = 0.0;
  for (Index run = 0; run < drop.size(); ++run) {
    if (!std::isfinite(drop(run)) || !std::isgreater(m.flow_rate(run), 0.0)) continue;
    low = low == 0.0 ? m.flow_rate(run) : std::min(low, m.flow_rate(run));
    high = std::max(high, m.flow_rate(run));
  }
  if (high <= low) return {};
  return Array1::LinSpaced(kPoints, std::log(low), std::log(high)).exp();
}

/// Draws everything of fig. 2(a) into the present panel.
void draw_drops(PlotScript& script, const Measurement& m, const ReportUnits& units, bool titled) {
  const auto runs = runs_by_flow_rate(m);
  const Array1 Q = at(m.flow_rate, runs) / units.flow_rate.si;
  const auto drop = [&](const Array1& values) -> Array1 {
    return at(values, runs) / units.drop.si;
  };
  const Array1 transducer = drop(m.transducer_drop), parasitic = drop(m.parasitic_drop);
  const Array1 uncorrected = Array1::NullaryExpr(
      Q.size(), [&](Index i) { return std::isnan(parasitic(i)) ? transducer(i) : std::nan(""); });
  // A drop without a known bar is drawn all the same.
  const Array1 compliant_bar =
      (kExpansion * drop(m.compliant_drop_uncertainty)).unaryExpr([](double u) {
        return std::isnan(u) ? 0.0 : u;
      });
  const auto name = [&](const char* words) {
    return titled ? title(words) : std::string("notitle");
  };
  const auto bars = [&](const std::string& data, int mark, double size, const char* colour,
                        const char* words) {
    script.draw(data, fmt::format("using 1:2:3 with yerrorbars pt {} ps {} lw 1.4 lc rgb '{}' {}",
                                  mark, plain(size), colour, name(words)));
  };
  script.draw(script.add_data({Q, drop(m.channel_resistance_drop)}),
              fmt::format("using 1:2 with lines dt 3 lw 2 lc rgb '{}' {}", kGrey,
                          name("{/:Italic QR}, whole channel")));
  script.draw(script.add_data({Q, drop(m.resistance_drop)}),
              fmt::format("using 1:2 with lines dt 2 lw 2 lc rgb '{}' {}", kBlack,
                          name("{/:Italic QR}, test section")));
  if (const Array1 fitted = flow_rates_of_fit(m);
      fitted.size() > 0 && std::isfinite(m.drop_fit_linear)) {
    const Array1 curve = m.drop_fit_linear * fitted + m.drop_fit_quadratic * fitted.square();
    script.draw(script.add_data({fitted / units.flow_rate.si, curve / units.drop.si}),
                fmt::format("using 1:2 with lines lw 1.2 lc rgb '{}' {}", kRed,
                            name("fit {/:Italic aQ} + {/:Italic bQ}^2")));
  }
  bars(
      script.add_data({Q, drop(m.predicted_drop), kExpansion * drop(m.predicted_drop_uncertainty)}),
      4, 1.1, kGreen, "predicted, whole channel");
  bars(script.add_data({Q, transducer - parasitic, compliant_bar}), 9, 0.8, kRed,
       "transducer − parasitic, whole channel");
  script.draw(script.add_data({Q, uncorrected}),
              fmt::format("using 1:2 with points pt 8 ps 0.8 lc rgb '{}' {}", kRed,
                          name("transducer, parasitic part included")));
  bars(
      script.add_data({Q, drop(m.extracted_drop), kExpansion * drop(m.extracted_drop_uncertainty)}),
      7, 0.6, kBlue, "Δ{/:Italic p}_e read off the wall, test section");
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

/// Whether the fits weight every drop by its own size: the noise of the transducer is not known.
bool fitted_by_size(const Measurement& m) {
  const bool compliant = m.compliant_drop.isFinite().any();
  const Array1& drop = compliant ? m.compliant_drop : m.transducer_drop;
  const Array1& noise = m.transducer_drop_uncertainty;
  for (Index run = 0; run < drop.size(); ++run) {
    if (std::isfinite(drop(run)) && !std::isgreater(noise(run), 0.0)) return true;
  }
  return false;
}

/// Fit and exponent with their bars, as sentences of the caption; "" without a fit.
std::string fit_words(const Measurement& m, const ReportUnits& units) {
  std::string words;
  const double linear = units.drop.si / units.flow_rate.si;
  const double quadratic = linear / units.flow_rate.si;
  if (std::isfinite(m.drop_fit_linear)) {
    words += fmt::format(
        " Fit to the drops {}: aQ + bQ² with a = {} {}/({}), b = {} {}/({})²: b "
        "is positive where inertia counts, negative where the wall gives way.{}",
        m.compliant_drop.isFinite().any() ? "of the whole channel"
                                          : "of the transducer, passages included",
        number_text_with_uncertainty(m.drop_fit_linear / linear,
                                     kExpansion * m.drop_fit_linear_uncertainty / linear),
        units.drop.name, units.flow_rate.name,
        number_text_with_uncertainty(m.drop_fit_quadratic / quadratic,
                                     kExpansion * m.drop_fit_quadratic_uncertainty / quadratic),
        units.drop.name, units.flow_rate.name,
        fitted_by_size(m)
            ? " Every drop counts by its own size, since the transducer's noise is not stated."
            : "");
  }
  if (std::isfinite(m.drop_fit_exponent)) {
    words += fmt::format(" As a power of Q they go with exponent n = {} (1: a rigid channel).",
                         number_text_with_uncertainty(
                             m.drop_fit_exponent, kExpansion * m.drop_fit_exponent_uncertainty));
  }
  return words;
}

}  // namespace

std::optional<Figure> pressure_drop(const Measurement& m) {
  const ReportUnits units = report_units(m);
  PlotScript script;
  script.set(common_settings()).set("set multiplot layout 1,2\nset bmargin 4\nset tmargin 4.8");
  script.set("set key at screen 0.5,0.99 center top vertical maxrows 3 width -3");
  script.set(fmt::format("set xlabel '{{/:Italic Q}} ({})'", units.flow_rate.name));
  script.set(fmt::format("set ylabel 'Δ{{/:Italic p}} ({})'", units.drop.name));
  script.set("set xrange [0:*]\nset yrange [0:*]\nset offsets graph 0, graph 0.05, graph 0.05, 0");
  draw_drops(script, m, units, true);
  script.plot();
  if (!script.has_content()) return std::nullopt;
  const auto x_axis = axis_around("x", {m.flow_rate}, units.flow_rate.si);
  const auto y_axis = axis_around("y",
                                  {m.extracted_drop, m.resistance_drop, m.channel_resistance_drop,
                                   m.predicted_drop, without_parasitic(m)},
                                  units.drop.si);
  if (!x_axis.empty() && !y_axis.empty()) {
    script.set("unset key\nset offsets 0, 0, 0, 0");
    script.set(x_axis).set(y_axis);
    draw_drops(script, m, units, false);
    script.plot();
  }
  script.set("unset multiplot");
  const bool predicted = m.predicted_drop.isFinite().any();
  return Figure{
      "fig2a_pressure_drop",
      "Pressure drop against flow rate",
      fmt::format(
          "Pressure drop against flow rate on linear (left) and logarithmic axes (right). Blue: "
          "Δp_e between the ends of the test section, read off the wall, with its expanded "
          "uncertainty; dashed: flow rate times hydraulic resistance R of the measured gap over "
          "the same section. Red: what the transducer gives for the whole channel, beside QR of "
          "the whole channel (dotted).{}{} As fig. 2(a) of Ozsun et al. (2013).",
          predicted ? " Green squares: predicted from the calibration and the flow rate, without "
                      "the map under flow; but where no outlet gauge is told, the pressure at the "
                      "outlet is taken from the reading of that very map."
                    : "",
          fit_words(m, units)),
      900,
      480,
      script.text()};
}

}  // namespace manoscope::report

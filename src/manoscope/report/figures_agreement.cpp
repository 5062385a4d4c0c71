#include <fmt/format.h>

#include <algorithm>
#include <array>
#include <cmath>

#include "manoscope/report/figure_data.hpp"
#include "manoscope/report/figures.hpp"
#include "manoscope/report/flow_verdict.hpp"
#include "manoscope/report/plot_script.hpp"

namespace manoscope::report {
namespace {

using results::Measurement;

/// A calculated drop beside the extracted one, run by run; bars are expanded uncertainties.
struct Calculated {
  Array1 drop, bar;                   // Pa
  Array1 difference, difference_bar;  // % of the extracted drop
  int mark = 7;
  double size = 0.6, aside = 0.0;  // of the mark; how far beside the flow rate, share of the axis
  const char* colour = kBlue;
  std::string words;
};

/// Relative difference from the extracted drops, and its bar from that of the difference in Pa.
void set_difference(Calculated& one, const Array1& extracted, const Array1& bar) {
  const Array1 percent = extracted.unaryExpr(
      [](double drop) { return std::isgreater(drop, 0.0) ? 100.0 / drop : std::nan(""); });
  one.difference = percent * (one.drop - extracted);
  one.difference_bar = percent * bar;
}

Calculated by_resistance(const Measurement& m, const std::vector<Index>& runs) {
  Calculated one;
  one.drop = at(m.resistance_drop, runs);
  one.bar = kExpansion * at(m.resistance_drop_uncertainty, runs);
  one.words = "{/:Italic QR}, eq. (4)";
  const Array1 extracted = at(m.extracted_drop, runs);
  const Array1 u_extracted = kExpansion * at(m.extracted_drop_uncertainty, runs);
  // Takes the two as independent; the E_n number does not.
  const Array1 ratio = one.drop.binaryExpr(extracted, &share_of);
  set_difference(one, extracted, (one.bar.square() + (u_extracted * ratio).square()).sqrt());
  return one;
}

/// By the model of the verdict; without an entry where there is none.
Calculated by_model(const Measurement& m, const std::vector<Index>& runs) {
  const Index model = flow_model_row(m, m.verdict_model);
  if (model < 0) return {};
  const auto of = [&](const Array2& table) -> Array1 {
    return at(Array1(table.row(model).transpose()), runs);
  };
  Calculated one;
  one.drop = of(m.model_drop);
  one.bar = kExpansion * of(m.model_drop_uncertainty);
  one.mark = 12;
  one.size = 0.9;
  one.aside = 0.02;
  one.colour = kGreen;
  one.words = model_style(m.verdict_model).words;
  set_difference(one, at(m.extracted_drop, runs), kExpansion * of(m.model_difference_uncertainty));
  return one;
}

/// "[low:high]" around all drops and their bars, the same for both axes.
std::array<double, 2> range_of(const Array1& extracted, const Array1& bar,
                               const std::vector<Calculated>& list) {
  double low = 0.0, high = 0.0;
  const auto include = [&](const Array1& ends) {
    for (Index i = 0; i < ends.size(); ++i) {
      if (!std::isfinite(ends(i))) continue;
      high = std::max(high, 1.08 * ends(i));
      low = std::min(low, 1.08 * ends(i));
    }
  };
  include(extracted + bar);
  include(extracted - bar);
  for (const Calculated& one : list) {
    include(one.drop + one.bar);
    include(one.drop - one.bar);
  }
  return {low, high};
}

}  // namespace

std::optional<Figure> drop_agreement(const Measurement& m) {
  const ReportUnits units = report_units(m);
  const auto runs = runs_by_flow_rate(m);
  const Array1 extracted = at(m.extracted_drop, runs);
  const Array1 bar = kExpansion * at(m.extracted_drop_uncertainty, runs);
  std::vector<Calculated> list{by_resistance(m, runs)};
  if (Calculated model = by_model(m, runs); model.drop.isFinite().any()) list.push_back(model);
  const bool with_model = list.size() > 1;
  auto [low, high] = range_of(extracted, bar, list);
  if (high <= low) high = units.drop.si;
  PlotScript script;
  script.set(common_settings()).set("set multiplot layout 1,2\nset bmargin 4\nset tmargin 1");
  script.set("set key inside top left vertical");
  script.set(fmt::format("set xlabel 'Δ{{/:Italic p}}_e ({})'", units.drop.name));
  script.set(fmt::format("set ylabel '{} ({})'",
                         with_model ? "Δ{/:Italic p} by the flow model" : "{/:Italic QR}",
                         units.drop.name));
  const Array1 diagonal{{low / units.drop.si, high / units.drop.si}};
  script.set(fmt::format("set xrange [{0}:{1}]\nset yrange [{0}:{1}]", plain(diagonal(0)),
                         plain(diagonal(1))));
  script.draw(script.add_data({diagonal, diagonal}),
              fmt::format("using 1:2 with lines lw 1.4 lc rgb '{}' {}", kGrey,
                          title(with_model ? "equal" : "{/:Italic QR} = Δ{/:Italic p}_e")));
  bool any = false;
  for (const Calculated& one : list) {
    const auto points = script.add_data({extracted / units.drop.si, one.drop / units.drop.si,
                                         bar / units.drop.si, one.bar / units.drop.si});
    any = any || !points.empty();
    script.draw(points,
                fmt::format("using 1:2:3:4 with xyerrorbars pt {} ps {} lw 1.4 lc rgb '{}' {}",
                            one.mark, plain(one.size), one.colour, title(one.words)));
  }
  if (!any) return std::nullopt;
  script.plot();

  script.set(
      "unset key\nset xrange [0:*]\nset yrange [*:*]\nset offsets 0, graph 0.06, graph 0.1, graph "
      "0.1");
  script.set(fmt::format("set xlabel '{{/:Italic Q}} ({})'", units.flow_rate.name));
  script.set(fmt::format("set ylabel '{} / Δ{{/:Italic p}}_e − 1 (%)'",
                         with_model ? "Δ{/:Italic p} by the flow model" : "{/:Italic QR}"));
  script.set(fmt::format("set xzeroaxis lt 1 lw 1.4 lc rgb '{}'", kGrey));
  const Array1 Q = at(m.flow_rate, runs) / units.flow_rate.si;
  for (const Calculated& one : list) {
    const Array1 beside = Q + one.aside * largest_magnitude(Q);
    script.draw(script.add_data({beside, one.difference, one.difference_bar}),
                fmt::format("using 1:2:3 with yerrorbars pt {} ps {} lw 1.4 lc rgb '{}'", one.mark,
                            plain(one.size), one.colour));
  }
  script.plot();
  script.set("unset multiplot");
  const std::string model_words =
      with_model ? fmt::format(
                       " Green: the drop by the flow model of the verdict ({}); its bars on the "
                       "right count once what reading and model share, so that a bar that misses "
                       "zero is an E_n above 1.",
                       model_style(m.verdict_model).words)
                 : std::string();
  return Figure{
      "fig4_drop_agreement",
      "Does the flow agree?",
      "Left: pressure drop QR that the flow should have in the measured gap of the test section, "
      "against the drop Δp_e read off the wall; the line is QR = Δp_e. Right: their relative "
      "difference. Bars: expanded uncertainties; those of QR on the right take both as "
      "independent, while the E_n number of the table knows their correlation. Both take eq. (4) "
      "as "
      "exact: what it is off by itself is not in them." +
          model_words + " As fig. 4 of Ozsun et al. (2013).",
      900,
      440,
      script.text()};
}

}  // namespace manoscope::report

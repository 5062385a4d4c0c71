#include <fmt/format.h>
#include <fmt/ranges.h>

#include <algorithm>
#include <array>
#include <cmath>
#include <string_view>

#include "manoscope/report/figure_data.hpp"
#include "manoscope/report/figures.hpp"
#include "manoscope/report/flow_verdict.hpp"
#include "manoscope/report/plot_script.hpp"
#include "manoscope/report/wording.hpp"

namespace manoscope::report {
namespace {

using results::Measurement;

/// An effect as the figure calls and draws it, and the model whose drop it completes.
struct Effect {
  std::string_view name;
  const char* words;
  const char* colour;
  std::string_view model;
};

constexpr std::array<Effect, 5> kEffects{{
    {"mean-gap rectangle", "eq. (4)", kGrey, "paper"},
    {"true section", "true section", kSky, "creeping"},
    {"inertia", "inertia", kOrange, "momentum"},
    {"entry", "entry", kPurple, "developing"},
    {"section march", "true profiles", kGreen, "section-march"},
}};

Effect effect_of(std::string_view name) {
  for (const Effect& effect : kEffects) {
    if (effect.name == name) return effect;
  }
  return {"", "another effect", kPale, ""};
}

/// Runs whose drop stands out of its bar, by flow rate: a share of any other says nothing.
std::vector<Index> shown_runs(const Measurement& m) {
  std::vector<Index> runs;
  for (const Index run : runs_by_flow_rate(m)) {
    const double drop = std::abs(m.extracted_drop(run));
    const double bar = kExpansion * m.extracted_drop_uncertainty(run);
    if (m.flow_rate(run) != 0.0 && std::isgreater(drop, 0.0) && !std::islessequal(drop, bar) &&
        std::isfinite(m.correction_drop(0, run))) {
      runs.push_back(run);
    }
  }
  return runs;
}

/// What the corrections of a run come to, and the bar of the reading against it; % of dp_e.
struct Balance {
  double sum = 0.0;      // of the corrections behind the first; NaN where the march broke down
  double reading = 0.0;  // dp_e less the first
  double bar = 0.0;      // expanded, of model less reading; of the reading where that is not known
};

Balance balance_of(const Measurement& m, Index run) {
  const double percent = 100.0 / m.extracted_drop(run);
  Balance balance;
  balance.reading = percent * (m.extracted_drop(run) - m.correction_drop(0, run));
  Index last = 0;
  for (Index k = 1; k < m.correction_drop.rows(); ++k) {
    if (!std::isfinite(m.correction_drop(k, run))) continue;
    balance.sum += percent * m.correction_drop(k, run);
    last = k;
  }
  if (march_broke_down(m, run)) balance.sum = std::nan("");
  const Index model =
      flow_model_row(m, effect_of(m.correction[static_cast<std::size_t>(last)]).model);
  double u = model < 0 ? std::nan("") : m.model_difference_uncertainty(model, run);
  if (!std::isfinite(u)) u = m.extracted_drop_uncertainty(run);
  balance.bar = std::isfinite(u) ? std::abs(percent) * kExpansion * u : 0.0;
  return balance;
}

/// Bars of the effects behind the first, stacked away from zero on either side.
void draw_stacks(PlotScript& script, const Measurement& m, const std::vector<Index>& runs) {
  constexpr double kLeft = -0.32, kRight = 0.08;
  const auto n = static_cast<Index>(runs.size());
  Array1 above = Array1::Zero(n), below = Array1::Zero(n);
  const Array1 place = Array1::LinSpaced(n, 1.0, static_cast<double>(n));
  for (Index k = 1; k < m.correction_drop.rows(); ++k) {
    const Effect effect = effect_of(m.correction[static_cast<std::size_t>(k)]);
    Array1 from(n), to(n);
    for (Index i = 0; i < n; ++i) {
      const Index run = runs[static_cast<std::size_t>(i)];
      const double part = 100.0 * m.correction_drop(k, run) / m.extracted_drop(run);
      double& end = std::isless(part, 0.0) ? below(i) : above(i);
      from(i) = end;
      to(i) = end + part;
      if (std::isfinite(part)) end += part;
    }
    // An effect that is nowhere larger than a line is none: it would only fill the key.
    if (largest_magnitude(Array1(to - from)) < 0.005) continue;
    script.draw(script.add_data({place, from, place + kLeft, place + kRight, from, to}),
                fmt::format("using 1:2:3:4:5:6 with boxxyerror fs solid 1 border rgb '#ffffff' fc "
                            "rgb '{}' {}",
                            effect.colour, title(effect.words)));
  }
}

std::string flow_rate_ticks(const Measurement& m, const std::vector<Index>& runs,
                            const ReportUnits& units) {
  const auto labelled = spread(runs, 16);
  std::vector<std::string> ticks;
  for (std::size_t i = 0; i < runs.size(); ++i) {
    const bool named = std::find(labelled.begin(), labelled.end(), runs[i]) != labelled.end();
    ticks.push_back(fmt::format(
        "'{}' {}", named ? short_number_text(m.flow_rate(runs[i]) / units.flow_rate.si, 3) : "",
        i + 1));
  }
  return fmt::format("set xtics ({}) scale 0", fmt::join(ticks, ", "));
}

}  // namespace

std::optional<Figure> flow_corrections(const Measurement& m) {
  if (m.correction_drop.rows() < 2) return std::nullopt;
  const auto runs = shown_runs(m);
  if (runs.empty()) return std::nullopt;
  const ReportUnits units = report_units(m);
  const auto n = static_cast<Index>(runs.size());
  Array1 sum(n), reading(n), bar(n);
  for (Index i = 0; i < n; ++i) {
    const Balance balance = balance_of(m, runs[static_cast<std::size_t>(i)]);
    sum(i) = balance.sum;
    reading(i) = balance.reading;
    bar(i) = balance.bar;
  }
  const Array1 place = Array1::LinSpaced(n, 1.0, static_cast<double>(n));
  PlotScript script;
  script.set(common_settings());
  script.set("set key at screen 0.5,0.99 center top vertical maxrows 3\nset tmargin 5");
  script.set(fmt::format("set xlabel '{{/:Italic Q}} ({})'", units.flow_rate.name));
  script.set("set ylabel 'added to eq. (4) (% of Δ{/:Italic p}_e)'");
  const double beside = 0.5 + std::max(0.0, 0.5 * (5.0 - static_cast<double>(n)));  // few: no slabs
  script.set(fmt::format("set xrange [{}:{}]", plain(1.0 - beside),
                         plain(static_cast<double>(n) + beside)));
  script.set("set offsets 0, 0, graph 0.05, graph 0.05");
  script.set(flow_rate_ticks(m, runs, units));
  script.set(fmt::format("set xzeroaxis lt 1 lw 1.4 lc rgb '{}'", kGrey));
  draw_stacks(script, m, runs);
  script.draw(script.add_data({place - 0.12, sum}),
              fmt::format("using 1:2 with points pt 13 ps 0.7 lc rgb '{}' {}", kBlack,
                          title("all effects together")));
  script.draw(script.add_data({place + 0.24, reading, bar}),
              fmt::format("using 1:2:3 with yerrorbars pt 7 ps 0.6 lw 1.6 lc rgb '{}' {}", kBlue,
                          title("what the reading asks for")));
  script.plot();
  if (!script.has_content()) return std::nullopt;
  return Figure{
      "flow_corrections",
      "What each effect adds to the drop",
      "Zero is the drop of the test section by eq. (4), the rectangle of the mean gap. Bars: what "
      "each effect adds to it or takes from it, in % of the drop Δp_e read off the wall; diamonds: "
      "all of them together (true profiles: the section march). Blue: by how much Δp_e itself "
      "differs from eq. (4), with the expanded "
      "uncertainty of the difference from all effects: where the bar meets the height of the "
      "diamond the drop agrees. Large bars that cancel are a drop that is right for the wrong "
      "reason. Runs whose drop is smaller than its bar are left out." +
          broken_marches_text(m),
      640,
      480,
      script.text()};
}

}  // namespace manoscope::report

#include <fmt/format.h>

#include <algorithm>
#include <cmath>

#include "manoscope/flow/laminar.hpp"
#include "manoscope/report/figure_data.hpp"
#include "manoscope/report/figures.hpp"
#include "manoscope/report/plot_script.hpp"

namespace manoscope::report {
namespace {

using results::Measurement;

constexpr double kLaminar = flow::kLargestLaminarReynolds;

/// One line a run along x, dark to light with the flow rate.
void draw_runs(PlotScript& script, const Measurement& m, const Array2& values, double unit,
               const std::string& how, bool titled) {
  const ReportUnits units = report_units(m);
  const auto runs = runs_by_flow_rate(m);
  const auto named = spread(runs, 10);
  for (std::size_t i = runs.size(); i-- > 0;) {
    const Index run = runs[i];
    const bool is_named = std::find(named.begin(), named.end(), run) != named.end();
    script.draw(
        script.add_data({thinned(m.x) / units.x.si, thinned(values.row(run).transpose()) / unit}),
        fmt::format("using 1:2 with lines {} lc rgb '{}' {}", how,
                    ordered_colour(static_cast<Index>(i), static_cast<Index>(runs.size())),
                    titled && is_named ? title(flow_rate_label(m, run, units)) : "notitle"));
  }
}

/// Whether the flow is laminar everywhere, as a sentence.
std::string laminar_words(double largest) {
  return largest < kLaminar
             ? fmt::format("Re(x) is at most {:.0f}: laminar (the flow models hold below 2000).",
                           largest)
             : fmt::format("Re(x) reaches {:.0f}: the flow models hold below 2000 only.", largest);
}

/// Drag at the highest flow rate, as a sentence; "" without one.
std::string drag_words(const Measurement& m) {
  const ReportUnits units = report_units(m);
  const auto runs = runs_by_flow_rate(m);
  if (runs.empty() || !std::isfinite(m.friction_drag(runs.back()))) return {};
  const Index run = runs.back();
  const double drag = m.friction_drag(run), relative = m.relative_friction_drag(run);
  return fmt::format(" At {} friction pulls the walls along with {} mN{}.",
                     flow_rate_label(m, run, units), number_text(1e3 * drag, 3),
                     std::isfinite(relative)
                         ? fmt::format(", {} times as much as in the channel undeflected",
                                       number_text(relative, 3))
                         : std::string());
}

}  // namespace

std::optional<Figure> wall_shear(const Measurement& m) {
  const double shear =
      std::max(largest_magnitude(m.wall_shear_roof), largest_magnitude(m.wall_shear_floor));
  const double reynolds = largest_magnitude(m.local_reynolds);
  if (shear == 0.0 || reynolds == 0.0) return std::nullopt;  // no run, no model or no flow
  const ReportUnits units = report_units(m);
  const DisplayUnit unit = pressure_unit(shear);
  PlotScript script;
  script.set(common_settings()).set("set multiplot\nset tmargin at screen 0.96");
  script.set("set bmargin at screen 0.15\nset lmargin at screen 0.09\nset rmargin at screen 0.40");
  script.set(fmt::format("set xlabel '{{/:Italic x}} ({})'", units.x.name));
  script.set(
      fmt::format("set xrange [0:{}]\nset yrange [0:*]", plain(m.channel_length / units.x.si)));
  script.set(fmt::format("set ylabel 'wall shear {{/:Italic τ}} ({})'", unit.name));
  script.set("unset key");
  draw_runs(script, m, m.wall_shear_roof, unit.si, "lw 1.6", false);
  draw_runs(script, m, m.wall_shear_floor, unit.si, "dt 3 lw 1.6", false);
  script.plot();
  script.set("set lmargin at screen 0.53\nset rmargin at screen 0.81");
  script.set("set key at screen 0.99,0.56 right center vertical Left reverse");
  script.set("set ylabel 'local Re'");
  if (reynolds > 0.4 * kLaminar) {
    const Array1 whole{{0.0, m.channel_length / units.x.si}};
    script.set("set offsets 0, 0, graph 0.05, 0");
    script.set(
        fmt::format("set label 'laminar below' at graph 0.03, first {} offset 0,-0.7 "
                    "textcolor rgb '{}'",
                    plain(kLaminar), kRed));
    script.draw(script.add_data({whole, Array1::Constant(2, kLaminar)}),
                fmt::format("using 1:2 with lines dt 2 lw 1.4 lc rgb '{}' notitle", kRed));
  }
  draw_runs(script, m, m.local_reynolds, 1.0, "lw 1.6", true);
  script.plot();
  script.set("unset multiplot");
  return Figure{
      "wall_shear",
      "Wall shear and Reynolds number along the channel",
      "Left: shear of developed flow on the deflecting wall (lines) and on the floor (dotted), "
      "mean "
      "over the width, in the measured gap. Right: local Reynolds number 2Q/(ν[w + 2h(x)]). " +
          laminar_words(reynolds) + drag_words(m) +
          " Between wide plates τ = 3ηq/(2h₀²); the paper prints that with η², a slip.",
      900,
      400,
      script.text()};
}

}  // namespace manoscope::report

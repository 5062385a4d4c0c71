#include <fmt/format.h>

#include <algorithm>

#include "manoscope/report/figure_data.hpp"
#include "manoscope/report/figures.hpp"
#include "manoscope/report/plot_script.hpp"

namespace manoscope::report {

using results::Measurement;

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

}  // namespace manoscope::report

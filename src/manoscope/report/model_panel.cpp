#include "manoscope/report/model_panel.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>

#include "manoscope/report/simulated_lines.hpp"

namespace manoscope::report {
namespace {

using results::Measurement;

/// Pressure by a model of the list; empty if it was not run or gave nothing.
Array1 pressure_by(const Measurement& m, const std::string& model, Index run) {
  const Index row = flow_model_row(m, model);
  if (row < 0 || static_cast<std::size_t>(row) >= m.model_pressure.size()) return {};
  const Array1 pressure = m.model_pressure[static_cast<std::size_t>(row)].row(run).transpose();
  return pressure.isFinite().any() ? pressure : Array1();
}

/// "[low:high]" of what lies in the test section, with some room; near the ends, where the wall
/// hardly answers, lines and intervals may leave the frame.
std::string range_in_section(const Measurement& m, Index run, const std::vector<Array1>& lines,
                             double unit) {
  double low = 0.0, high = 0.0;
  for (Index ix = 0; ix < m.x.size(); ++ix) {
    if (!std::isgreaterequal(m.x(ix), m.test_section(run, 0)) ||
        !std::islessequal(m.x(ix), m.test_section(run, 1))) {
      continue;
    }
    for (const Array1& line : lines) {
      if (!std::isfinite(line(ix))) continue;
      low = std::min(low, line(ix));
      high = std::max(high, line(ix));
    }
  }
  if (high <= low) return "[*:*]";
  const double room = 0.12 * (high - low);
  return fmt::format("[{}:{}]", plain((low - room) / unit), plain((high + room) / unit));
}

}  // namespace

ModelsOfRun models_of_run(const Measurement& m, Index run) {
  ModelsOfRun models;
  std::vector<std::string> names{m.verdict_model, "momentum", "creeping"};
  for (const std::string& name : names) {
    const Array1 pressure = pressure_by(m, name, run);
    if (pressure.size() == 0) continue;
    if (!models.found()) {
      models.reference = pressure;
      models.reference_style = model_style(name);
    } else if (name != m.verdict_model) {
      models.others.push_back({model_style(name), pressure});
    }
  }
  const Array1 resistance = m.resistance_pressure.row(run).transpose();
  if (models.found() && m.verdict_model != "paper" && resistance.isFinite().any()) {
    models.others.push_back({model_style("paper"), resistance});
  }
  return models;
}

void draw_differences(PlotScript& script, const Measurement& m, Index run,
                      const ModelsOfRun& models, const ReportUnits& units) {
  const auto less = [&](const Array2& values) -> Array1 {
    return Array1(values.row(run).transpose()) - models.reference;
  };
  const Array1 reading = less(m.pressure), lower = less(m.pressure_lower),
               upper = less(m.pressure_upper);
  std::vector<Array1> all{reading, lower, upper};
  for (const ModelsOfRun::Line& line : models.others) {
    all.emplace_back(line.pressure - models.reference);
  }
  const std::vector<SimulatedLine> simulated = simulated_lines(m, run);
  const std::size_t n_models = models.others.size();
  if (!simulated.empty()) all.emplace_back(simulated.back().pressure - models.reference);
  double largest = 0.0;
  for (const Array1& line : all) largest = std::max(largest, largest_magnitude(line));
  const DisplayUnit unit = pressure_unit(largest);
  script.set("set yrange " + range_in_section(m, run, all, unit.si));
  script.set(fmt::format("set ylabel '{{/:Italic p}} − {} ({})' textcolor rgb '{}'",
                         models.reference_style.words, unit.name, kBlack));
  const Array1 x = thinned(m.x) / units.x.si;
  script.draw(script.add_data({x, thinned(lower) / unit.si, thinned(upper) / unit.si}),
              fmt::format("using 1:2:3 with filledcurves fc rgb '{}' fs transparent solid 0.3 "
                          "noborder notitle",
                          kBlue));
  script.draw(script.add_data({x, thinned(reading) / unit.si}),
              fmt::format("using 1:2 with lines lw 1.6 lc rgb '{}' notitle", kBlue));
  const Array1 whole{{0.0, m.channel_length / units.x.si}};
  script.draw(script.add_data({whole, Array1::Zero(2)}),
              fmt::format("using 1:2 with lines lw 1.6 lc rgb '{}' {}",
                          models.reference_style.colour, title(models.reference_style.words)));
  for (std::size_t i = 0; i < n_models; ++i) {
    const ModelStyle& style = models.others[i].style;
    script.draw(script.add_data({x, thinned(all[i + 3]) / unit.si}),
                fmt::format("using 1:2 with lines dt 2 lw 2 lc rgb '{}' {}", style.colour,
                            title(style.words)));
  }
  draw_crosses(script, m, simulated, models.reference, units, unit.si, false);
  script.plot();
}

std::string difference_words(const ModelsOfRun& models) {
  return fmt::format(
      " Below: the same less what the flow model {} gives, so that small differences show; each "
      "model is tied to the reading at the end of the test section, so that only its course "
      "counts, "
      "not its level.",
      models.reference_style.words);
}

}  // namespace manoscope::report

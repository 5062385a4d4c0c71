#include "manoscope/design/run_forecast.hpp"

#include <algorithm>
#include <cmath>
#include <limits>

#include "manoscope/flow/duct_resistance.hpp"
#include "manoscope/inversion/test_section.hpp"
#include "manoscope/twin/experiment_files.hpp"
#include "manoscope/twin/solved_scenario.hpp"

namespace manoscope::design {
namespace {

constexpr Index kStations = 60;  // of a test section

/// A level that the wall's grid is laid out for: what the largest flow rate would need if the wall
/// stayed where it is, within what the wall bears.
Pressure grid_pressure(const twin::Scenario& scenario) {
  const FlowRate largest =
      *std::max_element(scenario.flow_rates.begin(), scenario.flow_rates.end());
  const auto& channel = scenario.channel;
  const double resistance = flow::duct_resistance(scenario.fluid.viscosity, channel.width,
                                                  channel.height, flow::DuctFormula::series) *
                            channel.length.si();
  const Pressure drop = Pressure::from_si(resistance * largest.si());
  const Pressure most = 0.9 * scenario.wall.largest_pressure();
  return std::min(scenario.outlet.pressure(largest) + drop, most);
}

}  // namespace

std::vector<SolvedRun> solve_runs(const twin::Scenario& scenario, int n_threads,
                                  const Monitor& monitor) {
  if (scenario.flow_rates.empty()) return {};
  twin::Scenario loaded = scenario;
  loaded.levels = {std::max(grid_pressure(scenario), scenario.levels.back())};
  double done = 0.0;
  const auto count = static_cast<double>(scenario.flow_rates.size() + 1);
  const auto solved = twin::solve_scenario(
      loaded, n_threads, monitor, [&] { monitor.report("solving the flow", ++done / count); });
  const auto stretch = inversion::wanted_stretch(scenario.channel.length, scenario.channel.width);
  const Array1 x = Array1::LinSpaced(kStations, stretch.start.si(), stretch.end.si());
  std::vector<SolvedRun> runs;
  for (const auto& one : solved.runs) {
    const twin::CoupledFlow& flow = one.flow;
    SolvedRun run;
    run.name = twin::run_label(flow.flow_rate);
    run.flow_rate = flow.flow_rate;
    const Array1& everywhere = flow.pressure.values();
    run.whole = {everywhere.minCoeff(), everywhere.maxCoeff()};
    run.pressure = flow.pressure(x);
    run.gradient = (run.pressure[0] - run.pressure[kStations - 1]) / (x[kStations - 1] - x[0]);
    run.deflection = flow.deflection.values().maxCoeff();
    run.speed_index = flow.speed_index;
    runs.push_back(std::move(run));
  }
  return runs;
}

RunForecast forecast_run(const Apparatus& apparatus, const std::vector<double>& levels,
                         const SolvedRun& run) {
  Apparatus own = apparatus;
  own.gradient = run.gradient;
  const Forecast forecast = forecast_readings(own, levels, run.pressure);
  const Index last = run.pressure.size() - 1;
  const Array1 uncertainty = forecast.uncertainty();
  RunForecast found{run.name, run.flow_rate, run.pressure[0], run.pressure[last]};
  found.speed_index = run.speed_index;
  found.deflection = run.deflection;
  found.worst = uncertainty.maxCoeff();
  found.rms = std::sqrt(uncertainty.square().mean());
  const bool answers = std::isfinite(found.worst);
  constexpr double kInfinite = std::numeric_limits<double>::infinity();
  found.rms_error = answers ? std::sqrt(forecast.error.standard().square().mean()) : kInfinite;
  found.drop_error = answers ? difference(forecast.error, 0, last) : kInfinite;
  found.drop_uncertainty =
      answers ? std::max(difference(forecast.stated, 0, last), found.drop_error) : kInfinite;
  return found;
}

double range_drop_uncertainty(const Apparatus& apparatus, const std::vector<double>& levels,
                              const PressureSpan& range) {
  Array1 ends(2);
  ends << range.high, range.low;
  const Forecast forecast = forecast_readings(apparatus, levels, ends);
  if (!forecast.uncertainty().isFinite().all()) return std::numeric_limits<double>::infinity();
  return std::max(difference(forecast.stated, 0, 1), difference(forecast.error, 0, 1));
}

}  // namespace manoscope::design

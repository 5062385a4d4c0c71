// manoscope demo [-o OUT]: the embedded virtual experiment: make, measure, judge, report.
#include <fmt/format.h>

#include <cmath>

#include "commands.hpp"
#include "judge_summary.hpp"
#include "manoscope/experiment/experiment.hpp"
#include "manoscope/flow/one_dimensional.hpp"
#include "manoscope/pipeline/measure.hpp"
#include "manoscope/pipeline/simulate_runs.hpp"
#include "manoscope/report/report.hpp"
#include "manoscope/results/simulation_file.hpp"
#include "manoscope/results/write.hpp"
#include "manoscope/twin/experiment_files.hpp"
#include "manoscope/twin/scenario_file.hpp"
#include "manoscope/twin/virtual_experiment.hpp"
#include "measured_simulations.hpp"
#include "solver_program.hpp"
#include "summary.hpp"

namespace manoscope::cli {
namespace {

/// Station of the measurement nearest to x.
Index nearest(const results::Measurement& m, double x) {
  Index place = 0;
  (m.x - x).abs().minCoeff(&place);
  return place;
}

/// What an agreement of QR is worth at high flow rates, by the numbers of the last run that has a
/// test section.
std::string inertia_text(const results::Measurement& m) {
  const flow::Channel channel{Length::from_si(m.channel_length), Length::from_si(m.channel_width),
                              Length::from_si(m.channel_height)};
  const flow::Fluid fluid{Viscosity::from_si(m.viscosity), Density::from_si(m.density)};
  for (Index r = m.flow_rate.size() - 1; r >= 0; --r) {
    if (!std::isfinite(m.extracted_drop[r]) || !std::isfinite(m.resistance_drop[r])) continue;
    const auto zeta = [&](int end) {
      return Length::from_si(m.deflection(r, nearest(m, m.test_section(r, end))));
    };
    const Pressure inertia = flow::acceleration_drop(
        channel, fluid, FlowRate::from_si(m.flow_rate[r]), zeta(0), zeta(1));
    const double excess = inertia.si() - (m.extracted_drop[r] - m.resistance_drop[r]);
    return fmt::format(
        "QR by eq. (4) is friction alone, in a rectangle of the mean gap. Over the section at {}\n"
        "it leaves out about {:.0f} Pa that the fluid takes to gain speed where the gap narrows\n"
        "along the flow, and has about {:.0f} Pa too much: a bulged section resists less than\n"
        "that rectangle, and the profile of so fast a flow is not the developed one. The two\n"
        "nearly cancel: QR may agree with dp_e where neither is right. p(x) is held against the\n"
        "truth below.\n",
        m.run[static_cast<std::size_t>(r)], inertia.si(), excess);
  }
  return {};
}

/// What Navier-Stokes makes of the wall, or how to have it.
std::string simulation_part(const std::vector<results::Simulation>& simulations) {
  if (simulations.empty()) {
    return "No Navier-Stokes in the measured shape: its solver is not installed (make without\n"
           "SOLVER=no builds it)\n";
  }
  constexpr bool kInShort = true;
  return "Navier-Stokes in the plane, below the wall as measured\n" +
         simulations_text(simulations, kInShort);
}

/// The plane flow of the fastest run below its measured wall.
results::Simulation simulate_fastest(const experiment::Experiment& experiment,
                                     const results::Measurement& measured, const Context& context) {
  Index fastest = 0;
  measured.flow_rate.maxCoeff(&fastest);
  const auto ready =
      pipeline::ready_runs(experiment, {measured.run[static_cast<std::size_t>(fastest)]}, {},
                           context.threads, context.monitor);
  const navier_stokes::SimulationOptions options;
  const auto solver = [&](const pipeline::GivenFlow& flow) {
    return solve_flow(flow, options, {}, context.monitor);
  };
  auto simulation = pipeline::simulate_run(experiment, ready, 0, {}, solver, context.monitor);
  simulation.cells = solver_settings(options);
  return simulation;
}

void demo(const Context& context, const std::filesystem::path& out) {
  const auto folder = out / "experiment";
  constexpr bool kOnlyItsOwn = false;
  const twin::Scenario scenario = twin::demo_scenario();
  results::check_destination(out, pipeline::title_of(twin::experiment_name(scenario, context.seed)),
                             kOnlyItsOwn);
  const auto made =
      twin::make_virtual_experiment(scenario, context.seed, context.threads, context.monitor);
  constexpr bool kOverwrite = true;  // the folder is the demo's own
  twin::write_experiment(folder, made, kOverwrite, context.monitor);
  const auto experiment = experiment::read_experiment(folder);
  auto measurement = pipeline::measure(experiment, {}, context.threads, context.monitor);
  if (has_solver()) {
    measurement.simulations.push_back(simulate_fastest(experiment, measurement, context));
  }
  results::write_result(out, measurement, report::make_report(measurement));
  for (const results::Simulation& simulation : measurement.simulations) {
    results::write_simulation(out, simulation);
  }
  for (const std::string& warning : measurement.warnings) remark(context, "note: " + warning);
  const Verdict verdict = hold_against(measurement, made.truth);
  if (context.json) {
    constexpr bool kWithStations = false;
    print(judgement_json(verdict, kWithStations));
    return;
  }
  print(
      fmt::format("A virtual experiment with known truth: {} maps in {}\n\n"
                  "{}"
                  "{}\n"
                  "{}\n"
                  "{}\n"
                  "{}\n"
                  "Measured against true, over each test section\n{}\n"
                  "Report: {}\n"
                  "{}",
                  made.maps.size(), folder.string(), details_text(measurement, context.screen),
                  summary_text(measurement, context.screen), inertia_text(measurement),
                  split_text(verdict.split), simulation_part(measurement.simulations),
                  judgement_text(verdict), (out / "report.html").string(), verdict_text(verdict)));
}

}  // namespace

void add_demo(Program& program) {
  auto out = std::make_shared<std::filesystem::path>("manoscope-demo");
  Command command =
      program.command("demo", "Make a virtual experiment, measure it, judge it against its truth");
  command.option("-o,--output", *out, "folder for the experiment and its result", false);
  command.action([out](const Context& context) { demo(context, *out); });
}

}  // namespace manoscope::cli

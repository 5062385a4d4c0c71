// manoscope simulate EXPERIMENT --run RUN, or --shape SHAPE: Navier-Stokes in the measured or a
// given shape, by a program of its own.
#include <fmt/format.h>

#include <algorithm>
#include <filesystem>
#include <functional>
#include <string>
#include <vector>

#include "commands.hpp"
#include "manoscope/core/atomic_file.hpp"
#include "manoscope/core/error.hpp"
#include "manoscope/pipeline/simulate_passages.hpp"
#include "manoscope/pipeline/simulate_runs.hpp"
#include "manoscope/results/simulation_file.hpp"
#include "manoscope/results/simulation_table.hpp"
#include "measured_simulations.hpp"
#include "navier_stokes/simulation_options.hpp"
#include "passages_summary.hpp"
#include "simulate_summary.hpp"
#include "solver_program.hpp"

namespace manoscope::cli {
namespace {

namespace fs = std::filesystem;

struct Args {
  std::string experiment;
  std::vector<std::string> runs;
  fs::path shape, out, csv;
  SolverRun solver;
  bool parasitic = false;
  std::function<std::vector<std::string>()> given;  ///< options on the command line
  navier_stokes::SimulationOptions options;
  pipeline::MeasureOptions measure;
};

/// Refuses options that are given and would do nothing.
void refuse(const Args& args, const std::vector<std::string>& names, const char* found,
            const char* mend) {
  for (const std::string& given : args.given()) {
    if (std::find(names.begin(), names.end(), given) == names.end()) continue;
    throw InputError("--" + given, found, mend);
  }
}

/// Refuses the options of a measurement.
void refuse_measuring(const Args& args, const char* found) {
  std::vector<std::string> names;
  for (const OptionInfo& option : list_options(args.measure)) names.push_back(option.name);
  refuse(args, names, found, "Leave it out");
}

/// Before hours of work, not behind them: files that cannot be written.
void check_targets(const std::vector<fs::path>& files) {
  for (const fs::path& file : files) {
    if (!file.empty()) const AtomicFile probe(file);
  }
}

void simulate_shape(Args args, const Context& context) {
  refuse_measuring(args, "is for measured shapes, and there is a --shape");
  if (!args.runs.empty()) {
    throw InputError("--run", "belongs to an experiment, and there is a --shape",
                     "Give either an experiment and --run, or --shape");
  }
  if (args.options.inlet == "both") {
    throw InputError("--inlet", "both ends of what is plausible are for experiments",
                     "Choose developed or uniform");
  }
  args.options.validate();
  if (!args.csv.empty() && !args.out.empty()) {
    throw InputError("--csv", "and -o name the same table", "Keep one of them");
  }
  if (!args.csv.empty()) args.out = args.csv;
  check_targets({args.out, args.solver.vtu});
  const std::string answer = ask_solver(args.shape, args.options, args.solver, context.monitor);
  if (!args.out.empty()) write_file_atomically(args.out, simulation_table(answer));
  print(context.json ? answer : simulation_text(answer, context.quiet));
  for (const std::string& doubt : simulation_doubts(answer)) remark(context, doubt);
  if (!args.out.empty()) remark(context, fmt::format("p(x) in {}", args.out.string()));
}

/// Refuses options that the experiment tells itself.
void leave_to_experiment(const Args& args) {
  refuse(args, {"height", "width", "flow-rate", "viscosity", "density"},
         "is told by the experiment", "Leave it out");
}

pipeline::RoofChoice roof_choice(const navier_stokes::SimulationOptions& options) {
  if (options.wall_shape == "map") return pipeline::RoofChoice::map;
  if (options.wall_shape == "response") return pipeline::RoofChoice::response;
  if (options.wall_shape == "auto") return pipeline::RoofChoice::map_if_told;
  throw InputError("--wall-shape", "the wall of an experiment is measured",
                   "Choose map or response, or leave it out");
}

/// FILE for one run; for several FILE with the label of each before its ending.
fs::path file_of_run(const fs::path& file, const std::string& run, bool one) {
  if (one || file.empty()) return file;
  const fs::path label = results::simulation_file(run, 2).stem();  // safe on every file system
  const std::string name = label.string().substr(0, label.string().size() - 3);
  return file.parent_path() /
         fmt::format("{}_{}{}", file.stem().string(), name, file.extension().string());
}

void simulate_experiment(Args args, const Context& context) {
  leave_to_experiment(args);
  args.options.validate_solution();
  check_targets({args.csv, args.solver.vtu});
  const pipeline::RoofChoice roof = roof_choice(args.options);
  if (args.runs.empty()) {
    throw InputError("--run", "is not given", "Name a run, as --run Q70, or --run all");
  }
  require_solver();
  const auto experiment = experiment::read_experiment(fs::path(args.experiment));
  const pipeline::ReadyRuns ready =
      pipeline::ready_runs(experiment, args.runs, args.measure, context.threads, context.monitor);
  if (!args.out.empty()) results::check_result_of(args.out, experiment.text, ready.inputs);
  const pipeline::SimulateOptions wanted{args.options.mesh.dim, args.options.inlet,
                                         args.options.mesh.tolerance, roof};
  const std::size_t n = ready.calibration.runs.size();
  std::vector<results::Simulation> done;
  for (std::size_t i = 0; i < n; ++i) {
    const std::string& name = ready.calibration.runs[i].name;
    SolverRun leading = args.solver;
    leading.vtu = file_of_run(args.solver.vtu, name, n == 1);
    leading.checkpoint = file_of_run(args.solver.checkpoint, name, n == 1);
    SolverRun other = leading;  // of the other inlet
    other.vtu.clear();
    if (!other.checkpoint.empty()) other.checkpoint += ".inlet";
    const auto solver = [&](const pipeline::GivenFlow& flow) {
      return solve_flow(flow, args.options, flow.leading ? leading : other, context.monitor);
    };
    results::Simulation simulation =
        pipeline::simulate_run(experiment, ready, i, wanted, solver, context.monitor);
    simulation.cells = solver_settings(args.options);
    // Each as soon as it is there: hours of other runs are not lost with a later one.
    if (!args.out.empty()) {
      const fs::path file = results::write_simulation(args.out, simulation);
      remark(context, fmt::format("{} in {}", simulation.run, file.string()));
    }
    for (const std::string& doubt : pipeline::simulation_doubts(simulation, experiment)) {
      remark(context, "note: " + doubt);
    }
    done.push_back(std::move(simulation));
  }
  if (!args.csv.empty()) write_file_atomically(args.csv, results::simulations_table(done));
  const bool one = args.runs.size() == 1 && args.runs.front() != "all";
  print(context.json ? simulations_json(done, one) : simulations_text(done, context.quiet));
  if (!args.out.empty()) {
    remark(context,
           fmt::format("manoscope report {} draws them into its figures", args.out.string()));
  }
}

void simulate_parasitic(const Args& args, const Context& context) {
  leave_to_experiment(args);
  refuse(args, {"vtu", "checkpoint"}, "is for flows in the channel",
         "Leave it out, or run manoscope-navier-stokes --passage with it");
  refuse(args,
         {"dim", "cells-along", "cells-up", "cells-across", "inlet", "lead-in", "lead-out",
          "lead-in-slips", "stations", "wall-shape"},
         "is for flows in the channel", "Leave it out");
  refuse_measuring(args, "is for measured shapes, which no passage has");
  args.options.validate_solution();
  check_targets({args.csv});
  require_solver();
  const auto experiment = experiment::read_experiment(fs::path(args.experiment));
  if (!args.out.empty()) results::check_result_of(args.out, experiment.text);
  const std::vector<std::string> all{"all"};
  const auto rates = pipeline::flow_rates_of(experiment, args.runs.empty() ? all : args.runs);
  const auto solver = [&](const pipeline::GivenPassage& passage) {
    return solve_passage(passage, args.options.mesh, {args.solver.processes, {}, {}},
                         context.monitor);
  };
  const auto drops = pipeline::simulate_passages(experiment, rates, solver, context.monitor);
  const std::string table = pipeline::passages_table(drops);
  if (!args.out.empty()) {
    const fs::path file = results::write_passages(args.out, table);
    remark(context, fmt::format("drops of the passages in {}", file.string()));
  }
  if (!args.csv.empty()) write_file_atomically(args.csv, table);
  for (const std::string& doubt : pipeline::passage_doubts(experiment, drops)) {
    remark(context, "note: " + doubt);
  }
  print(context.json ? passages_json(drops) : passages_text(drops, context.quiet));
}

}  // namespace

void add_simulate(Program& program) {
  auto args = std::make_shared<Args>();
  Command command = program.command(
      "simulate", "Solve the Navier-Stokes equations in the measured shape, or a given one");
  command.optional_positional("experiment", args->experiment,
                              "folder with experiment.toml, or the file itself");
  command.option("--run", args->runs, "run of the experiment, or all; may be given several times",
                 false);
  command.option("--shape", args->shape,
                 "instead of an experiment: table with the columns x and zeta, the width-averaged "
                 "deflection, or x, z and zeta, a map, with their units",
                 false);
  command.flag("--parasitic", args->parasitic,
               "of an experiment: the drops of its rigid inlet and outlet passages instead, at the "
               "flow rates of the runs (all, when --run is absent), and the lines with which "
               "measure takes them");
  command.option("-o,--output", args->out,
                 "of an experiment: result folder of measure, where the simulation is kept; of a "
                 "shape: CSV file",
                 false);
  command.option("--csv", args->csv, "writes p(x) and wall shear at every station to a CSV file",
                 false);
  command.option("--vtu", args->solver.vtu, "writes velocity and pressure for ParaView", false);
  command.option(
      "--checkpoint", args->solver.checkpoint,
      "keeps the state of a long solution in a file, and goes on from it; removed at the "
      "end",
      false);
  command.options(args->solver, "Simulation");
  command.options(args->options, "Simulation");
  command.options(args->measure, "Measurement of the shape");
  args->given = command.given();
  command.action([args](const Context& context) {
    if (args->experiment.empty() == args->shape.empty()) {
      throw InputError("simulate",
                       args->shape.empty() ? "neither an experiment nor a --shape is given"
                                           : "an experiment and a --shape are given",
                       "Give an experiment and --run, or --shape SHAPE.csv");
    }
    if (args->parasitic && args->experiment.empty()) {
      throw InputError("--parasitic", "a shape has no passages", "Give an experiment");
    }
    if (args->parasitic) {
      simulate_parasitic(*args, context);
    } else if (args->shape.empty()) {
      simulate_experiment(*args, context);
    } else {
      simulate_shape(*args, context);
    }
  });
}

}  // namespace manoscope::cli

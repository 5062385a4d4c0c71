// manoscope twin SCENARIO -o FOLDER: a virtual experiment with its truth apart.
#include <fmt/format.h>

#include "commands.hpp"
#include "manoscope/twin/experiment_files.hpp"
#include "manoscope/twin/scenario_file.hpp"
#include "manoscope/twin/virtual_experiment.hpp"
#include "summary.hpp"

namespace manoscope::cli {
namespace {

struct Args {
  std::string scenario, size;
  std::filesystem::path folder;
  bool noise_free = false, overwrite = false, list = false;
};

void make(const Context& context, const Args& args) {
  if (args.list) {
    print(context.json ? scenarios_json() : scenarios_text());
    return;
  }
  if (args.scenario.empty() || args.folder.empty()) {
    throw InputError("twin", args.scenario.empty() ? "no scenario" : "no folder to write to",
                     "Write: manoscope twin S1 -o FOLDER; manoscope twin --list names those that "
                     "ship");
  }
  twin::Scenario scenario = twin::find_scenario(args.scenario);
  if (args.noise_free) {
    scenario = scenario.without_errors();
    scenario.name += ", noise-free";
  }
  if (!args.size.empty()) scenario.camera = twin::resized(scenario.camera, args.size);
  twin::check_destination(args.folder, args.overwrite);
  const auto made =
      twin::make_virtual_experiment(scenario, context.seed, context.threads, context.monitor);
  twin::write_experiment(args.folder, made, args.overwrite, context.monitor);
  print(context.json ? twin_json(made, args.folder) : twin_text(made, args.folder));
}

}  // namespace

void add_twin(Program& program) {
  auto args = std::make_shared<Args>();
  Command command = program.command("twin", "Make a virtual experiment: its maps, lists and truth");
  command.optional_positional("scenario", args->scenario,
                              "one that ships (--list names them), or a scenario as a TOML file");
  command.option("-o,--output", args->folder, "folder for the experiment", false);
  command.option("--size", args->size,
                 "pixels along x across, such as 512x96, or a share of both, such as 0.25", false);
  command.flag("--noise-free", args->noise_free, "without any error of instrument and labels");
  command.flag("--overwrite", args->overwrite, "replace an experiment that stands there");
  command.flag("--list", args->list, "name the scenarios that ship");
  command.action([args](const Context& context) { make(context, *args); });
}

}  // namespace manoscope::cli

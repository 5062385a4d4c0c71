// manoscope check EXPERIMENT: every fault of an experiment file at once.
#include <fmt/format.h>

#include <nlohmann/json.hpp>

#include "commands.hpp"
#include "manoscope/experiment/experiment.hpp"

namespace manoscope::cli {
namespace {

void check(const Context& context, const std::filesystem::path& path) {
  nlohmann::json report = {{"experiment", path.string()}, {"faults", nlohmann::json::array()}};
  try {
    const auto experiment = experiment::read_experiment(path);
    if (!context.json) {
      print(fmt::format("{}: no fault found ({} hydrostatic maps, {} maps under flow)\n",
                        experiment.file.string(), experiment.hydrostatic.size(),
                        experiment.flow.size()));
      return;
    }
    report["hydrostatic_maps"] = experiment.hydrostatic.size();
    report["flow_maps"] = experiment.flow.size();
  } catch (const InputErrors& errors) {
    if (!context.json) throw;
    for (const InputError& fault : errors.faults()) {
      report["faults"].push_back(
          {{"where", fault.where()}, {"found", fault.found()}, {"mend", fault.mend()}});
    }
    print(report.dump(2) + "\n");
    throw;
  }
  print(report.dump(2) + "\n");
}

}  // namespace

void add_check(Program& program) {
  auto path = std::make_shared<std::filesystem::path>();
  Command command = program.command("check", "Tell every fault of an experiment file at once");
  command.positional("experiment", *path, "folder with experiment.toml, or the file itself");
  command.action([path](const Context& context) { check(context, *path); });
}

}  // namespace manoscope::cli

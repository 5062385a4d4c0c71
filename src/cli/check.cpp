// manoscope check EXPERIMENT: every fault of an experiment file at once, then of its maps.
#include <fmt/format.h>

#include <nlohmann/json.hpp>

#include "commands.hpp"
#include "manoscope/experiment/experiment.hpp"
#include "manoscope/experiment/file_doubts.hpp"
#include "manoscope/pipeline/file_warnings.hpp"

namespace manoscope::cli {
namespace {

void check(const Context& context, const std::filesystem::path& path) {
  nlohmann::json report = {{"experiment", path.string()}, {"faults", nlohmann::json::array()}};
  try {
    const auto experiment = experiment::read_experiment(path);
    auto doubts = experiment::file_doubts(experiment);
    pipeline::MapCheck maps = pipeline::check_maps(experiment, context.threads, context.monitor);
    if (!maps.faults.empty()) throw InputErrors(std::move(maps.faults));
    doubts.insert(doubts.end(), maps.warnings.begin(), maps.warnings.end());
    for (const std::string& doubt : doubts) remark(context, "note: " + doubt);
    if (!context.json) {
      print(fmt::format("{}: no fault found ({} hydrostatic maps, {} maps under flow)\n",
                        experiment.file.string(), experiment.hydrostatic.size(),
                        experiment.flow.size()));
      return;
    }
    report["warnings"] = doubts;
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
  Command command =
      program.command("check", "Tell every fault of an experiment file at once, then of its maps");
  command.positional("experiment", *path, "folder with experiment.toml, or the file itself");
  command.action([path](const Context& context) { check(context, *path); });
}

}  // namespace manoscope::cli

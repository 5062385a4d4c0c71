// manoscope init FOLDER: drafts an experiment from a folder of maps.
#include <fmt/format.h>

#include <nlohmann/json.hpp>

#include "commands.hpp"
#include "manoscope/experiment/draft.hpp"

namespace manoscope::cli {
namespace {

void draft(const Context& context, const std::filesystem::path& folder) {
  const experiment::Draft draft = experiment::draft_experiment(folder);
  if (context.json) {
    nlohmann::json written = nlohmann::json::array();
    for (const auto& path : draft.written) written.push_back(path.string());
    print(nlohmann::json{{"written", written},
                         {"hydrostatic", draft.hydrostatic},
                         {"flow", draft.flow},
                         {"unassigned", draft.unassigned}}
              .dump(2) +
          "\n");
    return;
  }
  for (const auto& path : draft.written) print(fmt::format("wrote {}\n", path.string()));
  print(fmt::format("{} maps taken for hydrostatic levels, {} for flow\n", draft.hydrostatic.size(),
                    draft.flow.size()));
  for (const std::string& name : draft.unassigned) {
    print(fmt::format("not assigned: {}\n", name));
  }
  print(
      fmt::format("Confirm the guesses (# CONFIRM), fill in the \"?\", then run: manoscope check "
                  "{}\n",
                  folder.string()));
}

}  // namespace

void add_init(Program& program) {
  auto folder = std::make_shared<std::filesystem::path>();
  Command command = program.command("init", "Draft experiment.toml from a folder of maps");
  command.positional("folder", *folder, "folder of maps");
  command.action([folder](const Context& context) { draft(context, *folder); });
}

}  // namespace manoscope::cli

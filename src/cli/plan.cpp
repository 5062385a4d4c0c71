// manoscope plan SCENARIO: which calibration levels serve an experiment best, and what they leave.
#include <fmt/format.h>

#include <optional>

#include "commands.hpp"
#include "manoscope/core/atomic_file.hpp"
#include "manoscope/design/plan.hpp"
#include "manoscope/twin/scenario_text.hpp"
#include "plan_summary.hpp"

namespace manoscope::cli {
namespace {

struct Args {
  std::string scenario, size;
  std::filesystem::path out;
  bool overwrite = false;
  design::Wish wish;
};

void check_destination(const Args& args) {
  std::error_code error;
  if (args.out.empty() || args.overwrite || !std::filesystem::exists(args.out, error)) return;
  throw InputError(args.out.string(), "stands there already",
                   "Choose another file, or add --overwrite");
}

void plan(const Context& context, const Args& args) {
  twin::ScenarioDraft draft = twin::find_scenario_draft(args.scenario);
  if (!args.size.empty()) draft.scenario.camera = twin::resized(draft.scenario.camera, args.size);
  check_destination(args);
  std::optional<AtomicFile> file;  // before the work: gone again if that fails
  if (!args.out.empty()) file.emplace(args.out);
  const design::Plan made = design::make_plan(draft, args.wish, context.threads, context.monitor);
  file.reset();
  if (!args.out.empty()) {
    write_file_atomically(args.out, twin::scenario_toml(made.scenario, plan_comment(made)));
  }
  print(context.json ? plan_json(made, args.out) : plan_text(made, context.quiet));
  if (!context.json && !args.out.empty()) {
    remark(context,
           fmt::format("scenario in {0}; try it: manoscope twin {0} -o FOLDER", args.out.string()));
  }
}

}  // namespace

void add_plan(Program& program) {
  auto args = std::make_shared<Args>();
  Command command = program.command(
      "plan", "Plan an experiment: which calibration levels, how many, how well p(x) is then read");
  command.positional("scenario", args->scenario,
                     "one that ships (see twin --list), or a TOML file with [channel], [wall] and "
                     "what else is known");
  command.option("-o,--output", args->out, "scenario file with the planned levels, for twin",
                 false);
  command.flag("--overwrite", args->overwrite, "replace a file that stands there");
  command.option("--size", args->size,
                 "pixels along x across, such as 512x96, or a share of both, such as 0.25", false);
  command.options(args->wish, "Wish");
  command.action([args](const Context& context) { plan(context, *args); });
}

}  // namespace manoscope::cli

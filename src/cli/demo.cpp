// manoscope demo [-o OUT]: the embedded virtual experiment: make, measure, judge, report.
#include <fmt/format.h>

#include "commands.hpp"
#include "manoscope/experiment/experiment.hpp"
#include "manoscope/pipeline/judge.hpp"
#include "manoscope/pipeline/measure.hpp"
#include "manoscope/report/report.hpp"
#include "manoscope/results/write.hpp"
#include "manoscope/twin/experiment_files.hpp"
#include "manoscope/twin/virtual_experiment.hpp"
#include "summary.hpp"

namespace manoscope::cli {
namespace {

void demo(const Context& context, const std::filesystem::path& out) {
  const auto folder = out / "experiment";
  const auto made = twin::make_virtual_experiment(twin::small_s1(), context.seed, context.threads,
                                                  context.monitor);
  constexpr bool kOverwrite = true;  // the folder is the demo's own
  twin::write_experiment(folder, made, kOverwrite);
  const auto measurement =
      pipeline::measure(experiment::read_experiment(folder), {}, context.threads, context.monitor);
  results::write_result(out, measurement, report::make_report(measurement));
  for (const std::string& warning : measurement.warnings) remark(context, "note: " + warning);
  const auto judgements = pipeline::judge(measurement, made.truth);
  if (context.json) {
    print(judgement_json(judgements));
    return;
  }
  print(fmt::format(
      "A virtual experiment with known truth: {} maps in {}\n\n"
      "Pressure along the channel, read off the wall (± U, k = 2)\n{}\n"
      "Does the flow agree?\n{}\n"
      "Measured against true, over each test section\n{}\n"
      "Report: {}\n",
      made.maps.size(), folder.string(), pressure_text(measurement), summary_text(measurement),
      judgement_text(judgements), (out / "report.html").string()));
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

// manoscope measure EXPERIMENT -o OUT: the measurement.
#include <fmt/format.h>

#include "commands.hpp"
#include "manoscope/pipeline/measure.hpp"
#include "manoscope/report/report.hpp"
#include "manoscope/results/write.hpp"
#include "summary.hpp"
#include "summary_checks.hpp"

namespace manoscope::cli {

void add_measure(Program& program) {
  struct Args {
    std::filesystem::path experiment, out;
    bool overwrite = false, details = false;
    pipeline::MeasureOptions options;
    report::ReportOptions report;
  };
  auto args = std::make_shared<Args>();
  Command command = program.command("measure", "Measure p(x): maps in, result and report out");
  command.positional("experiment", args->experiment,
                     "folder with experiment.toml, or the file itself");
  command.option("-o,--output", args->out,
                 "folder for the result; an earlier one of the same experiment is replaced", true);
  command.flag("--overwrite", args->overwrite, "replace a result of another experiment, too");
  command.flag("--details", args->details,
               "print p(x) at some stations and what the flow models find, too");
  command.options(args->options, "Measurement");
  command.options(args->report, "Report");
  command.action([args](const Context& context) {
    const auto experiment = experiment::read_experiment(args->experiment);
    const bool replaces =
        results::check_destination(args->out, pipeline::title_of(experiment.name), args->overwrite);
    const auto measurement =
        pipeline::measure(experiment, args->options, context.threads, context.monitor);
    context.monitor.checkpoint();
    context.monitor.report("drawing the report", 0.0);
    results::write_result(args->out, measurement, report::make_report(measurement, args->report));
    if (context.json) {
      print(summary_json(measurement, args->out));
    } else {
      const std::string details =
          args->details ? details_text(measurement, context.screen) : std::string();
      print(details + summary_text(measurement, context.screen) +
            (context.quiet ? "" : checks_text(measurement, context.screen)));
    }
    for (const std::string& warning : measurement.warnings) remark(context, "note: " + warning);
    if (!context.json) {
      remark(context, fmt::format("result in {}{}, report in {}", args->out.string(),
                                  replaces ? " (the earlier one is replaced)" : "",
                                  (args->out / "report.html").string()));
    }
  });
}

}  // namespace manoscope::cli

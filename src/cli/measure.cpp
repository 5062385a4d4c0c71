// manoscope measure EXPERIMENT -o OUT: the measurement.
#include <fmt/format.h>

#include "commands.hpp"
#include "manoscope/pipeline/measure.hpp"
#include "manoscope/report/report.hpp"
#include "manoscope/results/write.hpp"
#include "summary.hpp"

namespace manoscope::cli {

void add_measure(Program& program) {
  struct Args {
    std::filesystem::path experiment, out;
    pipeline::MeasureOptions options;
    report::ReportOptions report;
  };
  auto args = std::make_shared<Args>();
  Command command = program.command("measure", "Measure p(x): maps in, result and report out");
  command.positional("experiment", args->experiment,
                     "folder with experiment.toml, or the file itself");
  command.option("-o,--output", args->out, "folder for the result", true);
  command.options(args->options, "Measurement");
  command.options(args->report, "Report");
  command.action([args](const Context& context) {
    const auto experiment = experiment::read_experiment(args->experiment);
    const auto measurement =
        pipeline::measure(experiment, args->options, context.threads, context.monitor);
    context.monitor.checkpoint();
    results::write_result(args->out, measurement, report::make_report(measurement, args->report));
    print(context.json ? summary_json(measurement, args->out) : summary_text(measurement));
    for (const std::string& warning : measurement.warnings) remark(context, "note: " + warning);
    if (!context.json) {
      remark(context, fmt::format("result in {}, report in {}", args->out.string(),
                                  (args->out / "report.html").string()));
    }
  });
}

}  // namespace manoscope::cli

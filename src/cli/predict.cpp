// manoscope predict EXPERIMENT --flow-rate Q: p(x), zeta(x) and drop at flow rates never run.
#include <fmt/format.h>

#include "commands.hpp"
#include "manoscope/core/atomic_file.hpp"
#include "manoscope/core/unit_text.hpp"
#include "manoscope/pipeline/predict.hpp"
#include "predict_summary.hpp"

namespace manoscope::cli {

void add_predict(Program& program) {
  struct Args {
    std::filesystem::path experiment, out;
    std::vector<std::string> flow_rates;
    pipeline::PredictOptions options;
    pipeline::MeasureOptions measure;
  };
  auto args = std::make_shared<Args>();
  Command command = program.command(
      "predict", "Predict p(x), deflection and drop at flow rates that were not run");
  command.positional("experiment", args->experiment,
                     "folder with experiment.toml, or the file itself");
  command.option("--flow-rate", args->flow_rates,
                 "flow rate with its unit, as \"80 mL/min\"; may be given several times", true);
  command.option("-o,--output", args->out, "writes p(x) and zeta(x) to a CSV file", false);
  command.options(args->options, "Prediction");
  command.options(args->measure, "Measurement of the calibration");
  command.action([args](const Context& context) {
    std::vector<FlowRate> flow_rates;
    for (const std::string& text : args->flow_rates) {
      FlowRate flow_rate{};
      option_text::read(text, "--flow-rate", flow_rate);
      flow_rates.push_back(flow_rate);
    }
    const auto experiment = experiment::read_experiment(args->experiment);
    const pipeline::Predictions predictions = pipeline::predict(
        experiment, flow_rates, args->options, args->measure, context.threads, context.monitor);
    if (!args->out.empty()) {
      write_file_atomically(args->out, predictions_table(predictions));
    }
    print(context.json ? predictions_json(predictions)
                       : predictions_text(predictions, context.quiet));
    if (!args->out.empty()) {
      remark(context, fmt::format("p(x) and zeta(x) in {}", args->out.string()));
    }
  });
}

}  // namespace manoscope::cli

// manoscope report OUT: report.html and the figures again from result.nc.
#include "manoscope/report/report.hpp"

#include <fmt/format.h>

#include "commands.hpp"
#include "manoscope/results/simulation_file.hpp"
#include "manoscope/results/write.hpp"

namespace manoscope::cli {

void add_report(Program& program) {
  struct Args {
    std::filesystem::path result;
    report::ReportOptions options;
  };
  auto args = std::make_shared<Args>();
  Command command = program.command("report", "Write report.html and figures again from result.nc");
  command.positional("result", args->result, "result folder");
  command.options(args->options, "Report");
  command.action([args](const Context& context) {
    auto measurement = results::read_result(args->result);
    measurement.map_picture = results::read_maps(args->result, measurement);
    auto stored = results::read_simulations(args->result, measurement);
    measurement.simulations = std::move(stored.simulations);
    for (const std::string& note : stored.left_out) remark(context, "note: " + note);
    results::write_result(args->result, measurement,
                          report::make_report(measurement, args->options));
    print((args->result / "report.html").string() + "\n");
  });
}

}  // namespace manoscope::cli

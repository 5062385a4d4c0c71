// manoscope report OUT: report.html and the figures again from result.nc.
#include <fmt/format.h>

#include "commands.hpp"
#include "manoscope/report/report.hpp"
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
    results::write_result(args->result, measurement,
                          report::make_report(measurement, args->options));
    print((args->result / "report.html").string() + "\n");
    static_cast<void>(context);
  });
}

}  // namespace manoscope::cli

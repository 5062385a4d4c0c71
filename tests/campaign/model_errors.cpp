// model_errors: how far each flow model is from the march on sections, in the channels of the
// shipped scenarios at their flow rates; one CSV row a sample, flow rate and model.
//
// The march is the reference because it meets three-dimensional Navier-Stokes flow within 0.2 % of
// the drop (docs/flow-models.md). The deflections are those of the scenario's own wall.
#include <fmt/format.h>

#include <filesystem>
#include <fstream>
#include <iostream>
#include <optional>
#include <string>

#include "manoscope/core/error.hpp"
#include "manoscope/flow/model_error.hpp"
#include "manoscope/twin/scenario_file.hpp"
#include "manoscope/twin/solved_scenario.hpp"

namespace manoscope::campaign {
namespace {

constexpr const char* kHeader =
    "sample,flow_rate_mL_min,reduced_reynolds,model,largest_error_percent,section_drop_percent,"
    "stated_percent\n";

/// What a model says against the reference, in % of the drop of the channel: the largest difference
/// of p along x, and that of the drop over the paper's test section.
/// @param stated  half width of flow::model_error(), nothing where there is none.
std::string row_of(const std::string& head, const char* name, const Array1& x, const Array1& p,
                   const Array1& reference, const std::optional<double>& stated) {
  const double drop = reference[0] - reference[reference.size() - 1];
  const auto section = [&](const Array1& values) {
    Index first = 0, last = 0;
    (x - 1.6e-3).abs().minCoeff(&first);
    (x - 13.2e-3).abs().minCoeff(&last);
    return values[first] - values[last];
  };
  return fmt::format("{},{},{:.4f},{:.4f},{}\n", head, name,
                     100.0 * (p - reference).abs().maxCoeff() / drop,
                     100.0 * (section(p) / section(reference) - 1.0),
                     stated ? fmt::format("{:.4f}", 100.0 * *stated) : "");
}

std::string rows_of(const std::string& sample, const flow::FlowCase& flow) {
  const auto solve = [&](flow::FlowModel model, flow::InletProfile inlet) {
    flow::FlowCase one = flow;
    one.inlet = inlet;
    return flow::pressure_along(model, one).pressure;
  };
  const Array1 reference = solve(flow::FlowModel::section_march, flow::InletProfile::developed);
  if (!reference.isFinite().all()) return "";
  const double reduced =
      flow::reduced_reynolds(flow.channel, flow.fluid, flow.flow_rate, flow.zeta);
  const std::string head =
      fmt::format("{},{:g},{:.4f}", sample, flow.flow_rate.in(mL_per_min), reduced);
  std::string rows;
  for (const flow::FlowModelInfo& info : flow::kFlowModels) {
    if (info.model == flow::FlowModel::section_march || info.model == flow::FlowModel::developing) {
      continue;
    }
    rows += row_of(head, std::string(info.name).c_str(), flow.x,
                   solve(info.model, flow::InletProfile::developed), reference,
                   flow::model_error(info.model, flow).half_width);
  }
  const Array1 uniform = solve(flow::FlowModel::section_march, flow::InletProfile::uniform);
  if (uniform.isFinite().all()) {
    rows += row_of(head, "uniform inlet", flow.x, uniform, reference, std::nullopt);
  }
  return rows;
}

void write_table(const std::filesystem::path& file) {
  std::ofstream out(file);
  out << kHeader;
  for (const char* sample : {"S1", "S2", "S3", "S4", "S5"}) {
    twin::Scenario scenario = twin::find_scenario(sample);
    scenario.levels = {Pressure{}, scenario.levels.back()};  // the runs alone are wanted
    const twin::SolvedScenario solved = twin::solve_scenario(scenario);
    for (const twin::SolvedScenario::Run& run : solved.runs) {
      flow::FlowCase flow;
      flow.channel = scenario.channel;
      flow.fluid = scenario.fluid;
      flow.flow_rate = run.flow.flow_rate;
      flow.x = Array1::LinSpaced(400, 0.0, scenario.channel.length.si());
      flow.zeta = run.flow.deflection(flow.x);
      flow.shape = run.flow.section;
      out << rows_of(sample, flow) << std::flush;
    }
    std::cerr << sample << '\n';
  }
}

}  // namespace
}  // namespace manoscope::campaign

int main(int argc, char** argv) {
  if (argc != 2) {
    std::cerr << "usage: model_errors OUT.csv\n";
    return 2;
  }
  try {
    manoscope::campaign::write_table(argv[1]);
  } catch (const std::exception& error) {
    std::cerr << error.what() << '\n';
    return 1;
  }
  return 0;
}

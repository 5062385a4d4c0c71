#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <map>

#include "manoscope/pipeline/assemble.hpp"

namespace manoscope::pipeline {

ChosenModel choose_model(const std::vector<RunFindings>& findings,
                         const CompareFlowOptions& options) {
  if (options.flow_model != kAutomaticModel) {
    return {flow::flow_model(options.flow_model), options.flow_model + ", as asked"};
  }
  std::map<flow::FlowModel, double> likelihood;  // logarithm, over the runs that every model has
  int n_runs = 0, n_broken = 0;
  for (const RunFindings& found : findings) {
    if (!found.flow.comparison) continue;
    n_broken += march_broke_down(*found.flow.comparison) ? 1 : 0;
    const auto& models = found.flow.comparison->models;
    const bool all = std::all_of(models.begin(), models.end(), [](const auto& one) {
      return one.agreement != validation::Agreement::no_verdict;
    });
    if (!all || models.size() != flow::kFlowModels.size()) continue;
    for (const auto& one : models) likelihood[one.model] += one.log_likelihood;
    ++n_runs;
  }
  const std::string left_out =
      n_broken == 0
          ? ""
          : fmt::format("; {} of {} runs had no say in it, since a march broke down there",
                        n_broken, findings.size());
  ChosenModel chosen;
  const std::string usual(flow::flow_model_info(chosen.model).name);
  if (n_runs == 0) return {chosen.model, usual + left_out};
  const auto best = std::max_element(
      likelihood.begin(), likelihood.end(),
      [](const auto& one, const auto& other) { return one.second < other.second; });
  const double more = best->second - likelihood.at(chosen.model);
  if (!(more > std::log(10.0))) return {chosen.model, usual + left_out};
  chosen.model = best->first;
  chosen.words = fmt::format(
      "{}, which the runs make {} times as likely as {}{}", flow::flow_model_info(best->first).name,
      more < std::log(1e6) ? fmt::format("{:.2g}", std::exp(more)) : std::string("over a million"),
      usual, left_out);
  return chosen;
}

}  // namespace manoscope::pipeline

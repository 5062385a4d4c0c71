#include "manoscope/serve/job_api.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <nlohmann/json.hpp>

#include "manoscope/core/options.hpp"
#include "manoscope/pipeline/measure_options.hpp"
#include "manoscope/report/report.hpp"
#include "manoscope/serve/api_error.hpp"
#include "manoscope/serve/experiment_files.hpp"
#include "manoscope/serve/json.hpp"

namespace manoscope::serve {
namespace {

using nlohmann::json;

/// "s1/experiment.toml" gives "s1-result", one at the top "result".
std::string usual_output(const std::string& experiment) {
  const auto slash = experiment.rfind('/');
  return slash == std::string::npos ? "result" : experiment.substr(0, slash).append("-result");
}

bool is_report_option(const std::string& name) {
  const auto options = list_options(report::ReportOptions{});
  return std::any_of(options.begin(), options.end(),
                     [&](const OptionInfo& option) { return option.name == name; });
}

}  // namespace

JobOrder order_from(const Folder& folder, const std::string& program, const std::string& body) {
  const json object = parse_object(body);
  JobOrder order;
  order.experiment = experiment_file(text_in(object, "experiment", ""));
  if (!folder.has(order.experiment, Folder::Kind::file)) {
    throw ApiError(404, order.experiment, "there is no such file", "Write the experiment first");
  }
  if (const auto draft = load_experiment(folder, order.experiment)) {
    // The process opens what the names say, wherever that is.
    auto outside = names_that_lead_out(folder, *draft, experiment::read_form(draft->texts));
    if (!outside.empty()) throw InputErrors(std::move(outside));
  }
  order.output = text_in(object, "output", usual_output(order.experiment));
  const auto parts = relative_parts(order.output);
  if (!parts || parts->empty() || folder.leads_out(order.output)) {
    throw ApiError(400, "output", "this names no folder to write to",
                   "Name a folder beneath the one that is served");
  }
  // Whole paths: none of the words can be taken for an option.
  order.words = {program,
                 "measure",
                 folder.absolute(order.experiment).string(),
                 "-o",
                 folder.absolute(order.output).string(),
                 "--progress"};
  if (flag_in(object, "overwrite")) order.words.emplace_back("--overwrite");
  const auto options = object.find("options");
  if (options == object.end() || options->is_null()) return order;
  pipeline::MeasureOptions measure;
  report::ReportOptions report;
  if (!options->is_object()) throw wrong_kind("options", "an object");
  for (const auto& [name, value] : options->items()) {
    const std::string text = text_of(value, name);
    if (is_report_option(name)) {
      set_option(report, name, text, name);
    } else {
      set_option(measure, name, text, name);
    }
    order.words.push_back(fmt::format("--{}={}", name, text));
  }
  measure.validate();
  return order;
}

Reply options_reply() {
  json list = json::array();
  const auto add = [&](const std::vector<OptionInfo>& options, const char* group) {
    for (const OptionInfo& option : options) {
      list.push_back({{"name", option.name},
                      {"kind", option.kind},
                      {"value", option.value},
                      {"help", option.help},
                      {"group", group}});
    }
  };
  add(list_options(pipeline::MeasureOptions{}), "Measurement");
  add(list_options(report::ReportOptions{}), "Report");
  return json_reply({{"measure", list}});
}

}  // namespace manoscope::serve

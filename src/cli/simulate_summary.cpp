#include "simulate_summary.hpp"

#include <fmt/format.h>

#include <cmath>
#include <nlohmann/json.hpp>
#include <sstream>

#include "manoscope/flow/laminar.hpp"
#include "text_table.hpp"

namespace manoscope::cli {
namespace {

using nlohmann::json;

json parsed(const std::string& answer) { return json::parse(answer, nullptr, false); }

std::vector<double> list(const json& object, const char* name) {
  return object.at(name).get<std::vector<double>>();
}

/// What the first line with an object of that member has there; null if none has.
json line_with(const char* name, const std::string& answer) {
  std::istringstream lines(answer);
  for (std::string line; std::getline(lines, line);) {
    const json object = parsed(line);
    if (object.is_object() && object.contains(name)) return object[name];
  }
  return nullptr;
}

}  // namespace

std::optional<InputError> simulation_fault(const std::string& answer) {
  const json error = line_with("error", answer);
  if (!error.is_object()) return std::nullopt;
  return InputError(error.value("where", ""), error.value("found", ""), error.value("mend", ""));
}

std::optional<std::string> solver_fault(const std::string& answer) {
  const json fault = line_with("fault", answer);
  if (!fault.is_string()) return std::nullopt;
  return fault.get<std::string>();
}

std::string simulation_text(const std::string& answer, bool in_short) {
  const json object = parsed(answer);
  const double drop = object.at("drop_Pa").get<double>();
  std::string text = fmt::format(
      "Navier-Stokes, {}-D: drop {} Pa (± numerical), {}\n", object.at("dim").get<int>(),
      value_text(drop, object.at("drop_numerical_uncertainty_Pa").get<double>()),
      object.at("converged").get<bool>() ? "converged" : "NOT CONVERGED");
  if (in_short) return text;
  text += fmt::format("{} unknowns, {:.3g} s, {:.0f} MB\n", object.at("unknowns").get<int>(),
                      object.at("seconds").get<double>(), object.at("peak_MB").get<double>());
  if (object.value("roof_across", "") == "map") {
    text += fmt::format(
        "Roof: the even part of the map; what is odd across, {:.3g} um rms, is left out. The cells "
        "follow it within {:.1g} % of the gap.\n",
        1e6 * object.at("roof_odd_m").get<double>(),
        100.0 * object.at("roof_misfit").get<double>());
  }
  text += '\n';
  constexpr std::size_t kRows = 13;
  const auto x = list(object, "x_m"), gap = list(object, "gap_m");
  const auto mean = list(object, "mean_pressure_Pa"), wall = list(object, "wall_pressure_Pa");
  const auto shear = list(object, "wall_shear_Pa");
  std::vector<std::vector<std::string>> rows{
      {"x [mm]", "gap [um]", "p mean [Pa]", "p wall [Pa]", "wall shear [Pa]"}};
  for (std::size_t i = 0; i < kRows; ++i) {
    const std::size_t k = (x.size() - 1) * i / (kRows - 1);
    rows.push_back({fmt::format("{:.2f}", x[k] * 1e3), fmt::format("{:.1f}", gap[k] * 1e6),
                    fmt::format("{:.1f}", mean[k]), fmt::format("{:.1f}", wall[k]),
                    fmt::format("{:.3g}", shear[k])});
  }
  return text + text_table(rows);
}

std::vector<std::string> simulation_doubts(const std::string& answer) {
  const json object = parsed(answer);
  std::vector<std::string> doubts;
  if (const double reynolds = object.at("reynolds").get<double>();
      reynolds > flow::kLargestLaminarReynolds) {
    doubts.push_back(fmt::format(
        "Re = {:.0f} on the hydraulic diameter, where ducts may turn turbulent: a steady laminar "
        "flow was solved",
        reynolds));
  }
  if (!object.at("converged").get<bool>()) {
    doubts.push_back(fmt::format(
        "The drop is uncertain by {:.2g} % for want of cells: take more (--cells-along, "
        "--cells-up)",
        100.0 * std::abs(object.at("drop_numerical_uncertainty_Pa").get<double>() /
                         object.at("drop_Pa").get<double>())));
  }
  return doubts;
}

std::string simulation_table(const std::string& answer) {
  constexpr const char* kColumns[] = {"x_m",
                                      "gap_m",
                                      "mean_pressure_Pa",
                                      "mean_pressure_numerical_uncertainty_Pa",
                                      "wall_pressure_Pa",
                                      "wall_pressure_numerical_uncertainty_Pa",
                                      "floor_pressure_Pa",
                                      "wall_shear_Pa",
                                      "floor_shear_Pa"};
  const json object = parsed(answer);
  std::string text;
  std::vector<std::vector<double>> columns;
  for (const char* name : kColumns) {
    text += (text.empty() ? "" : ",") + std::string(name);
    columns.push_back(list(object, name));
  }
  text += '\n';
  for (std::size_t i = 0; i < columns.front().size(); ++i) {
    for (std::size_t k = 0; k < columns.size(); ++k) {
      text += fmt::format("{}{:.9g}", k == 0 ? "" : ",", columns[k][i]);
    }
    text += '\n';
  }
  return text;
}

}  // namespace manoscope::cli

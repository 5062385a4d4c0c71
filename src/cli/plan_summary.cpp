#include "plan_summary.hpp"

#include <fmt/format.h>

#include <cmath>
#include <nlohmann/json.hpp>

#include "json_number.hpp"
#include "text_table.hpp"

namespace manoscope::cli {
namespace {

using design::Plan;
using nlohmann::json;

/// Two to three digits, or a dash.
std::string short_number(double value) {
  if (!std::isfinite(value)) return "-";
  return value < 100.0 ? fmt::format("{:.1f}", value) : fmt::format("{:.0f}", value);
}

std::string pressure_number(double p) {
  return std::abs(p - std::round(p)) < 1e-6 ? fmt::format("{:.0f}", p) : fmt::format("{:.1f}", p);
}

/// "0, 300, 460 (x2), ..." in lines of a terminal.
std::string levels_text(const std::vector<double>& levels) {
  constexpr std::size_t kWidth = 78;
  std::string text = "  ", line;
  for (const design::PlannedLevel& level : design::count_repeats(levels)) {
    std::string word = pressure_number(level.pressure);
    if (level.repeats > 1) word += fmt::format(" x{}", level.repeats);
    if (!line.empty() && line.size() + word.size() + 4 > kWidth) {
      text += line + ",\n  ";
      line.clear();
    }
    line += (line.empty() ? "" : ", ") + word;
  }
  return text + line + "\n";
}

std::string wall_text(const Plan& plan) {
  std::vector<std::vector<std::string>> rows{{"p [Pa]", "zeta [um]", "dzeta/dp [nm/Pa]", "u [Pa]",
                                              "error", "labels", "between", "pixels", "plane",
                                              "place", "zero", "gain"}};
  for (const design::PlannedReading& reading : plan.readings) {
    std::vector<std::string> row{pressure_number(std::round(reading.pressure)),
                                 fmt::format("{:.2f}", reading.deflection * 1e6),
                                 fmt::format("{:.3g}", reading.compliance * 1e9),
                                 short_number(reading.uncertainty), short_number(reading.error)};
    for (const auto& source : reading.sources) row.push_back(short_number(source.second));
    rows.push_back(std::move(row));
  }
  std::string text = "The wall at mid-channel, and how well the plan reads it\n" + text_table(rows);
  text +=
      "u: standard uncertainty (k = 1), the larger of what `measure` will state and of the "
      "expected "
      "error.\nFrom pressure labels, between levels, pixel noise, rim plane, place of the flow "
      "map, "
      "gauge.\n";
  if (plan.half_wavelength.high > 0.0) {
    text += fmt::format(
        "The wall shows half of ripples of p(x) of {:.3g} to {:.3g} mm: its own "
        "resolution.\n",
        plan.half_wavelength.low * 1e3, plan.half_wavelength.high * 1e3);
  }
  return text;
}

std::vector<std::string> range_cells(const design::RangeUncertainty& over, double drop) {
  return {short_number(over.worst), pressure_number(std::round(over.worst_at)),
          short_number(over.rms), short_number(over.rms_error), short_number(drop)};
}

const std::vector<std::string> kRangeHead{"worst u [Pa]", "at [Pa]", "rms u", "rms error",
                                          "u(drop)"};

std::string table_of(const std::string& head, const std::vector<std::string>& names,
                     const std::vector<std::vector<std::string>>& cells) {
  std::vector<std::vector<std::string>> rows{{head}};
  rows.front().insert(rows.front().end(), kRangeHead.begin(), kRangeHead.end());
  for (std::size_t i = 0; i < names.size(); ++i) {
    rows.push_back({names[i]});
    rows.back().insert(rows.back().end(), cells[i].begin(), cells[i].end());
  }
  return text_table(rows);
}

std::string sets_text(const Plan& plan) {
  std::vector<std::string> names{plan.planned.name};
  std::vector<std::vector<std::string>> cells{range_cells(plan.planned.over, plan.planned.drop)};
  for (const design::LevelSet& set : plan.others) {
    names.push_back(set.name);
    cells.push_back(range_cells(set.over, set.drop));
  }
  return table_of("levels", names, cells);
}

std::string improvements_text(const Plan& plan) {
  std::vector<std::string> names;
  std::vector<std::vector<std::string>> cells;
  for (const design::Improvement& one : plan.improvements) {
    names.push_back(one.name);
    cells.push_back(range_cells(one.over, one.drop));
  }
  return "What matters: the planned levels with\n" + table_of("", names, cells);
}

std::string runs_text(const Plan& plan) {
  if (plan.planned.runs.empty()) return "";
  std::vector<std::vector<std::string>> rows{{"run", "p [Pa]", "worst u [Pa]", "rms u", "rms error",
                                              "dp_e [Pa]", "u(dp_e)", "zeta max [um]", "S"}};
  for (const design::RunForecast& run : plan.planned.runs) {
    rows.push_back({run.name, fmt::format("{:.0f}-{:.0f}", run.inlet, run.outlet),
                    short_number(run.worst), short_number(run.rms), short_number(run.rms_error),
                    fmt::format("{:.0f}", run.inlet - run.outlet),
                    short_number(run.drop_uncertainty), fmt::format("{:.1f}", run.deflection * 1e6),
                    fmt::format("{:.2f}", run.speed_index)});
  }
  return "\nRuns, over the test section (S: speed of the flow over that of the wall's waves)\n" +
         text_table(rows);
}

std::string verdict_text(const Plan& plan) {
  std::string text;
  for (const design::WishAnswer& answer : plan.answers) text += answer.text + "\n";
  for (const std::string& note : plan.notes) text += "note: " + note + "\n";
  return text.empty() ? "" : "\n" + text;
}

std::string title(const Plan& plan) {
  return fmt::format("{}: p(x) from {:.0f} to {:.0f} Pa, calibrated by {} maps", plan.name,
                     plan.range.low, plan.range.high, plan.planned.levels.size());
}

json over_json(const design::RangeUncertainty& over, double drop) {
  return {{"worst_Pa", number(over.worst)},
          {"worst_at_Pa", number(over.worst_at)},
          {"rms_Pa", number(over.rms)},
          {"rms_error_Pa", number(over.rms_error)},
          {"drop_Pa", number(drop)}};
}

json levels_json(const std::vector<double>& levels) {
  json list = json::array();
  for (const design::PlannedLevel& level : design::count_repeats(levels)) {
    list.push_back({{"pressure_Pa", level.pressure}, {"repeats", level.repeats}});
  }
  return list;
}

json runs_json(const std::vector<design::RunForecast>& forecasts) {
  json runs = json::array();
  for (const design::RunForecast& run : forecasts) {
    runs.push_back({{"run", run.name},
                    {"flow_rate_m3_s", run.flow_rate.si()},
                    {"inlet_Pa", run.inlet},
                    {"outlet_Pa", run.outlet},
                    {"worst_Pa", number(run.worst)},
                    {"rms_Pa", number(run.rms)},
                    {"rms_error_Pa", number(run.rms_error)},
                    {"drop_uncertainty_Pa", number(run.drop_uncertainty)},
                    {"drop_error_Pa", number(run.drop_error)},
                    {"largest_deflection_m", run.deflection},
                    {"speed_index", run.speed_index}});
  }
  return runs;
}

json set_json(const design::LevelSet& set) {
  return {{"name", set.name},
          {"levels", levels_json(set.levels)},
          {"maps", set.levels.size()},
          {"uncertainty", over_json(set.over, set.drop)},
          {"runs", runs_json(set.runs)}};
}

json wall_json(const Plan& plan) {
  json readings = json::array();
  for (const design::PlannedReading& reading : plan.readings) {
    json sources = json::object();
    for (const auto& [source, value] : reading.sources) sources[source] = number(value);
    readings.push_back({{"pressure_Pa", reading.pressure},
                        {"deflection_m", reading.deflection},
                        {"compliance_m_Pa", reading.compliance},
                        {"uncertainty_Pa", number(reading.uncertainty)},
                        {"error_Pa", number(reading.error)},
                        {"sources_Pa", sources}});
  }
  return {{"readings", readings},
          {"half_response_wavelength_m", {plan.half_wavelength.low, plan.half_wavelength.high}},
          {"read_through_the_wall", plan.through_wall},
          {"gap_at_rest_m", plan.smallest_gap}};
}

}  // namespace

std::string plan_text(const Plan& plan, bool in_short) {
  std::string text = title(plan) + "\n\nLevels [Pa]\n" + levels_text(plan.planned.levels);
  if (in_short) return text + verdict_text(plan);
  return text + "\n" + sets_text(plan) + "\n" + wall_text(plan) + "\n" + improvements_text(plan) +
         runs_text(plan) + verdict_text(plan);
}

std::string plan_json(const Plan& plan, const std::filesystem::path& written) {
  json others = json::array(), improvements = json::array(), answers = json::array();
  for (const design::LevelSet& set : plan.others) others.push_back(set_json(set));
  for (const design::Improvement& one : plan.improvements) {
    improvements.push_back({{"name", one.name}, {"uncertainty", over_json(one.over, one.drop)}});
  }
  for (const design::WishAnswer& answer : plan.answers) {
    answers.push_back({{"met", answer.met}, {"text", answer.text}});
  }
  return json{{"name", plan.name},
              {"range_Pa", {plan.range.low, plan.range.high}},
              {"minimised", plan.aim == design::Aim::rms ? "rms" : "worst"},
              {"planned", set_json(plan.planned)},
              {"others", others},
              {"wall", wall_json(plan)},
              {"what_matters", improvements},
              {"wish", answers},
              {"notes", plan.notes},
              {"output", written.empty() ? json(nullptr) : json(written.string())}}
             .dump(2) +
         "\n";
}

std::string plan_comment(const Plan& plan) {
  return title(plan) +
         fmt::format(
             "\nPlanned by `manoscope plan`: u of p(x) {:.2g} Pa rms, {:.2g} Pa at worst, "
             "near {:.0f} Pa",
             plan.planned.over.rms, plan.planned.over.worst, plan.planned.over.worst_at);
}

}  // namespace manoscope::cli

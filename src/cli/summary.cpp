#include "summary.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <nlohmann/json.hpp>
#include <utility>

#include "json_number.hpp"
#include "manoscope/report/flow_verdict.hpp"
#include "manoscope/report/summary_json.hpp"
#include "manoscope/report/wording.hpp"
#include "manoscope/twin/scenario_file.hpp"
#include "run_table.hpp"
#include "summary_checks.hpp"
#include "summary_flow.hpp"
#include "text_table.hpp"

namespace manoscope::cli {
namespace {

using nlohmann::json;

/// p(x) of the runs [first, last) at stations spread evenly over the channel.
std::string pressure_table(const results::Measurement& m, Index first, Index last) {
  constexpr int kRows = 13;
  std::vector<std::vector<std::string>> rows{{"x [mm]"}};
  for (Index r = first; r < last; ++r) {
    rows.front().push_back("p(x) " + m.run[static_cast<std::size_t>(r)] + " [Pa]");
  }
  for (int i = 0; i < kRows; ++i) {
    const double x = m.channel_length * (i + 0.5) / kRows;
    Index nearest = 0;
    (m.x - x).abs().minCoeff(&nearest);
    std::vector<std::string> row{fixed(m.x[nearest] * 1e3, 2)};
    for (Index r = first; r < last; ++r) {
      row.push_back(value_text(m.pressure(r, nearest), m.pressure_uncertainty(r, nearest)));
    }
    rows.push_back(std::move(row));
  }
  return text_table(rows, std::vector<Align>(rows.front().size(), Align::point));
}

/// Of every run, as many beside each other as there is room for.
std::string pressure_tables(const results::Measurement& m, const Screen& screen) {
  constexpr Index kMostAcross = 6;
  std::string text;
  for (Index across = kMostAcross; across > 0; --across) {
    text.clear();
    for (Index first = 0; first < m.flow_rate.size(); first += across) {
      if (first > 0) text += '\n';
      text += pressure_table(m, first, std::min(first + across, m.flow_rate.size()));
    }
    if (fits(text, screen.columns)) break;
  }
  return text;
}

std::string pressure_text(const results::Measurement& m, const Screen& screen) {
  std::string text = wrapped(
      "Pressure along the channel, read off the wall (± U, k = 2; -: no answer)", screen.columns);
  if (!m.reading.empty()) {
    text += wrapped("read " + m.reading.substr(0, m.reading.find(": E = ")), screen.columns);
  }
  return text + pressure_tables(m, screen);
}

/// QR of every run: what its bars alone say, and what they say with the stated error of eq. (4).
std::string resistance_text(const results::Measurement& m, const Screen& screen) {
  const Index paper = report::flow_model_row(m, "paper");
  std::vector<Column> columns{{{"run"}, Align::left},
                              {{"Re"}, Align::right, 3},
                              {{"section [mm]"}, Align::right, 2},
                              {{"QR ± U [Pa]"}, Align::point},
                              {{"E_n"}, Align::point, 4},
                              {{"eq. (4) as exact"}, Align::left}};
  if (paper >= 0) columns.push_back({{"with its error"}, Align::left, 1});
  for (Index r = 0; r < m.flow_rate.size(); ++r) {
    const double start = m.test_section(r, 0), end = m.test_section(r, 1);
    add_row(columns, {m.run[static_cast<std::size_t>(r)], fixed(m.reynolds[r], 0),
                      std::isfinite(start) ? fmt::format("{:.2f}-{:.2f}", start * 1e3, end * 1e3)
                                           : std::string("none"),
                      value_text(m.resistance_drop[r], m.resistance_drop_uncertainty[r]),
                      fixed(m.en_number[r], 2), report::resistance_word(m.en_number[r]),
                      report::verdict_word(report::flow_verdict(m, paper, r))});
  }
  return "By the paper's eq. (4)\n" + text_table(std::move(columns), screen) +
         wrapped(fmt::format("QR: no inertia or entry flow. {}\nE_n and what follows it take eq. "
                             "(4) as exact and its inlet as known: beyond U may be the formula's.",
                             report::resistance_uncertainty_text(m)),
                 screen.columns) +
         (paper >= 0 ? wrapped("With its error: the verdict, by the stated error of eq. (4), the "
                               "inlet's and p(x) along x.",
                               screen.columns)
                     : std::string());
}

/// What a user should know of a wall that left its branch; nothing of one that did not.
std::string snaps_text(const twin::Truth& truth) {
  std::string text;
  const auto add = [&](const std::string& where, const twin::SnapTruth& snaps) {
    if (snaps.n == 0) return;
    text += fmt::format("{}  {}: {} snap{}, the furthest of {:+.3g} um at x = {:.2f} mm\n",
                        text.empty() ? "\nThe wall snapped through on the way to\n" : "", where,
                        snaps.n, snaps.n == 1 ? "" : "s", snaps.jump * 1e6, snaps.at * 1e3);
  };
  for (const auto& level : truth.levels) {
    add(fmt::format("{:g} Pa ({})", level.pressure.si(), level.map), level.snaps);
  }
  for (const auto& run : truth.runs) add(run.run, run.snaps);
  return text;
}

json snaps_json(const twin::SnapTruth& snaps) {
  return {{"n", snaps.n}, {"jump_m", snaps.jump}, {"x_m", snaps.at}};
}

}  // namespace

std::string summary_text(const results::Measurement& m, const Screen& screen) {
  if (m.flow_rate.size() > 0) return run_table(m, screen);
  return fmt::format("calibration only: {} levels, no map under flow\n", m.level_pressure.size());
}

std::string details_text(const results::Measurement& m, const Screen& screen) {
  std::vector<std::string> parts;
  if (m.flow_rate.size() > 0) {
    parts = {pressure_text(m, screen), resistance_text(m, screen), flow_findings_text(m, screen)};
  }
  if (!m.tube_law.empty()) parts.push_back(wrapped("tube law: " + m.tube_law, screen.columns));
  std::string text;
  for (const std::string& part : parts) text += part.empty() ? part : part + '\n';
  return text;
}

std::string summary_json(const results::Measurement& m, const std::filesystem::path& folder) {
  return report::summary_json(m, folder.string()).dump(2) + "\n";
}

std::string twin_text(const twin::VirtualExperiment& made, const std::filesystem::path& folder) {
  std::vector<std::vector<std::string>> rows{{"run", "inlet [Pa]", "outlet [Pa]", "drop [Pa]",
                                              "parasitic [Pa]", "zeta max [um]", "Re", "S"}};
  for (std::size_t i = 0; i < made.scalars.size(); ++i) {
    const twin::RunScalars& run = made.scalars[i];
    rows.push_back({made.truth.runs[i].run, fmt::format("{:.0f}", run.inlet.si()),
                    fmt::format("{:.0f}", run.outlet.si()),
                    fmt::format("{:.0f}", run.compliant_drop().si()),
                    fmt::format("{:.0f}", run.parasitic.si()),
                    fmt::format("{:.1f}", run.largest_deflection.in(um)),
                    fmt::format("{:.0f}", run.reynolds), fmt::format("{:.2f}", run.speed_index)});
  }
  return fmt::format(
      "{}: {} maps in {}, their truth in {}\n\nTrue values (S: speed of "
      "the flow over that of the wall's waves)\n{}{}",
      made.header.name, made.maps.size(), folder.string(), (folder / "truth").string(),
      text_table(rows), snaps_text(made.truth));
}

std::string twin_json(const twin::VirtualExperiment& made, const std::filesystem::path& folder) {
  json runs = json::array();
  for (std::size_t i = 0; i < made.scalars.size(); ++i) {
    const twin::RunScalars& run = made.scalars[i];
    runs.push_back({{"run", made.truth.runs[i].run},
                    {"flow_rate_m3_s", run.flow_rate.si()},
                    {"inlet_pressure_Pa", run.inlet.si()},
                    {"outlet_pressure_Pa", run.outlet.si()},
                    {"parasitic_drop_Pa", run.parasitic.si()},
                    {"largest_deflection_m", run.largest_deflection.si()},
                    {"reynolds", run.reynolds},
                    {"speed_index", run.speed_index},
                    {"snaps", snaps_json(made.truth.runs[i].snaps)}});
  }
  json levels = json::array();
  for (const twin::LevelTruth& level : made.truth.levels) {
    levels.push_back({{"map", level.map},
                      {"pressure_Pa", level.pressure.si()},
                      {"label_Pa", level.label.si()},
                      {"snaps", snaps_json(level.snaps)}});
  }
  return json{{"name", made.header.name}, {"seed", made.header.seed}, {"folder", folder.string()},
              {"maps", made.maps.size()}, {"levels", levels},         {"runs", runs}}
             .dump(2) +
         "\n";
}

std::string scenarios_text() {
  std::string text;
  for (const auto& shipped : twin::shipped_scenarios()) {
    text += fmt::format("{}  {}\n", shipped.name, shipped.title);
  }
  return text;
}

std::string scenarios_json() {
  json list = json::array();
  for (const auto& shipped : twin::shipped_scenarios()) {
    list.push_back({{"name", shipped.name}, {"title", shipped.title}});
  }
  return json{{"scenarios", list}}.dump(2) + "\n";
}

}  // namespace manoscope::cli

#include "judge_summary.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <nlohmann/json.hpp>

#include "json_number.hpp"
#include "text_table.hpp"

namespace manoscope::cli {
namespace {

using nlohmann::json;

validation::PullSummary average_pulls(const Verdict& verdict) {
  std::vector<validation::Judgement> readings;
  for (const auto& run : verdict.runs) readings.push_back(run.reading);
  return validation::average_pulls(readings);
}

std::string pull_text(const validation::PullSummary& pulls) {
  if (pulls.n_runs == 0) return {};
  return fmt::format(
      "Mean over {} run(s), each with the same weight: pull mean {:+.2f}, rms {:.2f}; {:.0f} % "
      "within 68 % bars, {:.0f} % within\n95 % bars. Stations share labels and maps, so that the "
      "pulls of a run lie to one side together: only many\nexperiments judge the bars.\n",
      pulls.n_runs, pulls.pull_mean, pulls.pull_rms, 100.0 * pulls.coverage_68,
      100.0 * pulls.coverage);
}

std::string part_text(const std::optional<validation::PartSummary>& part) {
  return part ? fmt::format("{:.1f} ({:.1f})", part->rms, part->largest) : std::string("-");
}

struct NamedJudgement {
  std::string name;
  validation::Judgement judgement;
};

/// Those of the runs, then those of the levels.
std::vector<NamedJudgement> deflections(const Verdict& verdict) {
  std::vector<NamedJudgement> list;
  for (const pipeline::RunJudgement& j : verdict.runs) list.push_back({j.run, j.deflection});
  for (const pipeline::LevelJudgement& j : verdict.levels) {
    list.push_back({fmt::format("{:.1f} Pa", j.pressure), j.deflection});
  }
  return list;
}

/// All stations of all of them together.
NamedJudgement together(const std::vector<NamedJudgement>& list, const Verdict& verdict) {
  validation::Judgement all;
  double n = 0.0, squares = 0.0, pull_squares = 0.0;
  for (const auto& [name, j] : list) {
    const auto stations = static_cast<double>(j.n_answered);
    n += stations;
    all.n_answered += j.n_answered;
    all.n_silent += j.n_silent;
    all.mean += stations * j.mean;
    all.coverage += stations * j.coverage;
    all.pull_mean += stations * j.pull_mean;
    squares += stations * j.rms * j.rms;
    pull_squares += stations * j.pull_rms * j.pull_rms;
    if (std::abs(j.largest) > std::abs(all.largest)) all.largest = j.largest;
  }
  const double share = n > 0.0 ? 1.0 / n : 0.0;
  all.mean *= share;
  all.coverage *= share;
  all.pull_mean *= share;
  all.rms = std::sqrt(squares * share);
  all.pull_rms = std::sqrt(pull_squares * share);
  return {fmt::format("all ({} runs, {} levels)", verdict.runs.size(), verdict.levels.size()), all};
}

json judgement_of_deflection(const validation::Judgement& j) {
  return {{"answered", j.n_answered},     {"silent", j.n_silent},     {"rms_error_m", j.rms},
          {"largest_error_m", j.largest}, {"mean_error_m", j.mean},   {"coverage", j.coverage},
          {"coverage_68", j.coverage_68}, {"pull_mean", j.pull_mean}, {"pull_width", j.pull_width},
          {"pull_rms", j.pull_rms}};
}

json part_json(const std::optional<validation::PartSummary>& part) {
  if (!part) return nullptr;
  return {{"mean_error_Pa", part->mean},
          {"rms_error_Pa", part->rms},
          {"largest_error_Pa", part->largest}};
}

json split_json(const validation::SplitSummary& split) {
  return {{"stations", split.n_split},
          {"left_out", split.n_left_out},
          {"total", part_json(split.total)},
          {"neighbourhood", part_json(split.neighbourhood)},
          {"labels", part_json(split.labels)},
          {"maps", part_json(split.maps)},
          {"curve_shape", part_json(split.curve_shape)},
          {"locality", part_json(split.locality)},
          {"curve_shape_and_locality", part_json(split.curve_shape_and_locality)}};
}

json stations_json(const pipeline::RunStations& stations) {
  json columns = json::object();
  for (const pipeline::StationColumn& column : stations.columns) {
    columns[column.name] = numbers(column.values);
  }
  return columns;
}

json run_json(const pipeline::RunJudgement& j) {
  return {{"run", j.run},
          {"x_start_m", number(j.x_start)},
          {"x_end_m", number(j.x_end)},
          {"answered", j.reading.n_answered},
          {"silent", j.reading.n_silent},
          {"rms_error_Pa", j.reading.rms},
          {"largest_error_Pa", j.reading.largest},
          {"mean_error_Pa", j.reading.mean},
          {"coverage", j.reading.coverage},
          {"coverage_68", j.reading.coverage_68},
          {"pull_mean", j.reading.pull_mean},
          {"pull_width", j.reading.pull_width},
          {"pull_rms", j.reading.pull_rms},
          {"true_drop_Pa", j.true_drop},
          {"drop_error_Pa", j.drop_error},
          {"drop_pull", j.drop_pull},
          {"deflection", judgement_of_deflection(j.deflection)}};
}

}  // namespace

Verdict hold_against(const results::Measurement& measurement, const twin::Truth& truth,
                     std::optional<Length> start, std::optional<Length> end) {
  Verdict verdict;
  verdict.runs = pipeline::judge(measurement, truth, start, end);
  verdict.levels = pipeline::judge_levels(measurement, truth, start, end);
  verdict.split = pipeline::split_errors(measurement, truth, start, end);
  verdict.stations = pipeline::judge_stations(measurement, truth, verdict.split, start, end);
  return verdict;
}

std::string judgement_text(const Verdict& verdict) {
  std::vector<std::vector<std::string>> rows{
      {"run", "section [mm]", "rms error [Pa]", "largest [Pa]", "no answer", "in 68 %",
       "in 95 % bars", "pull mean", "pull rms", "true drop [Pa]", "drop error [Pa]"}};
  for (const pipeline::RunJudgement& j : verdict.runs) {
    const auto total = j.reading.n_answered + j.reading.n_silent;
    const bool has_section = std::isfinite(j.x_start) && std::isfinite(j.x_end);
    rows.push_back({j.run,
                    has_section ? fmt::format("{:.2f}-{:.2f}", j.x_start * 1e3, j.x_end * 1e3)
                                : std::string("none"),
                    fmt::format("{:.1f}", j.reading.rms), fmt::format("{:.1f}", j.reading.largest),
                    fmt::format("{}/{}", j.reading.n_silent, total),
                    fmt::format("{:.0f} %", 100.0 * j.reading.coverage_68),
                    fmt::format("{:.0f} %", 100.0 * j.reading.coverage),
                    fmt::format("{:+.2f}", j.reading.pull_mean),
                    fmt::format("{:.2f}", j.reading.pull_rms), fmt::format("{:.0f}", j.true_drop),
                    fmt::format("{:+.1f}", j.drop_error)});
  }
  return text_table(rows) + pull_text(average_pulls(verdict));
}

std::string split_text(const pipeline::SplitJudgement& split) {
  if (!split.not_offered.empty()) {
    return "Where the error came from is not told: " + split.not_offered + ".\n";
  }
  std::vector<std::vector<std::string>> rows{{"run", "error", "labels", "maps", "curve shape",
                                              "locality", "neighbourhood", "shape + locality",
                                              "stations", "left out"}};
  for (const pipeline::RunSplit& run : split.runs) {
    const validation::SplitSummary& s = run.summary;
    rows.push_back({run.run, part_text(s.total), part_text(s.labels), part_text(s.maps),
                    part_text(s.curve_shape), part_text(s.locality), part_text(s.neighbourhood),
                    part_text(s.curve_shape_and_locality), fmt::format("{}", s.n_split),
                    fmt::format("{}", s.n_left_out)});
  }
  return "Where the error came from: rms (largest), Pa\n" + text_table(rows) +
         "labels: wrong pressures of the levels. maps: noise, levelling and position of the maps. "
         "curve shape: the\ncurve between levels. locality: each station read on its own, while "
         "the wall feels its neighbours.\nneighbourhood: what heeding the neighbours changed; it "
         "takes locality and noise back. The five add up at every\nstation, with their signs; "
         "their rms do not add in squares.\n";
}

std::string deflection_judgement_text(const Verdict& verdict, bool every_row) {
  constexpr std::size_t kWorst = 3;
  std::vector<NamedJudgement> list = deflections(verdict);
  if (list.empty()) return {};
  std::string head = "Width-averaged deflection, measured against true\n";
  const NamedJudgement all = together(list, verdict);
  if (!every_row && list.size() > kWorst) {
    std::stable_sort(list.begin(), list.end(), [](const auto& a, const auto& b) {
      return a.judgement.rms > b.judgement.rms;
    });
    list.resize(kWorst);
    head = fmt::format(
        "Width-averaged deflection, measured against true: the worst {} (--all shows every one)\n",
        kWorst);
  }
  list.push_back(all);
  std::vector<std::vector<std::string>> rows{{"deflection", "mean error [nm]", "rms error [nm]",
                                              "largest [nm]", "in 95 % bars", "pull mean",
                                              "pull rms"}};
  for (const auto& [name, j] : list) {
    rows.push_back({name, fmt::format("{:+.2f}", j.mean * 1e9), fmt::format("{:.2f}", j.rms * 1e9),
                    fmt::format("{:.1f}", j.largest * 1e9),
                    fmt::format("{:.0f} %", 100.0 * j.coverage),
                    fmt::format("{:+.2f}", j.pull_mean), fmt::format("{:.2f}", j.pull_rms)});
  }
  return head + text_table(rows);
}

std::string deflection_table(const Verdict& verdict) {
  std::string text =
      "kind,run_or_level_Pa,stations,silent,mean_error_m,rms_error_m,largest_error_m,coverage_68,"
      "coverage,pull_mean,pull_rms\n";
  const auto add = [&](const char* kind, const std::string& name, const validation::Judgement& j) {
    text += fmt::format("{},{},{},{},{:.9g},{:.9g},{:.9g},{:.9g},{:.9g},{:.9g},{:.9g}\n", kind,
                        pipeline::csv_text(name), j.n_answered, j.n_silent, j.mean, j.rms,
                        j.largest, j.coverage_68, j.coverage, j.pull_mean, j.pull_rms);
  };
  for (const pipeline::RunJudgement& j : verdict.runs) add("run", j.run, j.deflection);
  for (const pipeline::LevelJudgement& j : verdict.levels) {
    add("level", fmt::format("{:.9g}", j.pressure), j.deflection);
  }
  return text;
}

std::string verdict_text(const Verdict& verdict) {
  double squares = 0.0, n = 0.0;
  const pipeline::RunJudgement* worst = nullptr;
  for (const pipeline::RunJudgement& run : verdict.runs) {
    const auto answered = static_cast<double>(run.reading.n_answered);
    if (answered == 0.0) continue;
    squares += answered * run.reading.rms * run.reading.rms;
    n += answered;
    if (worst == nullptr || run.reading.rms > worst->reading.rms) worst = &run;
  }
  if (worst == nullptr) return "Verdict: no run has an answer that could be judged.\n";
  const double share = 100.0 * worst->reading.rms / std::abs(worst->true_drop);
  const validation::PullSummary pulls = average_pulls(verdict);
  return fmt::format(
      "Verdict: p(x) of {} run(s) errs by {:.1f} Pa rms; worst {} with {:.1f} Pa{}. {:.0f} % of "
      "the stations lie\nwithin their 95 % bars.\n",
      verdict.runs.size(), std::sqrt(squares / n), worst->run, worst->reading.rms,
      std::isfinite(share) ? fmt::format(", {:.2g} % of its drop", share) : std::string(),
      100.0 * pulls.coverage);
}

std::string judgement_json(const Verdict& verdict, bool with_stations) {
  json runs = json::array();
  for (std::size_t r = 0; r < verdict.runs.size(); ++r) {
    json run = run_json(verdict.runs[r]);
    run["split"] =
        verdict.split.runs.empty() ? json(nullptr) : split_json(verdict.split.runs[r].summary);
    if (with_stations) run["stations"] = stations_json(verdict.stations[r]);
    runs.push_back(std::move(run));
  }
  json levels = json::array();
  for (const pipeline::LevelJudgement& j : verdict.levels) {
    levels.push_back(
        {{"level_pressure_Pa", j.pressure}, {"deflection", judgement_of_deflection(j.deflection)}});
  }
  const validation::PullSummary pulls = average_pulls(verdict);
  json result{{"runs", std::move(runs)},
              {"levels", std::move(levels)},
              {"pulls",
               {{"runs", pulls.n_runs},
                {"pull_mean", pulls.pull_mean},
                {"pull_rms", pulls.pull_rms},
                {"coverage_68", pulls.coverage_68},
                {"coverage", pulls.coverage}}}};
  if (!verdict.split.not_offered.empty()) {
    result["split_not_offered"] = verdict.split.not_offered;
  }
  return result.dump(2) + "\n";
}

}  // namespace manoscope::cli

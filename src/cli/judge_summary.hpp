#pragma once

#include <optional>
#include <string>
#include <vector>

#include "manoscope/core/units.hpp"
#include "manoscope/pipeline/judge.hpp"
#include "manoscope/pipeline/judge_stations.hpp"
#include "manoscope/pipeline/split_errors.hpp"
#include "manoscope/results/measurement.hpp"
#include "manoscope/twin/truth.hpp"

namespace manoscope::cli {

/// All that `judge` finds out.
struct Verdict {
  std::vector<pipeline::RunJudgement> runs;
  std::vector<pipeline::LevelJudgement> levels;
  pipeline::SplitJudgement split;
  std::vector<pipeline::RunStations> stations;
};
Verdict hold_against(const results::Measurement& measurement, const twin::Truth& truth,
                     std::optional<Length> start = {}, std::optional<Length> end = {});

/// Errors of p(x) as a table, with the pulls of all runs together.
std::string judgement_text(const Verdict& verdict);
/// Where the errors came from as a table, or why that is not told.
std::string split_text(const pipeline::SplitJudgement& split);
/// Deflections against truth, under flow and at rest: the worst few and all together, or every run
/// and level.
std::string deflection_judgement_text(const Verdict& verdict, bool every_row);
/// The same of every run and level as CSV, m; nine digits.
std::string deflection_table(const Verdict& verdict);
/// The whole verdict in one or two sentences.
std::string verdict_text(const Verdict& verdict);
/// The same as JSON, SI units; on request station by station too.
std::string judgement_json(const Verdict& verdict, bool with_stations);

}  // namespace manoscope::cli

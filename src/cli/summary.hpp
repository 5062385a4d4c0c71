#pragma once

#include <filesystem>
#include <string>
#include <vector>

#include "manoscope/pipeline/judge.hpp"
#include "manoscope/results/measurement.hpp"

namespace manoscope::cli {

/// The runs of a measurement as an aligned table, drops with expanded uncertainty (k = 2).
std::string summary_text(const results::Measurement& measurement);
/// p(x) of every run at a few stations, as an aligned table.
std::string pressure_text(const results::Measurement& measurement);
/// The same runs as JSON, SI units: what drops.csv holds.
std::string summary_json(const results::Measurement& measurement,
                         const std::filesystem::path& folder);

/// Judgements against truth, as a table and as JSON.
std::string judgement_text(const std::vector<pipeline::RunJudgement>& judgements);
std::string judgement_json(const std::vector<pipeline::RunJudgement>& judgements);

}  // namespace manoscope::cli

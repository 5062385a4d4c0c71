#pragma once

#include <optional>
#include <string>
#include <vector>

#include "manoscope/core/units.hpp"
#include "manoscope/results/measurement.hpp"
#include "manoscope/twin/truth.hpp"
#include "manoscope/validation/error_split.hpp"

namespace manoscope::pipeline {

/// The error of one run by its origin, at every station of the result and summed up over the
/// stretch that is judged.
struct RunSplit {
  std::string run;
  validation::ErrorSplit stations;
  validation::SplitSummary summary;
};

/// The split of all runs, in the order of the result; or in words why there is none.
struct SplitJudgement {
  std::vector<RunSplit> runs;
  std::string not_offered;  ///< empty where there is a split
};

/// Splits the error of every run into labels, maps, curve shape and locality (ErrorSplit).
///
/// The measured curves are fitted again from the result's static deflections, uncertainties, labels
/// and settings; once more with the true pressure of every level; and once more through the true
/// deflections, all with the uncertainties the result states, so that levels are pooled by the same
/// rule. The truth is interpolated linearly to the stations. It must know the true pressure and
/// deflection of every level of the result, found by its label to 0.1 Pa (of several with that
/// label the mean counts, as in the result); without the compliance of the levels curve shape and
/// locality are known as one sum only.
/// @throws InputError if the truth lacks a run of the result.
SplitJudgement split_errors(const results::Measurement& measurement, const twin::Truth& truth,
                            std::optional<Length> start = {}, std::optional<Length> end = {});

}  // namespace manoscope::pipeline

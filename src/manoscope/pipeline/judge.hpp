#pragma once

#include <optional>
#include <string>
#include <vector>

#include "manoscope/core/units.hpp"
#include "manoscope/results/measurement.hpp"
#include "manoscope/twin/truth.hpp"
#include "manoscope/validation/judge.hpp"

namespace manoscope::pipeline {

/// One run held against its truth.
struct RunJudgement {
  std::string run;
  double x_start = 0.0, x_end = 0.0;  ///< m, the stretch that is judged
  validation::Judgement reading;
  validation::Judgement deflection;  ///< of the width-averaged zeta(x): its lengths in m
  double true_drop = 0.0;            ///< Pa, p(x_start) - p(x_end)
  double drop_error = 0.0;           ///< Pa, read minus true drop between the outermost answers
  double drop_pull = 0.0;            ///< drop error over its stated standard uncertainty
};

/// Compares every run of a result with the truth of a virtual experiment.
///
/// Judged over [start, end], or over each run's test section where they are absent. The truth is
/// interpolated linearly to the stations.
/// @throws InputError if the truth lacks a run of the result.
std::vector<RunJudgement> judge(const results::Measurement& measurement, const twin::Truth& truth,
                                std::optional<Length> start = {}, std::optional<Length> end = {});

/// One calibration level held against its truth.
struct LevelJudgement {
  double pressure = 0.0;             ///< Pa, as applied
  validation::Judgement deflection;  ///< of static_deflection: its lengths in m
};

/// Compares the static curves with the deflection that was true while each map was taken, under the
/// level's true pressure: an error of the gauge is none of the curve.
///
/// Judged over [start, end], or over the whole channel. A level is that of the truth whose label is
/// the same to 0.1 Pa, the digit of the list; others are left out, and so is all where the truth
/// tells of runs only.
std::vector<LevelJudgement> judge_levels(const results::Measurement& measurement,
                                         const twin::Truth& truth, std::optional<Length> start = {},
                                         std::optional<Length> end = {});

}  // namespace manoscope::pipeline

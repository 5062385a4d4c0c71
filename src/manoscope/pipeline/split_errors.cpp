#include "manoscope/pipeline/split_errors.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <sstream>
#include <utility>

#include "manoscope/calibration/fit_curves.hpp"
#include "manoscope/core/flags.hpp"
#include "manoscope/core/options.hpp"
#include "manoscope/pipeline/judged_stretch.hpp"

namespace manoscope::pipeline {
namespace {

using calibration::Level;
using results::Measurement;

/// How the result's curves were fitted: its settings are lines "name = value".
calibration::FitCurvesOptions fit_options(const Measurement& m) {
  calibration::FitCurvesOptions options;
  std::istringstream lines(m.settings);
  for (std::string line; std::getline(lines, line);) {
    const auto sign = line.find(" = ");
    if (sign == std::string::npos) continue;
    for (const OptionInfo& known : list_options(options)) {
      if (line.compare(0, sign, known.name) == 0) {
        set_option(options, known.name, line.substr(sign + 3), "settings of the result");
      }
    }
  }
  return options;
}

/// Calibration levels as the result holds them, at the pressures that its curves go through.
std::vector<Level> measured_levels(const Measurement& m) {
  std::vector<Level> levels;
  for (Index k = 0; k < m.level_pressure.size(); ++k) {
    Level level;
    level.name = fmt::format("level {:04d}", k);
    level.pressure = Pressure::from_si(m.level_estimate[k]);
    level.uncertainty = Pressure::from_si(m.level_estimate_uncertainty[k]);
    level.profile.x = m.x;
    level.profile.zeta = m.static_deflection.row(k);
    level.profile.uncertainty.independent = m.static_deflection_uncertainty.row(k);
    level.profile.flags = Flags1::Zero(m.x.size());
    for (Index ix = 0; ix < m.x.size(); ++ix) {
      if (!std::isnan(level.profile.zeta[ix])) continue;
      level.profile.zeta[ix] = level.profile.uncertainty.independent[ix] = 0.0;
      level.profile.flags[ix] = StationFlag::no_data;
    }
    levels.push_back(std::move(level));
  }
  return levels;
}

/// What is true of one level of the result.
struct TrueLevel {
  double pressure = 0.0;
  Array1 deflection;  ///< at the stations of the result
};

/// Mean of the truths whose label is that of the level, or nullopt.
std::optional<TrueLevel> find_level(const Measurement& m, const twin::Truth& truth, double label) {
  double nearest = kSameLabel;
  for (const twin::LevelTruth& level : truth.levels) {
    nearest = std::min(nearest, std::abs(level.label.si() - label));
  }
  if (!(nearest < kSameLabel)) return std::nullopt;
  TrueLevel found{0.0, Array1::Zero(m.x.size())};
  double n = 0.0;
  for (const twin::LevelTruth& level : truth.levels) {
    // Half a digit of the list on either side: several readings may have been rounded to one label.
    const double distance = std::abs(level.label.si() - label);
    if (distance > std::max(nearest, 0.5001 * kSameLabel)) continue;
    found.pressure += level.pressure.si();
    found.deflection += interpolate(truth.x, level.deflection, m.x);
    n += 1.0;
  }
  found.pressure /= n;
  found.deflection /= n;
  return found;
}

std::size_t n_distinct(const std::vector<Level>& levels) {
  std::vector<double> pressures;
  for (const Level& level : levels) pressures.push_back(level.pressure.si());
  std::sort(pressures.begin(), pressures.end());
  return static_cast<std::size_t>(std::unique(pressures.begin(), pressures.end()) -
                                  pressures.begin());
}

/// The wall's own curve at every station; empty where the truth does not know its compliance.
std::vector<validation::TrueCurve> exact_curves(const Measurement& m, const twin::Truth& truth) {
  std::vector<std::vector<validation::TrueCurve::Node>> nodes(static_cast<std::size_t>(m.x.size()));
  for (const twin::LevelTruth& level : truth.levels) {
    if (level.compliance.size() == 0) return {};
    const Array1 deflection = interpolate(truth.x, level.deflection, m.x);
    const Array1 compliance = interpolate(truth.x, level.compliance, m.x);
    for (Index ix = 0; ix < m.x.size(); ++ix) {
      nodes[static_cast<std::size_t>(ix)].push_back(
          {level.pressure.si(), deflection[ix], compliance[ix]});
    }
  }
  std::vector<validation::TrueCurve> curves;
  for (auto& of_station : nodes) {
    const validation::TrueCurve curve(std::move(of_station));
    curves.push_back(curve);
  }
  return curves;
}

/// Why the truth of the levels does not allow a split, or the curves that do.
std::string make_curves(const Measurement& m, const twin::Truth& truth,
                        validation::SplitCurves& curves) {
  if (truth.levels.empty()) {
    return "the truth tells of runs only, not of the calibration levels (a truth.nc does)";
  }
  const std::vector<Level> measured = measured_levels(m);
  std::vector<Level> relabelled = measured, ideal = measured;
  for (std::size_t k = 0; k < measured.size(); ++k) {
    const double label = m.level_pressure[static_cast<Index>(k)];
    const auto known = find_level(m, truth, label);
    if (!known) {
      return fmt::format("the truth holds no level labelled {:.1f} Pa", label);
    }
    relabelled[k].pressure = ideal[k].pressure = Pressure::from_si(known->pressure);
    ideal[k].profile.zeta = known->deflection;
  }
  constexpr std::size_t kFewest = 3;
  if (n_distinct(measured) < kFewest || n_distinct(relabelled) < kFewest) {
    return "there are fewer than 3 distinct levels";
  }
  calibration::FitCurvesOptions options = fit_options(m);
  options.joint_labels = false;  // done already
  curves.measured = calibration::fit_curves(measured, options);
  curves.relabelled = calibration::fit_curves(relabelled, options);
  curves.true_curves = calibration::fit_curves(ideal, options);
  curves.exact = exact_curves(m, truth);
  return {};
}

}  // namespace

SplitJudgement split_errors(const Measurement& m, const twin::Truth& truth,
                            std::optional<Length> start, std::optional<Length> end) {
  SplitJudgement result;
  validation::SplitCurves curves;
  result.not_offered = make_curves(m, truth, curves);
  if (!result.not_offered.empty()) return result;
  const Flags1 everywhere = Flags1::Ones(m.x.size());
  for (Index r = 0; r < m.flow_rate.size(); ++r) {
    const twin::RunTruth& run = find_truth(truth, m.run[static_cast<std::size_t>(r)]);
    validation::SplitInput input;
    input.pressure = m.pressure.row(r);
    input.local_pressure = m.pressure_local.row(r);
    input.deflection = m.deflection.row(r);
    input.answered = answers(answers(everywhere, input.pressure), input.deflection);
    input.answered = answers(input.answered, input.local_pressure);
    input.true_pressure = interpolate(truth.x, run.pressure, m.x);
    input.true_deflection = interpolate(truth.x, run.deflection, m.x);
    RunSplit split{run.run, validation::split_error(input, curves), {}};
    const auto [x_start, x_end] = judged_stretch(m, r, start, end);
    split.summary =
        validation::summarise(split.stations, within(m.x, x_start, x_end), input.answered);
    result.runs.push_back(std::move(split));
  }
  return result;
}

}  // namespace manoscope::pipeline

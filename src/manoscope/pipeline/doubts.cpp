#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <map>

#include "manoscope/core/flags.hpp"
#include "manoscope/pipeline/assemble.hpp"

namespace manoscope::pipeline {
namespace {

using Words = std::vector<std::string>;

void doubt_place(const experiment::Experiment& experiment, const maps::FoundPlace& place,
                 const ReducedExperiment& reduced, Words& doubts) {
  constexpr double kShare = 0.05;  // of the width: about the size of the end effects of the edges
  constexpr double kPixels = 2.0;  // and each end is found to a pixel
  const bool along_columns = reduced.frame.along_columns();
  const Length along = along_columns ? reduced.grid.pitch_x : reduced.grid.pitch_y;
  const Length across = along_columns ? reduced.grid.pitch_y : reduced.grid.pitch_x;
  const auto say = [&](const char* what, double misfit, Length stated, Length pitch) {
    const double bound = std::max(kShare * experiment.channel.width, kPixels * pitch).si();
    if (std::isnan(misfit) || std::abs(misfit) <= bound) return;  // NaN: the place was given
    doubts.push_back(
        fmt::format("The wall moves over a {} of {:.2f} mm, the experiment file says "
                    "{:.2f} mm: check channel.{}",
                    what, (stated.si() + misfit) * 1e3, stated.in(mm), what));
  };
  say("length", place.length_misfit, experiment.channel.length, along);
  say("width", place.width_misfit, experiment.channel.width, across);
}

void doubt_maps(const experiment::Experiment& experiment, const ReducedExperiment& reduced,
                Words& doubts) {
  constexpr double kNoiseRatio = 1.3, kMissing = 0.2, kCorrelated = 2.0;
  int noisy = 0, gappy = 0, correlated = 0;
  double worst_ratio = 1.0, worst_missing = 0.0, worst_length = 1.0;
  const auto look = [&](const maps::MapCondition& condition) {
    if (experiment.instrument.height_noise) {
      const double ratio = condition.noise.sigma / *experiment.instrument.height_noise;
      noisy += ratio > kNoiseRatio;
      worst_ratio = std::max(worst_ratio, ratio);
    }
    gappy += condition.missing > kMissing;
    worst_missing = std::max(worst_missing, condition.missing);
    const double length = std::max(condition.noise.length_x, condition.noise.length_z);
    correlated += length > kCorrelated;
    worst_length = std::max(worst_length, length);
  };
  for (const auto& map : reduced.hydrostatic) look(map.condition);
  for (const auto& map : reduced.flow) look(map.condition);
  if (noisy > 0) {
    doubts.push_back(
        fmt::format("{} maps are noisier on their rim than instrument.height_noise "
                    "says, up to {:.1f} times: the error bars may be too small",
                    noisy, worst_ratio));
  }
  if (gappy > 0) {
    doubts.push_back(fmt::format("{} maps lack more than {:.0f} % of their pixels, up to {:.0f} %",
                                 gappy, 100 * kMissing, 100 * worst_missing));
  }
  if (correlated > 0) {
    doubts.push_back(fmt::format(
        "Pixel noise of {} maps is correlated over up to {:.1f} pixels: noise of neighbouring "
        "stations is not independent along x, though treated so",
        correlated, worst_length));
  }
}

void doubt_run(const FlowRun& run, const RunFindings& found, Words& doubts) {
  const Flags1& flags = found.reading.flags;
  const Index n = flags.size();
  const auto count = [&](FlagBits bit) {
    Index sum = 0;
    for (Index i = 0; i < n; ++i) sum += (flags[i] & bit) != 0;
    return sum;
  };
  if (!found.section) {
    doubts.push_back(
        fmt::format("Run {}: no test section, for hardly a station has an answer "
                    "({} of {} out of calibration, {} ambiguous, {} insensitive)",
                    run.name, count(ReadingFlag::out_of_calibration), n,
                    count(ReadingFlag::ambiguous), count(ReadingFlag::insensitive)));
    return;
  }
  // Not only inside the section: it ends where the last answer is.
  const auto say = [&](FlagBits bit, const char* what) {
    Index bad = 0, n_wanted = 0;
    for (Index i = 0; i < n; ++i) {
      const Length x = Length::from_si(found.reading.x[i]);
      if (x < found.stretch.start || x > found.stretch.end) continue;
      ++n_wanted;
      bad += (flags[i] & bit) != 0;
    }
    if (bad == 0) return;
    doubts.push_back(fmt::format(
        "Run {}: {} of {} stations between x = {:.2f} and {:.2f} mm have no reading, {}", run.name,
        bad, n_wanted, found.stretch.start.in(mm), found.stretch.end.in(mm), what));
  };
  say(ReadingFlag::ambiguous, "for more than one pressure fits (buckled wall)");
  say(ReadingFlag::out_of_calibration, "for the deflection is outside the calibrated levels");
  say(ReadingFlag::insensitive, "for the wall hardly answers there");
}

/// Labels, number of levels, and the sign of the wall's answer.
void doubt_calibration(const experiment::Experiment& experiment,
                       const calibration::ConstitutiveCurves& curves,
                       const std::vector<LevelDoubt>& levels, Words& doubts) {
  constexpr std::size_t kFewLevels = 8;
  if (curves.levels.size() < kFewLevels) {
    doubts.push_back(
        fmt::format("Only {} levels make the curves: interpolation between them may "
                    "err by more than the error bars say",
                    curves.levels.size()));
  }
  const auto certain = std::count_if(
      experiment.hydrostatic.begin(), experiment.hydrostatic.end(), [](const auto& entry) {
        return entry.pressure != Pressure{} && entry.pressure_uncertainty == Pressure{};
      });
  if (certain > 0) {
    doubts.push_back(fmt::format(
        "{} levels at other than 0 Pa have a pressure uncertainty of 0, as if vented to air: the "
        "error bars lack the noise of the gauge (pressure_uncertainty, instrument.pressure_noise)",
        certain));
  }
  const Profile& first = curves.levels.front().profile;
  const Profile& last = curves.levels.back().profile;
  Index inward = 0, counted = 0;
  for (Index ix = 0; ix < curves.x.size(); ++ix) {
    if (first.flags[ix] != 0 || last.flags[ix] != 0) continue;
    ++counted;
    inward += last.zeta[ix] < first.zeta[ix];
  }
  if (2 * inward > counted) {
    doubts.emplace_back(
        "The wall moves towards the fluid as pressure rises: channel.outward has "
        "the wrong sign, or the labels do");
    return;  // what follows would only repeat it
  }
  for (const LevelDoubt& level : levels) {
    doubts.push_back(fmt::format(
        "Level {}: labelled {:.6g} Pa, but its map reads {:.6g} Pa on the curves of the other "
        "levels, {:.0f} standard uncertainties away: check its label and its neighbours'; if they "
        "are right the wall turns sharply there, and closer levels would help",
        level.name, level.label, level.read, std::abs(level.pull)));
  }
}

/// The same bytes listed twice.
void doubt_inputs(const experiment::Experiment& experiment, const ReducedExperiment& reduced,
                  Words& doubts) {
  std::map<std::string, std::string> seen;
  const std::size_t n_static = experiment.hydrostatic.size();
  for (std::size_t i = 0; i < reduced.hash.size(); ++i) {
    const std::string& name =
        i < n_static ? experiment.hydrostatic[i].name : experiment.flow[i - n_static].name;
    const auto [place, is_new] = seen.try_emplace(reduced.hash[i], name);
    if (!is_new) {
      doubts.push_back(
          fmt::format("{} and {} are the same file, byte by byte", place->second, name));
    }
  }
}

void doubt_agreement(const FlowRun& run, const RunFindings& found, Words& doubts) {
  constexpr double kFarApart =
      5.0;  // ten standard uncertainties: beyond any flow model's refinement
  if (!found.no_comparison.empty()) {
    doubts.push_back(
        fmt::format("Run {}: no hydraulic resistance, for the {}", run.name, found.no_comparison));
  }
  if (!found.agreement) return;
  const double extracted = found.agreement->extracted.value;
  if (run.flow_rate > FlowRate{} && extracted < 0.0) {
    doubts.push_back(
        fmt::format("Run {}: the pressure rises by {:.0f} Pa along the flow: "
                    "channel.flow points the wrong way, or the maps are mixed up",
                    run.name, -extracted));
  } else if (std::isgreater(found.agreement->en_number, kFarApart)) {
    doubts.push_back(fmt::format(
        "Run {}: dp_e = {:.4g} Pa and QR = {:.4g} Pa are {:.0f} times their expanded uncertainty "
        "apart: check the units of pressures and flow rates, channel.height, the viscosity, and "
        "that the map belongs to the run",
        run.name, extracted, found.agreement->resistance.value, found.agreement->en_number));
  }
}

}  // namespace

Words find_doubts(const experiment::Experiment& experiment, const maps::FoundPlace& place,
                  const ReducedExperiment& reduced, const calibration::ConstitutiveCurves& curves,
                  const std::vector<LevelDoubt>& levels, const std::vector<FlowRun>& runs,
                  const std::vector<RunFindings>& findings) {
  Words doubts;
  doubt_place(experiment, place, reduced, doubts);
  doubt_maps(experiment, reduced, doubts);
  if (!experiment.channel.height_uncertainty && !runs.empty()) {
    doubts.emplace_back(
        "channel.height_uncertainty is not given: the uncertainty of QR lacks that of the gap");
  }
  doubt_calibration(experiment, curves, levels, doubts);
  doubt_inputs(experiment, reduced, doubts);
  for (std::size_t r = 0; r < runs.size(); ++r) {
    doubt_run(runs[r], findings[r], doubts);
    doubt_agreement(runs[r], findings[r], doubts);
  }
  return doubts;
}

}  // namespace manoscope::pipeline

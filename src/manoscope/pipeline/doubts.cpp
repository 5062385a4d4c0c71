#include <fmt/format.h>

#include <algorithm>
#include <cmath>

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

}  // namespace

Words find_doubts(const experiment::Experiment& experiment, const maps::FoundPlace& place,
                  const ReducedExperiment& reduced, const std::vector<FlowRun>& runs,
                  const std::vector<RunFindings>& findings) {
  Words doubts;
  doubt_place(experiment, place, reduced, doubts);
  doubt_maps(experiment, reduced, doubts);
  if (!experiment.channel.height_uncertainty && !runs.empty()) {
    doubts.emplace_back(
        "channel.height_uncertainty is not given: the uncertainty of QR lacks that of the gap");
  }
  for (std::size_t r = 0; r < runs.size(); ++r) doubt_run(runs[r], findings[r], doubts);
  return doubts;
}

}  // namespace manoscope::pipeline

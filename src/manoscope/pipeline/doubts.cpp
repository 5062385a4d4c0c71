#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <map>
#include <numbers>

#include "manoscope/core/flags.hpp"
#include "manoscope/experiment/file_doubts.hpp"
#include "manoscope/pipeline/assemble.hpp"
#include "manoscope/pipeline/file_warnings.hpp"

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

/// Whether the wall that answers to pressure lies where the experiment file says; told if not.
/// To a pixel or so: what registration finds is finer and holds close to the truth alone.
bool doubt_given_place(const maps::FoundPlace& place, const ReducedExperiment& reduced,
                       Words& doubts) {
  constexpr double kShare = 0.05, kPixels = 2.0;  // as for length and width
  const ChannelFrame& frame = reduced.frame;
  const bool along_columns = frame.along_columns();
  const Length along = along_columns ? reduced.grid.pitch_x : reduced.grid.pitch_y;
  const Length across = along_columns ? reduced.grid.pitch_y : reduced.grid.pitch_x;
  const auto is_off = [&](double misfit, Length pitch) {
    const double bound = std::max(kShare * frame.width, kPixels * pitch).si();
    return !std::isnan(misfit) && std::abs(misfit) > bound;
  };
  const bool off_along = is_off(place.along_misfit, along);
  const bool off_across = is_off(place.across_misfit, across);
  if (!off_along && !off_across) return true;
  std::string where;
  if (off_along) {
    where = fmt::format("{:.2f} mm further {}", std::abs(place.along_misfit) * 1e3,
                        place.along_misfit > 0.0 ? "downstream" : "upstream");
  }
  if (off_across) {
    where += fmt::format("{}{:.2f} mm to one side", where.empty() ? "" : " and ",
                         std::abs(place.across_misfit) * 1e3);
  }
  doubts.push_back(
      fmt::format("The wall that answers to pressure lies {} of where the experiment file has the "
                  "channel: check channel.origin, or leave it out to have it found",
                  where));
  return false;
}

/// The wall's own ends against the frame they were read in.
void doubt_origin(const ReducedExperiment& reduced, Words& doubts) {
  if (!reduced.offset) return;
  constexpr double kSigmas = 4.0, kShare = 0.01;  // of the width: walls are not quite symmetric
  const double shift = reduced.offset->shift.si();
  const double bound =
      std::max({kSigmas * reduced.offset->uncertainty.si(), 0.5 * reduced.grid.pitch_x.si(),
                kShare * reduced.frame.width.si()});
  if (std::abs(shift) <= bound) return;
  doubts.push_back(
      fmt::format("The ends of the wall lie {:.3f} mm further {} than the channel's frame: check "
                  "channel.origin and channel.length; every x is off by as much",
                  std::abs(shift) * 1e3, shift > 0.0 ? "downstream" : "upstream"));
}

void doubt_texture(const ReducedExperiment& reduced, Words& doubts) {
  const auto& maps = reduced.hydrostatic;
  if (maps.empty() || !maps.front().condition.texture_contradicts) return;
  doubts.push_back(
      "The texture of the rigid rim tells other shifts of the maps than the ends of the wall, "
      "which "
      "were heeded: marks that never move are the instrument's, and a map of a flat mirror named "
      "as "
      "instrument.reference takes them away");
}

/// The wall's middle against the frame's, and its angle.
void doubt_centre(const ReducedExperiment& reduced, Words& doubts) {
  if (!reduced.centre) return;
  constexpr double kShare = 0.02;  // of the width: walls are not quite symmetric
  const ChannelFrame& frame = reduced.frame;
  const Length pitch = frame.along_columns() ? reduced.grid.pitch_y : reduced.grid.pitch_x;
  const double bound = std::max(kShare * frame.width.si(), pitch.si());
  const double offset = reduced.centre->offset.si();
  const double turned = 0.5 * frame.length.si() * reduced.centre->slope;
  if (std::abs(offset) > bound) {
    doubts.push_back(fmt::format(
        "The middle of the wall lies {:.3f} mm to one side of the channel's frame: check "
        "channel.origin and channel.width",
        std::abs(offset) * 1e3));
  }
  if (std::abs(turned) > bound) {
    doubts.push_back(
        fmt::format("The wall lies askew by {:.2f} deg in the channel's frame: check "
                    "channel.rotation",
                    reduced.centre->slope * 180.0 / std::numbers::pi));
  }
}

/// A bend of the frame that is the same in every map adds the same height to every deflection: the
/// reading of p(x) does not notice, but the gap and so QR ~ gap^-3 are off by it.
void doubt_common_bend(const experiment::Experiment& experiment,
                       const std::vector<const maps::RimBend*>& bends, double mean, Words& doubts) {
  constexpr double kSigmas = 5.0, kShare = 1e-3;  // of the height, where its uncertainty is unknown
  double variance = 0.0;
  for (const auto* bend : bends) variance += std::pow(bend->at_middle_uncertainty.si(), 2);
  const auto n = static_cast<double>(bends.size());
  const double height = experiment.channel.height.si();
  const double known = experiment.channel.height_uncertainty
                           ? experiment.channel.height_uncertainty->si()
                           : kShare * height;
  const bool clear = variance > 0.0 && std::abs(mean) > kSigmas * std::sqrt(variance) / n;
  if (!clear || std::abs(mean) <= known || !(height > 0.0)) return;
  doubts.push_back(fmt::format(
      "The rigid rim is bent alike in all maps: by {:.0f} nm in the middle of the channel, which "
      "goes into the gap and makes QR {:.2g} % too {}; p(x) does not notice. If the frame is flat "
      "the bend is the instrument's: name a map of a flat mirror as instrument.reference, or try "
      "--level-order 2",
      mean * 1e9, 300.0 * std::abs(mean) / height, mean > 0.0 ? "small" : "large"));
}

/// A frame that bends from map to map moves the deflection by as much.
void doubt_rim(const experiment::Experiment& experiment, const ReducedExperiment& reduced,
               Words& doubts) {
  if (reduced.level_order != 1) return;
  constexpr double kSigmas = 5.0;
  std::vector<const maps::RimBend*> bends;
  for (const auto& map : reduced.hydrostatic) bends.push_back(&map.condition.bend);
  for (const auto& map : reduced.flow) bends.push_back(&map.condition.bend);
  double sum = 0.0, widest = 0.0, doubt = 0.0;
  for (const auto* bend : bends) sum += bend->at_middle.si();
  const double mean = sum / static_cast<double>(bends.size());
  doubt_common_bend(experiment, bends, mean, doubts);
  for (const auto* bend : bends) {
    const double off = std::abs(bend->at_middle.si() - mean);
    const double sigma = bend->at_middle_uncertainty.si();
    if (sigma == 0.0 || off <= kSigmas * sigma || off <= widest) continue;
    widest = off;
    doubt = sigma;
  }
  if (widest == 0.0) return;
  doubts.push_back(
      fmt::format("The rigid rim bends from map to map: by up to {:.1f} nm (u = {:.1f} nm) in the "
                  "middle of the "
                  "channel against their mean, which goes into the deflection. Try --level-order 2",
                  widest * 1e9, doubt * 1e9));
}

void doubt_maps(const experiment::Experiment& experiment, const ReducedExperiment& reduced,
                Words& doubts) {
  constexpr double kNoiseRatio = 1.3, kMissing = 0.2, kCorrelated = 2.0;
  constexpr double kUnmended = 0.01;  // of the pixels: single ones are flagged in every noisy map
  int noisy = 0, gappy = 0, correlated = 0, unmended = 0;
  double worst_ratio = 1.0, worst_missing = 0.0, worst_length = 1.0, worst_unmended = 0.0;
  const auto n_pixels = static_cast<double>(reduced.grid.nx * reduced.grid.ny);
  const auto look = [&](const maps::MapCondition& condition) {
    if (experiment.instrument.height_noise) {
      const double ratio = condition.noise.sigma / *experiment.instrument.height_noise;
      noisy += ratio > kNoiseRatio;
      worst_ratio = std::max(worst_ratio, ratio);
    }
    gappy += condition.missing > kMissing;
    worst_missing = std::max(worst_missing, condition.missing);
    const double length = std::max(condition.noise.length_x, condition.noise.length_z);
    const double left_out =
        n_pixels > 0.0 ? static_cast<double>(condition.fringe.flagged_pixels) / n_pixels : 0.0;
    unmended += left_out > kUnmended;
    worst_unmended = std::max(worst_unmended, left_out);
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
  if (unmended > 0) {
    doubts.push_back(fmt::format(
        "{} maps have patches of a false fringe order that could not be mended, up to {:.1f} % of "
        "their pixels, which are left out: state instrument.wavelength, or measure again",
        unmended, 100 * worst_unmended));
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

/// Whether the wall is nearer to the fluid at the highest level than at the lowest.
bool moves_inward(const calibration::ConstitutiveCurves& curves) {
  const Profile& first = curves.levels.front().profile;
  const Profile& last = curves.levels.back().profile;
  Index inward = 0, counted = 0;
  for (Index ix = 0; ix < curves.x.size(); ++ix) {
    if (first.flags[ix] != 0 || last.flags[ix] != 0) continue;
    ++counted;
    inward += last.zeta[ix] < first.zeta[ix];
  }
  return 2 * inward > counted;
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
  Words labels = experiment::label_doubts(experiment);
  const bool inward = moves_inward(curves);
  if (!labels.empty() && !levels.empty() && !inward) {
    // Labels taken as exact disagree by their own noise, or, if they are exact, by what the curves
    // err by with one level left out: told once, and as no fault of the labels.
    const LevelDoubt& worst = *std::max_element(
        levels.begin(), levels.end(), [](const LevelDoubt& a, const LevelDoubt& b) {
          return std::abs(a.read - a.label) < std::abs(b.read - b.label);
        });
    labels.front() += fmt::format(
        ". So the maps of {} level{} from their labels, read on the curves of the other levels, "
        "most "
        "of all {}: labelled {:.6g} Pa, it reads {:.6g} Pa. Unstated noise of the gauge does that, "
        "and so does interpolation over a level left out where the wall turns sharply",
        levels.size(), levels.size() == 1 ? " differs" : "s differ", worst.name, worst.label,
        worst.read);
  }
  doubts.insert(doubts.end(), labels.begin(), labels.end());
  if (inward) {
    doubts.emplace_back(
        "The wall moves towards the fluid as pressure rises: channel.outward has "
        "the wrong sign, or the labels do");
    return;  // what follows would only repeat it
  }
  if (!labels.empty()) return;
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

}  // namespace

Words find_doubts(const experiment::Experiment& experiment, const maps::FoundPlace& place,
                  const ReducedExperiment& reduced, const calibration::ConstitutiveCurves& curves,
                  const std::vector<LevelDoubt>& levels, const std::vector<FlowRun>& runs,
                  const std::vector<RunFindings>& findings) {
  Words doubts;
  doubt_place(experiment, place, reduced, doubts);
  if (doubt_given_place(place, reduced, doubts)) {
    doubt_origin(reduced, doubts);
    doubt_centre(reduced, doubts);
  }
  doubt_texture(reduced, doubts);
  doubt_rim(experiment, reduced, doubts);
  doubt_maps(experiment, reduced, doubts);
  for (const std::string& doubt : file_warnings(experiment, reduced.file_warnings)) {
    doubts.push_back(doubt);
  }
  for (const std::string& doubt : experiment::flow_doubts(experiment)) doubts.push_back(doubt);
  doubt_calibration(experiment, curves, levels, doubts);
  doubt_inputs(experiment, reduced, doubts);
  for (std::size_t r = 0; r < runs.size(); ++r) {
    doubt_run(runs[r], findings[r], doubts);
    for (const std::string& doubt : doubt_flow(experiment, runs[r], findings[r])) {
      doubts.push_back(doubt);
    }
  }
  return doubts;
}

}  // namespace manoscope::pipeline

#pragma once

#include <vector>

#include "manoscope/core/monitor.hpp"
#include "manoscope/design/forecast.hpp"

namespace manoscope::design {

/// What of the uncertainty over a range is to be small.
enum class Aim { worst, rms };

/// What is to be read, Pa.
struct Target {
  PressureSpan range;
  /// Where pressures will lie, each span with the same weight, evenly inside: the runs. Empty: the
  /// range.
  std::vector<PressureSpan> spans;

  /// Weight of a pressure per pascal; its integral over the range is 1.
  double density(double pressure) const;
};

/// Uncertainty of readings, Pa.
struct RangeUncertainty {
  double worst = 0.0, worst_at = 0.0;  ///< of Forecast::uncertainty(), over the range
  double rms = 0.0;                    ///< weighted with the density
  double rms_error = 0.0;              ///< of the expected error alone

  double of(Aim aim) const { return aim == Aim::worst ? worst : rms; }
};

/// Forecasts readings at even steps over the range; infinite where one has no answer.
RangeUncertainty uncertainty_over(const Apparatus& apparatus, const std::vector<double>& levels,
                                  const Target& target);

/// What levels are placed for, and where they may stand.
struct PlacementTask {
  Apparatus apparatus;
  Target target;
  double lowest_top = 0.0;     ///< Pa, the highest level stands here or above
  double highest_level = 0.0;  ///< Pa, and no level stands higher
  bool vented = true;          ///< the first level is 0 Pa
  Aim aim = Aim::worst;
  /// Relative standard uncertainty of the pressures of the wall's curve before the experiment:
  /// levels are placed for this wall and for two whose pressures are so much higher and lower.
  double wall_doubt = 0.1;
  /// Maps at one pressure or close to it. An optimum without this bound has no more levels than a
  /// law of the wall has numbers, and would never notice a wall that follows another.
  int most_repeats = 2;
};

/// n levels: the first at 0 if vented, the others from `first` to `top` in equal ratios.
std::vector<double> log_spaced(int n, double first, double top, bool vented);
/// n levels from 0 (or `first` if not vented) to `top` in equal steps.
std::vector<double> even_levels(int n, double first, double top, bool vented);
/// The log-spaced levels up to lowest_top whose first serves this very wall best: the lowest
/// score_levels() without doubt.
std::vector<double> best_log_spaced(const PlacementTask& task, int n);

/// What placing makes small, Pa: for the worst a mean of high power of Forecast::uncertainty() over
/// pressures between all levels; for the rms nine tenths of its square and one of the worst's, so
/// that no pressure is given up. For the three walls of the doubt the root mean square of theirs.
double score_levels(const PlacementTask& task, const std::vector<double>& levels);

/// Sixty levels over the range, and the apparatus with exact labels: what hardly any number of
/// levels goes beyond.
std::vector<double> dense_levels(const PlacementTask& task);
Apparatus with_exact_labels(const Apparatus& apparatus);

/// score_levels() of these, below that of `levels`: the part that placing them cannot change.
double score_floor(const PlacementTask& task, const std::vector<double>& levels);

/// Places n levels so that their score is least.
///
/// Starts from the best of even, log-spaced and evenly deflected levels. The level that helps least
/// moves to where it helps most, as long as that gains; then each is moved by steps that grow
/// shorter. A local minimum. Several levels at one pressure are repeats.
///
/// @param n          4 or more.
/// @param n_threads  0 = all the machine has; the result is the same for any.
/// @throws Interrupted if the monitor says so.
std::vector<double> place_levels(const PlacementTask& task, int n, int n_threads = 0,
                                 const Monitor& monitor = {});

}  // namespace manoscope::design

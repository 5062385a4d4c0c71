#include <fmt/format.h>

#include <cmath>

#include "manoscope/inversion/sweeps.hpp"
#include "manoscope/pipeline/checks.hpp"

namespace manoscope::pipeline {

void store_sweeps(const std::vector<calibration::Level>& levels,
                  const calibration::FitCurvesOptions& options, const inversion::Stretch& stretch,
                  results::Measurement& m) {
  const auto found = inversion::compare_sweeps(levels, options, stretch);
  if (!found) return;
  m.sweep_up_maps = found->n_up;
  m.sweep_down_maps = found->n_down;
  m.sweep_difference = found->difference;
  m.sweep_difference_uncertainty = found->uncertainty;
}

std::vector<std::string> doubt_sweeps(const results::Measurement& m) {
  constexpr double kPull = 3.29;  // once in 10^3
  const double difference = m.sweep_difference, bar = m.sweep_difference_uncertainty;
  if (!std::isgreater(std::abs(difference), kPull * bar)) return {};
  return {fmt::format(
      "The wall deflects alike at pressures {:.1f} ± {:.1f} Pa {} on the way down than on the way "
      "up: hysteresis of the wall, or gauge and frame drift. Take the levels on the way on which "
      "the runs are reached, or wait longer at each",
      std::abs(difference), bar, difference < 0.0 ? "lower" : "higher")};
}

}  // namespace manoscope::pipeline

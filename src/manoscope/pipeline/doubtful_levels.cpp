#include <algorithm>
#include <cmath>
#include <vector>

#include "manoscope/inversion/leave_one_out.hpp"
#include "manoscope/numerics/robust.hpp"
#include "manoscope/pipeline/assemble.hpp"

namespace manoscope::pipeline {

std::vector<LevelDoubt> doubtful_levels(const calibration::ConstitutiveCurves& curves,
                                        calibration::FitCurvesOptions options,
                                        const inversion::Stretch& stretch) {
  constexpr double kSure = 5.0;
  // Each label against curves through the others as they were read.
  options.joint_labels = false;
  const inversion::LeftOut left_out = inversion::leave_one_out(curves, options, stretch);
  std::vector<LevelDoubt> doubts;
  for (std::size_t k = 0; k < left_out.levels.size(); ++k) {
    const inversion::LevelLeftOut& level = left_out.levels[k];
    std::vector<double> errors, pulls;
    for (Index i = 0; i < level.error.size(); ++i) {
      if (!std::isfinite(level.error[i]) || !(level.uncertainty[i] > 0.0)) continue;
      errors.push_back(level.error[i]);
      pulls.push_back(level.error[i] / level.uncertainty[i]);
    }
    if (pulls.empty() || 2 * static_cast<Index>(pulls.size()) < level.error.size()) continue;
    const double pull = numerics::median(pulls);
    if (std::abs(pull) <= kSure) continue;
    const double label = curves.levels[k].pressure.si();
    doubts.push_back({curves.levels[k].name, label, label + numerics::median(errors), pull});
  }
  return doubts;
}

}  // namespace manoscope::pipeline

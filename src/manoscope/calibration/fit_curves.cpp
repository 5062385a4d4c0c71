#include "manoscope/calibration/fit_curves.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <utility>

#include "manoscope/calibration/joint_labels.hpp"
#include "manoscope/core/error.hpp"

namespace manoscope::calibration {
namespace {

using Knot = ConstitutiveCurve::Knot;
using Group = std::vector<Index>;

/// Neighbouring levels that their labels do not tell apart.
std::vector<Group> group_levels(const std::vector<Level>& levels, double pooling) {
  std::vector<Group> groups;
  for (Index k = 0; k < static_cast<Index>(levels.size()); ++k) {
    const Level& level = levels[static_cast<std::size_t>(k)];
    if (!groups.empty()) {
      const Level& first = levels[static_cast<std::size_t>(groups.back().front())];
      const double doubt = std::hypot(first.uncertainty.si(), level.uncertainty.si());
      const bool both_uncertain = first.uncertainty > Pressure{} && level.uncertainty > Pressure{};
      const double step = (level.pressure - first.pressure).si();
      // Estimated together, levels may change places with their neighbours.
      if (step <= 0.0 || (both_uncertain && step < pooling * doubt)) {
        groups.back().push_back(k);
        continue;
      }
    }
    groups.push_back({k});
  }
  return groups;
}

/// The pressures that the curves go through, and the errors they share.
void settle_pressures(ConstitutiveCurves& curves, std::optional<JointLabels> joint) {
  const auto n = static_cast<Index>(curves.levels.size());
  if (joint) {
    curves.level_pressure = std::move(joint->pressure);
    curves.label_response = std::move(joint->response);
    curves.label_effect = std::move(joint->root);
    for (Index j = 0; j < n; ++j) {
      curves.label_error.push_back(fmt::format("pressure labels together, {}", j + 1));
    }
    return;
  }
  curves.level_pressure = Array1(n);
  curves.label_response = Matrix::Identity(n, n);
  curves.label_effect = Matrix::Zero(n, n);
  for (Index k = 0; k < n; ++k) {
    const Level& level = curves.levels[static_cast<std::size_t>(k)];
    curves.level_pressure[k] = level.pressure.si();
    curves.label_effect(k, k) = level.uncertainty.si();
    curves.label_error.push_back("label of " + level.name);
  }
}

class StationFitter {
 public:
  StationFitter(const std::vector<Level>& levels, const FitCurvesOptions& options)
      : levels_(levels), options_(options), groups_(group_levels(levels, options.pooling)) {
    for (const Level& level : levels) sigma_.push_back(level.profile.uncertainty.standard());
  }

  /// Knots of one station, ascending in pressure; unreal falls pooled away.
  std::vector<Knot> knots(Index ix) const {
    std::vector<Knot> knots;
    for (const Group& group : groups_) {
      Knot knot{{}, 0.0, 0.0};
      for (const Index k : group) {
        if (level(k).profile.flags[ix] == 0) knot.levels.push_back(k);
      }
      if (knot.levels.empty()) continue;
      average(knot, ix);
      knots.push_back(std::move(knot));
    }
    while (pool_one_unreal_fall(knots, ix)) {
    }
    return knots;
  }

 private:
  const Level& level(Index k) const { return levels_[static_cast<std::size_t>(k)]; }

  void average(Knot& knot, Index ix) const {
    knot.pressure = knot.zeta = 0.0;
    for (const Index k : knot.levels) {
      knot.pressure += level(k).pressure.si();
      knot.zeta += level(k).profile.zeta[ix];
    }
    knot.pressure /= static_cast<double>(knot.levels.size());
    knot.zeta /= static_cast<double>(knot.levels.size());
  }

  /// Variance of the deflection of a knot, errors of its labels turned into deflection.
  double variance(const Knot& knot, Index ix, double slope) const {
    double sum = 0.0;
    for (const Index k : knot.levels) {
      const double sigma = sigma_[static_cast<std::size_t>(k)][ix];
      const double label = slope * level(k).uncertainty.si();
      sum += sigma * sigma + label * label;
    }
    return sum / static_cast<double>(knot.levels.size() * knot.levels.size());
  }

  /// Pools the first stretch of falling or equal knots whose fall is within the noise.
  bool pool_one_unreal_fall(std::vector<Knot>& knots, Index ix) const {
    for (std::size_t first = 0; first + 1 < knots.size();) {
      std::size_t last = first;
      while (last + 1 < knots.size() && knots[last + 1].zeta <= knots[last].zeta) ++last;
      if (last == first) {
        ++first;
        continue;
      }
      const std::size_t before = first > 0 ? first - 1 : first;
      const std::size_t after = std::min(last + 1, knots.size() - 1);
      const double slope = (knots[after].zeta - knots[before].zeta) /
                           (knots[after].pressure - knots[before].pressure);
      const double fall = knots[first].zeta - knots[last].zeta;
      const double doubt =
          std::sqrt(variance(knots[first], ix, slope) + variance(knots[last], ix, slope));
      if (fall <= options_.fold_significance * doubt) {
        for (std::size_t j = first + 1; j <= last; ++j) {
          knots[first].levels.insert(knots[first].levels.end(), knots[j].levels.begin(),
                                     knots[j].levels.end());
        }
        knots.erase(knots.begin() + static_cast<Index>(first) + 1,
                    knots.begin() + static_cast<Index>(last) + 1);
        average(knots[first], ix);
        return true;
      }
      first = last;
    }
    return false;
  }

  const std::vector<Level>& levels_;
  FitCurvesOptions options_;
  std::vector<Group> groups_;
  std::vector<Array1> sigma_;
};

/// Curves of all stations through levels whose pressures are settled.
void draw_curves(ConstitutiveCurves& curves, const FitCurvesOptions& options) {
  curves.x = curves.levels.front().profile.x;
  const std::vector<Level> estimated = curves.estimated_levels();
  const PressureScale scale = fit_pressure_scale(estimated);
  const StationFitter fitter(estimated, options);
  for (Index ix = 0; ix < curves.x.size(); ++ix) {
    auto knots = fitter.knots(ix);
    if (knots.size() < 2) {
      curves.curves.emplace_back();
    } else {
      curves.curves.emplace_back(ConstitutiveCurve(scale, std::move(knots)));
    }
  }
}

}  // namespace

void FitCurvesOptions::validate() const {
  if (!(pooling >= 0.0)) {
    throw InputError("--pooling", fmt::format("is {}", pooling), "Give 0 or more");
  }
  if (!(fold_significance >= 0.0)) {
    throw InputError("--fold-significance", fmt::format("is {}", fold_significance),
                     "Give 0 or more");
  }
}

ConstitutiveCurves fit_curves(std::vector<Level> levels, const FitCurvesOptions& options,
                              const WallCurves* wall) {
  options.validate();
  ConstitutiveCurves result;
  result.levels = sort_levels(std::move(levels));
  settle_pressures(result,
                   options.joint_labels ? estimate_labels(result.levels, wall) : std::nullopt);
  draw_curves(result, options);
  return result;
}

ConstitutiveCurves expect_curves(std::vector<Level> levels, const FitCurvesOptions& options) {
  options.validate();
  sort_levels(levels);  // sees that there are enough
  ConstitutiveCurves result;
  result.levels = order_levels(std::move(levels));
  settle_pressures(result, options.joint_labels ? expect_labels(result.levels) : std::nullopt);
  draw_curves(result, options);
  return result;
}

}  // namespace manoscope::calibration

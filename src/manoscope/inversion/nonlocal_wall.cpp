#include "manoscope/inversion/nonlocal_wall.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <vector>

#include "manoscope/core/error.hpp"
#include "manoscope/numerics/robust.hpp"

namespace manoscope::inversion {
namespace {

/// Pressures to solve the wall at, ascending and apart, and which of them stands for each level.
struct ModelLevels {
  Array1 pressure;
  std::vector<Index> of_level;
};

ModelLevels model_levels(const Array1& estimates) {
  constexpr double kApart = 2e-4;  // of the range
  std::vector<Index> order(static_cast<std::size_t>(estimates.size()));
  for (std::size_t k = 0; k < order.size(); ++k) order[k] = static_cast<Index>(k);
  std::stable_sort(order.begin(), order.end(),
                   [&](Index a, Index b) { return estimates[a] < estimates[b]; });
  const double apart = kApart * (estimates.maxCoeff() - estimates.minCoeff());
  std::vector<double> pressures;
  ModelLevels levels;
  levels.of_level.resize(order.size());
  for (const Index k : order) {
    if (pressures.empty() || estimates[k] > pressures.back() + apart) {
      pressures.push_back(estimates[k]);
    }
    levels.of_level[static_cast<std::size_t>(k)] = static_cast<Index>(pressures.size()) - 1;
  }
  levels.pressure =
      Eigen::Map<const Array1>(pressures.data(), static_cast<Index>(pressures.size()));
  return levels;
}

}  // namespace

void ReadNonlocalOptions::validate() const {
  if (!(finest_ripple >= 0.1 && finest_ripple <= 10.0)) {
    throw InputError("--finest-ripple", fmt::format("is {}", finest_ripple),
                     "Give a number from 0.1 to 10");
  }
  if (!(largest_model_error > 0.0 && largest_model_error <= 1.0)) {
    throw InputError("--largest-model-error", fmt::format("is {}", largest_model_error),
                     "Give a number above 0, at most 1");
  }
}

void update_offset(NonlocalWall& wall, const calibration::ConstitutiveCurves& curves) {
  constexpr double kMargin = 0.5;  // widths
  const Array1& pressure = wall.uniform.pressure;
  const Array2& profiles = wall.uniform.deflection;
  const double length = wall.calibrated.wall.length.si();
  const double margin = kMargin * wall.calibrated.wall.width.si();
  const Index n = pressure.size();
  wall.offset = Array1::Zero(n);
  for (Index j = 0; j < n; ++j) {
    Index k = 0;  // the level that this state of the model stands for
    (curves.level_pressure - pressure[j]).abs().minCoeff(&k);
    const Index low = std::max<Index>(0, j - 1), high = std::min(n - 1, j + 1);
    const Profile& profile = curves.levels[static_cast<std::size_t>(k)].profile;
    std::vector<double> offsets;
    for (Index i = 0; i < profiles.cols(); ++i) {
      const double rise = profiles(high, i) - profiles(low, i);
      const bool inside = curves.x[i] > margin && curves.x[i] < length - margin;
      if (!inside || profile.flags[i] != 0 || !(rise > 0.0)) continue;
      const double compliance = rise / (pressure[high] - pressure[low]);
      offsets.push_back((profiles(j, i) - profile.zeta[i]) / compliance + curves.level_pressure[k] -
                        pressure[j]);
    }
    if (!offsets.empty()) wall.offset[j] = numerics::median(offsets);
  }
}

std::optional<NonlocalWall> make_nonlocal_wall(const calibration::ConstitutiveCurves& curves,
                                               const WallKnowledge& known,
                                               const ReadNonlocalOptions& options,
                                               const Monitor& monitor, std::string& reason) {
  options.validate();
  constexpr double kPerMisfit = 3.0, kLeastError = 0.01;
  auto calibrated = calibrate_wall(curves, known, reason);
  if (!calibrated) return std::nullopt;
  const ModelLevels levels = model_levels(curves.level_pressure);
  if (levels.pressure.size() < 3) {
    reason = "fewer than three levels";
    return std::nullopt;
  }
  NonlocalWall wall;
  try {
    wall.response =
        std::make_shared<const WallResponse>(calibrated->wall, levels.pressure, monitor);
  } catch (const InputError& error) {
    reason = fmt::format("{} {}", error.where(), error.found());
    return std::nullopt;
  }
  wall.uniform = {levels.pressure, wall.response->profiles(curves.x)};
  Array2 model(static_cast<Index>(levels.of_level.size()), curves.x.size());
  for (std::size_t k = 0; k < levels.of_level.size(); ++k) {
    model.row(static_cast<Index>(k)) = wall.uniform.deflection.row(levels.of_level[k]);
  }
  calibrated->model_error =
      std::max(kLeastError, kPerMisfit * end_misfit(curves, model, known.length, known.width));
  if (calibrated->model_error > options.largest_model_error) {
    reason = fmt::format("a uniform clamped wall is off by {:.0f} % near the ends",
                         100.0 * calibrated->model_error);
    return std::nullopt;
  }
  wall.calibrated = *calibrated;
  const Index n_nodes = wall.response->nodes().size();
  const double middle = levels.pressure[levels.pressure.size() / 2];
  wall.half_wavelength = wall.response->half_wavelength(
      wall.response->answer(Eigen::VectorXd::Constant(n_nodes, middle)).kernel, n_nodes / 2);
  update_offset(wall, curves);
  return wall;
}

}  // namespace manoscope::inversion

#include "manoscope/inversion/repeats.hpp"

#include <Eigen/LU>
#include <cmath>
#include <map>
#include <string>

namespace manoscope::inversion {
namespace {

/// Weights of the deflections in the mean pressure and in the drop.
struct Weights {
  Array1 mean, drop;  ///< (n_x) Pa/m
};

std::optional<Weights> weights_of(const std::vector<RepeatedMap>& maps, const Array1& compliance,
                                  const Stretch& stretch) {
  constexpr std::size_t kFewest = 6;
  const Array1& x = maps.front().profile->x;
  std::vector<Index> used;
  for (Index i = 0; i < x.size(); ++i) {
    bool counts = compliance[i] > 0.0 && x[i] >= stretch.start.si() && x[i] <= stretch.end.si();
    for (const RepeatedMap& map : maps) counts = counts && map.profile->flags[i] == 0;
    if (counts) used.push_back(i);
  }
  if (used.size() < kFewest) return std::nullopt;
  Weights weights{Array1::Zero(x.size()), Array1::Zero(x.size())};
  const std::size_t third = used.size() / 3;
  for (std::size_t i = 0; i < used.size(); ++i) {
    const double pressure = 1.0 / compliance[used[i]];
    weights.mean[used[i]] = pressure / static_cast<double>(used.size());
    if (i < third) weights.drop[used[i]] = pressure / static_cast<double>(third);
    if (i >= used.size() - third) weights.drop[used[i]] = -pressure / static_cast<double>(third);
  }
  return weights;
}

/// Errors of one map alone.
Uncertainty own_errors(const Profile& profile, const std::map<std::string, int>& owners) {
  Uncertainty own{profile.uncertainty.independent, {}};
  for (const ErrorMode& mode : profile.uncertainty.modes) {
    if (owners.at(mode.variable) == 1) own.modes.push_back(mode);
  }
  return own;
}

}  // namespace

std::optional<RepeatAgreement> compare_repeats(const std::vector<RepeatedMap>& maps,
                                               const Array1& compliance, const Stretch& stretch) {
  if (maps.size() < 2) return std::nullopt;
  const auto weights = weights_of(maps, compliance, stretch);
  if (!weights) return std::nullopt;
  std::map<std::string, int> owners;
  for (const RepeatedMap& map : maps) {
    for (const ErrorMode& mode : map.profile->uncertainty.modes) ++owners[mode.variable];
  }
  std::vector<Eigen::Vector2d> values;
  std::vector<Eigen::Matrix2d> inverse;
  Eigen::Matrix2d normal = Eigen::Matrix2d::Zero();
  Eigen::Vector2d right = Eigen::Vector2d::Zero();
  for (const RepeatedMap& map : maps) {
    const Array1& zeta = map.profile->zeta;
    values.emplace_back((weights->mean * zeta).sum(), (weights->drop * zeta).sum());
    const Uncertainty errors = own_errors(*map.profile, owners);
    Eigen::Matrix2d covariance;
    covariance(0, 0) =
        errors.covariance(weights->mean, weights->mean) + std::pow(map.label_uncertainty.si(), 2);
    covariance(1, 1) = errors.covariance(weights->drop, weights->drop);
    covariance(0, 1) = covariance(1, 0) = errors.covariance(weights->mean, weights->drop);
    if (!(covariance.determinant() > 0.0)) return std::nullopt;
    inverse.emplace_back(covariance.inverse());
    normal += inverse.back();
    right += inverse.back() * values.back();
  }
  const Eigen::Vector2d mean = normal.inverse() * right;
  const auto n = static_cast<double>(maps.size());
  double sum = 0.0, squares = 0.0;
  RepeatAgreement agreement;
  for (std::size_t i = 0; i < values.size(); ++i) {
    const Eigen::Vector2d off = values[i] - mean;
    agreement.chi_square += off.dot(inverse[i] * off);
    sum += off[0];
    squares += off[0] * off[0];
  }
  agreement.dof = 2.0 * (n - 1.0);
  agreement.scatter = std::sqrt(std::max(0.0, squares - sum * sum / n) / (n - 1.0));
  return agreement;
}

}  // namespace manoscope::inversion

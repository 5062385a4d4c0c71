#include "manoscope/calibration/joint_labels.hpp"

#include <Eigen/Cholesky>
#include <Eigen/QR>
#include <algorithm>
#include <cmath>
#include <limits>
#include <map>
#include <string>

#include "manoscope/calibration/pressure_scale.hpp"
#include "manoscope/calibration/snap.hpp"
#include "manoscope/numerics/shape_spline.hpp"

namespace manoscope::calibration {
namespace {

/// The state of the wall at every level, and its standard uncertainty.
struct States {
  Array1 value, sigma;  ///< (n) m
  Array1 weight;        ///< (n_x) of the stations
};

/// Deflections projected on the difference between the highest and the lowest level, over the
/// stations that count in all; none if there are too few.
std::optional<States> project(const std::vector<Level>& levels) {
  constexpr Index kFewest = 5;
  const Index n_x = levels.front().profile.x.size();
  Array1 weight = levels.back().profile.zeta - levels.front().profile.zeta;
  for (const Level& level : levels) {
    for (Index ix = 0; ix < n_x; ++ix) {
      if (level.profile.flags[ix] != 0) weight[ix] = 0.0;
    }
  }
  const double size = weight.abs().sum();
  if ((weight != 0.0).count() < kFewest || size == 0.0) return std::nullopt;
  weight /= size;
  // An error that all maps have in common moves no level against the others.
  std::map<std::string, int> seen;
  for (const Level& level : levels) {
    for (const ErrorMode& mode : level.profile.uncertainty.modes) ++seen[mode.variable];
  }
  const auto n = static_cast<Index>(levels.size());
  States states{Array1(n), Array1(n), weight};
  for (Index k = 0; k < n; ++k) {
    const Profile& profile = levels[static_cast<std::size_t>(k)].profile;
    states.value[k] = (weight * profile.zeta).sum();
    double variance = (weight * profile.uncertainty.independent).square().sum();
    for (const ErrorMode& mode : profile.uncertainty.modes) {
      if (seen[mode.variable] == 1) variance += std::pow((weight * mode.effect).sum(), 2);
    }
    states.sigma[k] = std::sqrt(variance);
  }
  return states;
}

/// The pressures at which a model of the wall has the states; none if its own states do not rise.
///
/// In the coordinate in which its curve is nearly straight, a cubic between its pressures and a
/// straight line beyond them.
std::optional<Array1> model_pressures(const WallCurves& wall, const States& states) {
  const Index n = wall.pressure.size();
  const double range = wall.pressure[n - 1] - wall.pressure[0];
  const Array1 own = (wall.deflection.matrix() * states.weight.matrix()).array();
  if (n < 3 || !(own.tail(n - 1) > own.head(n - 1)).all()) return std::nullopt;
  // The scale at which the middle of the range lies on the straight line between its ends.
  double best = std::numeric_limits<double>::infinity(), unit = range;
  for (double candidate = 1e-4 * range; candidate < 1e3 * range; candidate *= 1.3) {
    const PressureScale scale(candidate);
    const double low = scale.coordinate(wall.pressure[0]);
    const double high = scale.coordinate(wall.pressure[n - 1]);
    double off = 0.0;
    for (Index k = 1; k + 1 < n; ++k) {
      const double share = (own[k] - own[0]) / (own[n - 1] - own[0]);
      off += std::pow((scale.coordinate(wall.pressure[k]) - low) / (high - low) - share, 2);
    }
    if (off < best) {
      best = off;
      unit = candidate;
    }
  }
  const PressureScale scale(unit);
  std::vector<double> at(own.begin(), own.end()), u;
  for (const double pressure : wall.pressure) u.push_back(scale.coordinate(pressure));
  const numerics::ShapeSpline spline(at, u);
  Array1 result(states.value.size());
  for (Index k = 0; k < result.size(); ++k) {
    const double inside = std::clamp(states.value[k], own[0], own[n - 1]);
    result[k] = scale.pressure(spline.value(inside) +
                               spline.derivative(inside) * (states.value[k] - inside));
  }
  return result;
}

/// dp/ds at every level, by the line through it and its two neighbours in s; through more of them
/// where these are repeats, whose states differ by noise alone.
Array1 slopes(const States& states, const Array1& label) {
  const Array1& state = states.value;
  const Index n = state.size();
  constexpr double kClear = 20.0;  // standard uncertainties
  const double least = kClear * states.sigma.maxCoeff();
  std::vector<Index> order(static_cast<std::size_t>(n));
  for (Index k = 0; k < n; ++k) order[static_cast<std::size_t>(k)] = k;
  std::stable_sort(order.begin(), order.end(),
                   [&](Index a, Index b) { return state[a] < state[b]; });
  const auto at = [&](Index j) { return order[static_cast<std::size_t>(j)]; };
  Array1 result = Array1::Zero(n);
  for (Index i = 0; i < n; ++i) {
    Index first = std::max<Index>(0, i - 1), last = std::min(n - 1, i + 1);
    while (state[at(last)] - state[at(first)] < least && (first > 0 || last < n - 1)) {
      first = std::max<Index>(0, first - 1);
      last = std::min(n - 1, last + 1);
    }
    double count = 0.0, ss = 0.0, sp = 0.0, sss = 0.0, ssp = 0.0;
    for (Index j = first; j <= last; ++j) {
      const double s = state[at(j)] - state[at(i)], p = label[at(j)] - label[at(i)];
      count += 1.0;
      ss += s;
      sp += p;
      sss += s * s;
      ssp += s * p;
    }
    const double determinant = count * sss - ss * ss;
    if (determinant > 0.0) result[at(i)] = (count * ssp - ss * sp) / determinant;
  }
  return result;
}

/// Labels that were read, or the true pressures of levels that are yet to be read.
enum class Labels { read, true_pressures };

/// Labels given the size of the spline's rest.
struct Estimate {
  double log_likelihood;
  Array1 pressure;
  Matrix response;
  Matrix covariance;
  double worst_pull;  ///< of a label against what the others say
};

class LabelModel {
 public:
  LabelModel(const States& states, const Array1& label, const Array1& sigma, Labels kind,
             const std::optional<Array1>& model)
      : label_(label), kind_(kind), scale_(label.maxCoeff() - label.minCoeff()) {
    const Index n = label.size();
    const double reach = states.value.abs().maxCoeff();
    const Array1 q = states.value / reach;
    const double low = states.value.minCoeff();
    const Array1 u = (states.value - low) / (states.value.maxCoeff() - low);
    Matrix law(n, model ? 4 : 3);
    law.col(0) = Array1::Ones(n);
    law.col(1) = q;
    law.col(2) = q.cube();
    if (model) law.col(3) = *model / scale_;
    // Terms that others make up (a model that is such a law itself) go.
    Eigen::ColPivHouseholderQR<Matrix> factors(law);
    factors.setThreshold(1e-6);
    law_ = scale_ * Matrix(factors.householderQ()).leftCols(factors.rank());
    kernel_.resize(n, n);
    for (Index i = 0; i < n; ++i) {
      for (Index j = 0; j < n; ++j) {
        const double a = std::min(u[i], u[j]), b = std::max(u[i], u[j]);
        kernel_(i, j) = a * a * (0.5 * b - a / 6.0);
      }
    }
    label_variance_ = sigma.square();
    state_variance_ = (slopes(states, label) * states.sigma).square();
    // Exact labels and states still leave a covariance that can be inverted.
    constexpr double kFloor = 1e-3;
    floor_ = std::pow(kFloor * std::sqrt(label_variance_.maxCoeff()), 2);
  }

  Estimate estimate(double log_size) const {
    const Index n = label_.size();
    Matrix covariance = std::pow(scale_ * std::exp(log_size), 2) * kernel_;
    covariance.diagonal() += (label_variance_ + state_variance_ + floor_).matrix();
    const Eigen::LLT<Matrix> factors(covariance);
    const Matrix inverse = factors.solve(Matrix::Identity(n, n));
    const Matrix inverse_law = inverse * law_;
    const Eigen::LLT<Matrix> normal(Matrix(law_.transpose() * inverse_law));
    Estimate result;
    result.log_likelihood = -std::numeric_limits<double>::infinity();
    if (factors.info() != Eigen::Success || normal.info() != Eigen::Success) return result;
    // What is left of the labels beyond the law, weighted.
    const Matrix projector = inverse - inverse_law * normal.solve(inverse_law.transpose());
    const Eigen::VectorXd weighted = projector * label_.matrix();
    const auto log_determinant = [](const Eigen::LLT<Matrix>& of) {
      return 2.0 * Matrix(of.matrixL()).diagonal().array().log().sum();
    };
    double square = label_.matrix().dot(weighted);
    if (kind_ == Labels::true_pressures) {
      square += (projector.diagonal().array() * (label_variance_ + state_variance_)).sum();
    }
    result.log_likelihood = -0.5 * (square + log_determinant(factors) + log_determinant(normal));
    const auto variance = label_variance_.matrix().asDiagonal();
    result.response = Matrix::Identity(n, n) - variance * projector;
    result.pressure = label_ - label_variance_ * weighted.array();
    result.covariance = Matrix(variance) - variance * projector * variance;
    result.worst_pull =
        (weighted.array() / projector.diagonal().array().max(1e-300).sqrt()).abs().maxCoeff();
    return result;
  }

  /// Covariance of what one size of the rest makes of the labels beyond the mean over all: of their
  /// values, and before they are read of their errors.
  Matrix spread(const Estimate& one, const JointLabels& mean) const {
    const Eigen::VectorXd off = (one.pressure - mean.pressure).matrix();
    Matrix covariance = off * off.transpose();
    if (kind_ == Labels::true_pressures) {
      const Matrix beyond = one.response - mean.response;
      covariance += beyond * label_variance_.matrix().asDiagonal() * beyond.transpose();
    }
    return covariance;
  }

 private:
  Array1 label_;
  Labels kind_;
  double scale_, floor_ = 0.0;
  Matrix law_, kernel_;
  Array1 label_variance_, state_variance_;
};

/// Estimates for sizes of the rest in equal ratios, and how likely each is.
struct Sizes {
  std::vector<Estimate> estimates;
  std::vector<double> weight;  ///< sum 1; of estimates[i], whose size is e times that of its weight
};

/// @param step  from size to size, in their logarithm; 1 is a whole number of steps.
Sizes try_sizes(const LabelModel& model, double step) {
  constexpr double kSmallest = -14.0, kLargest = 3.0;  // log of the rest's size
  // A size e times that of the likelihood: for one given wall the most likely smoothing is biased
  // by up to 0.7 of its standard uncertainty, this one by up to 0.5.
  const auto looser = static_cast<std::size_t>(std::lround(1.0 / step));
  std::vector<Estimate> estimates;
  double best = -std::numeric_limits<double>::infinity();
  for (double log_size = kSmallest; log_size <= kLargest; log_size += step) {
    estimates.push_back(model.estimate(log_size));
    best = std::max(best, estimates.back().log_likelihood);
  }
  Sizes sizes;
  if (!std::isfinite(best)) return sizes;
  double total = 0.0;
  for (std::size_t i = 0; i + looser < estimates.size(); ++i) {
    const double weight = std::exp(estimates[i].log_likelihood - best);
    Estimate& estimate = estimates[i + looser];
    if (weight == 0.0 || estimate.pressure.size() == 0) continue;
    total += weight;
    sizes.weight.push_back(weight);
    sizes.estimates.push_back(std::move(estimate));
  }
  for (double& weight : sizes.weight) weight /= total;
  return sizes;
}

/// Of levels on one branch of the wall's states.
std::optional<JointLabels> settle(const std::vector<Level>& levels, Labels kind,
                                  const WallCurves* wall) {
  constexpr Index kFewest = 6;
  constexpr double kWorstPull = 4.5;
  const auto n = static_cast<Index>(levels.size());
  Array1 label(n), sigma(n);
  for (Index k = 0; k < n; ++k) {
    label[k] = levels[static_cast<std::size_t>(k)].pressure.si();
    sigma[k] = levels[static_cast<std::size_t>(k)].uncertainty.si();
  }
  if ((sigma > 0.0).count() < kFewest) return std::nullopt;
  const auto states = project(levels);
  if (!states || !(states->value.maxCoeff() > states->value.minCoeff())) return std::nullopt;

  const LabelModel model(*states, label, sigma, kind,
                         wall != nullptr ? model_pressures(*wall, *states) : std::nullopt);
  // Expected likelihoods are smoother than that of one set of labels, and asked for by the
  // thousand.
  constexpr double kStep = 0.25, kExpectedStep = 0.5;
  const Sizes sizes = try_sizes(model, kind == Labels::read ? kStep : kExpectedStep);
  if (sizes.weight.empty()) return std::nullopt;
  JointLabels joint{Array1::Zero(n), Matrix::Zero(n, n), Matrix::Zero(n, n)};
  double worst = 0.0;
  for (std::size_t i = 0; i < sizes.weight.size(); ++i) {
    joint.pressure += sizes.weight[i] * sizes.estimates[i].pressure;
    joint.response += sizes.weight[i] * sizes.estimates[i].response;
    worst += sizes.weight[i] * sizes.estimates[i].worst_pull;
  }
  if (kind == Labels::read && !(worst <= kWorstPull)) return std::nullopt;
  Matrix covariance = Matrix::Zero(n, n);
  for (std::size_t i = 0; i < sizes.weight.size(); ++i) {
    const Estimate& estimate = sizes.estimates[i];
    covariance += sizes.weight[i] * (estimate.covariance + model.spread(estimate, joint));
  }
  // Exact labels leave zero rows: the floor keeps the factor's pivots above round-off.
  covariance.diagonal().array() += 1e-12 * sigma.square().maxCoeff();
  joint.root = covariance.llt().matrixL();
  return joint;
}

/// The same of a wall that may snap through: levels before the jump keep their labels.
std::optional<JointLabels> settle_behind_snap(const std::vector<Level>& levels, Labels kind,
                                              const WallCurves* wall) {
  const Index first = level_after_snap(levels).value_or(0);
  auto branch = settle({levels.begin() + first, levels.end()}, kind, wall);
  if (!branch || first == 0) return branch;
  const auto n = static_cast<Index>(levels.size()), n_branch = n - first;
  JointLabels joint{Array1(n), Matrix::Identity(n, n), Matrix::Zero(n, n)};
  for (Index k = 0; k < first; ++k) {
    joint.pressure[k] = levels[static_cast<std::size_t>(k)].pressure.si();
    joint.root(k, k) = levels[static_cast<std::size_t>(k)].uncertainty.si();
  }
  joint.pressure.tail(n_branch) = branch->pressure;
  joint.response.bottomRightCorner(n_branch, n_branch) = branch->response;
  joint.root.bottomRightCorner(n_branch, n_branch) = branch->root;
  return joint;
}

}  // namespace

std::optional<JointLabels> estimate_labels(const std::vector<Level>& levels,
                                           const WallCurves* wall) {
  return settle_behind_snap(levels, Labels::read, wall);
}

std::optional<JointLabels> expect_labels(const std::vector<Level>& levels) {
  return settle_behind_snap(levels, Labels::true_pressures, nullptr);
}

}  // namespace manoscope::calibration

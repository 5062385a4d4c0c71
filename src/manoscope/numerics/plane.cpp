#include "manoscope/numerics/plane.hpp"

#include <Eigen/Cholesky>
#include <Eigen/LU>
#include <algorithm>
#include <cmath>

#include "manoscope/core/error.hpp"
#include "manoscope/core/index.hpp"
#include "manoscope/numerics/robust.hpp"

namespace manoscope::numerics {
namespace {

double residual(const PlanePoint& point, const Eigen::Vector3d& c) {
  return point.v - (c[0] + c[1] * point.a + c[2] * point.b);
}

struct NormalEquations {
  Eigen::Matrix3d matrix = Eigen::Matrix3d::Zero();
  Eigen::Vector3d right = Eigen::Vector3d::Zero();

  void add(const PlanePoint& point, double weight) {
    const Eigen::Vector3d row(1.0, point.a, point.b);
    matrix.noalias() += weight * row * row.transpose();
    right += weight * point.v * row;
  }
  /// Relative size of the smallest pivot below which the points count as collinear.
  bool determined() const {
    const Eigen::Vector3d pivots = matrix.ldlt().vectorD();
    return pivots.minCoeff() > 1e-12 * pivots.maxCoeff();
  }
};

Eigen::Vector3d least_absolute(const std::vector<PlanePoint>& points) {
  constexpr std::size_t kMost = 4000;
  constexpr int kSteps = 30;
  const std::size_t stride = points.size() / kMost + 1;
  Eigen::Vector3d c = Eigen::Vector3d::Zero();
  double floor = 0.0;
  for (int step = 0; step < kSteps; ++step) {
    NormalEquations sums;
    std::vector<double> sizes;
    for (std::size_t i = 0; i < points.size(); i += stride) {
      const double size = std::abs(residual(points[i], c));
      sizes.push_back(size);
      sums.add(points[i], step == 0 ? 1.0 : 1.0 / std::max(size, floor));
    }
    if (!sums.determined()) break;
    c = sums.matrix.ldlt().solve(sums.right);
    // Weights stay bounded: no residual counts as smaller than a hundredth of the median.
    floor = std::max(1e-2 * median(sizes), 1e-300);
  }
  return c;
}

}  // namespace

std::optional<PlaneFit> fit_plane(const std::vector<PlanePoint>& points) {
  MANO_ASSERT(points.size() >= 3);
  NormalEquations geometry;
  for (const PlanePoint& point : points) geometry.add(point, 1.0);
  if (!geometry.determined()) return std::nullopt;

  constexpr double kTukey = 4.685;
  constexpr int kSteps = 20;
  PlaneFit fit;
  fit.coefficient = least_absolute(points);
  std::vector<double> residuals(points.size());
  for (int step = 0; step < kSteps; ++step) {
    for (std::size_t i = 0; i < points.size(); ++i) {
      residuals[i] = residual(points[i], fit.coefficient);
    }
    fit.sigma = mad_sigma(residuals, 0.0);
    const double bound = kTukey * std::max(fit.sigma, 1e-300);
    NormalEquations sums;
    Index inliers = 0;
    for (std::size_t i = 0; i < points.size(); ++i) {
      const double ratio = residuals[i] / bound;
      // An exact fit has sigma = 0: then only exact points keep their weight.
      if (std::abs(ratio) > 1.0) continue;
      ++inliers;
      sums.add(points[i], (1.0 - ratio * ratio) * (1.0 - ratio * ratio));
    }
    fit.inlier_fraction = static_cast<double>(inliers) / static_cast<double>(points.size());
    if (!sums.determined()) break;
    const Eigen::Vector3d next = sums.matrix.ldlt().solve(sums.right);
    const double change = (next - fit.coefficient).cwiseAbs().maxCoeff();
    fit.coefficient = next;
    fit.covariance = fit.sigma * fit.sigma * sums.matrix.inverse();
    if (change <= 1e-6 * fit.sigma / std::sqrt(static_cast<double>(points.size()))) break;
  }
  return fit;
}

}  // namespace manoscope::numerics

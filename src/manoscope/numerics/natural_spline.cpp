#include "manoscope/numerics/natural_spline.hpp"

#include <Eigen/Cholesky>
#include <Eigen/LU>
#include <algorithm>
#include <utility>

#include "manoscope/core/error.hpp"

namespace manoscope::numerics {
namespace {

/// What a unit second derivative at one end of an interval adds, over h^2/6, at a share of the way
/// from the other; beyond that other end the spline is straight.
double bend(double share) { return share < 0.0 ? -share : share * share * share - share; }

}  // namespace

NaturalSpline::NaturalSpline(Array1 nodes) : nodes_(std::move(nodes)) {
  const Index n = nodes_.size();
  MANO_ASSERT(n >= 4);
  Matrix difference = Matrix::Zero(n - 2, n);  // second differences
  mass_ = Matrix::Zero(n - 2, n - 2);
  for (Index j = 1; j < n - 1; ++j) {
    const double before = nodes_[j] - nodes_[j - 1], after = nodes_[j + 1] - nodes_[j];
    MANO_ASSERT(before > 0.0 && after > 0.0);
    difference(j - 1, j - 1) = 1.0 / before;
    difference(j - 1, j) = -1.0 / before - 1.0 / after;
    difference(j - 1, j + 1) = 1.0 / after;
    mass_(j - 1, j - 1) = (before + after) / 3.0;
    if (j < n - 2) mass_(j - 1, j) = mass_(j, j - 1) = after / 6.0;
  }
  curvature_ = mass_.llt().solve(difference);
  from_coefficients_ = Matrix::Zero(n, n);
  from_coefficients_.col(0).setOnes();
  from_coefficients_.col(1) =
      2.0 * (nodes_ - nodes_[0]).matrix() / (nodes_[n - 1] - nodes_[0]) - Matrix::Ones(n, 1);
  from_coefficients_.block(1, 2, n - 2, n - 2) =
      difference.middleCols(1, n - 2).partialPivLu().solve(mass_);
}

Matrix NaturalSpline::sampling(const Array1& positions) const {
  const Index n = nodes_.size();
  Matrix result = Matrix::Zero(positions.size(), n);
  for (Index i = 0; i < positions.size(); ++i) {
    const Index above =
        std::upper_bound(nodes_.begin(), nodes_.end(), positions[i]) - nodes_.begin();
    const Index j = std::clamp<Index>(above, 1, n - 1);
    const double h = nodes_[j] - nodes_[j - 1];
    const double right = (positions[i] - nodes_[j - 1]) / h, left = 1.0 - right;
    result(i, j - 1) = left;
    result(i, j) = right;
    const double scale = h * h / 6.0;
    if (j >= 2) result.row(i) += scale * bend(left) * curvature_.row(j - 2);
    if (j <= n - 2) result.row(i) += scale * bend(right) * curvature_.row(j - 1);
  }
  return result;
}

Matrix NaturalSpline::roughness(const Array1& stiffness) const {
  const Index n = nodes_.size();
  MANO_ASSERT(stiffness.size() == n - 2);
  const auto root = stiffness.sqrt().matrix().asDiagonal();
  Matrix result = Matrix::Zero(n, n);
  result.bottomRightCorner(n - 2, n - 2) = root * mass_ * root;
  return result;
}

}  // namespace manoscope::numerics

#pragma once

#include <Eigen/Core>
#include <optional>
#include <vector>

namespace manoscope::numerics {

/// Plane v = c0 + c1 a + c2 b through scattered points, robust against outliers.
struct PlaneFit {
  Eigen::Vector3d coefficient = Eigen::Vector3d::Zero();  ///< c0, c1, c2
  /// Of the coefficients, for white errors of size `sigma`.
  Eigen::Matrix3d covariance = Eigen::Matrix3d::Zero();
  double sigma = 0.0;            ///< robust standard deviation of the residuals
  double inlier_fraction = 0.0;  ///< share of points within the rejection bound
};

struct PlanePoint {
  double a, b, v;
};

/// Iteratively reweighted least squares, its steps stretched by the share that they fall short of
/// Newton's, with Tukey's biweight (c = 4.685: 95 % efficient on normal
/// errors; Huber & Ronchetti, Robust Statistics, 2009), scale from the median absolute deviation,
/// started from a least-absolute-deviation fit of at most 4000 evenly spaced points.
///
/// Holds with up to about 30 % of one-sided outliers. `a` and `b` should be of order 1.
/// @throws InternalError for fewer than 3 points.
/// @return nullopt if the points lie on one line, so that no plane is determined.
std::optional<PlaneFit> fit_plane(const std::vector<PlanePoint>& points);

}  // namespace manoscope::numerics

#include "manoscope/validation/drop_fit.hpp"

#include <fmt/format.h>

#include <Eigen/LU>
#include <algorithm>
#include <cmath>

#include "manoscope/core/error.hpp"
#include "manoscope/numerics/chi_square.hpp"

namespace manoscope::validation {
namespace {

constexpr const char* kWhere = "fit of pressure drop against flow rate";

/// Largest flow rate, after a check of all.
double checked_scale(const std::vector<DropPoint>& points) {
  double least = 0.0, largest = 0.0;
  for (const DropPoint& point : points) {
    const double Q = point.flow_rate.si();
    if (!(Q > 0.0)) {
      throw InputError(kWhere,
                       fmt::format("a point at {:g} mL/min", point.flow_rate.in(mL_per_min)),
                       "Give positive flow rates");
    }
    least = largest == 0.0 ? Q : std::min(least, Q);
    largest = std::max(largest, Q);
  }
  if (largest - least > 1e-6 * largest) return largest;
  throw InputError(kWhere, fmt::format("{} points at one flow rate", points.size()),
                   "Give two flow rates or more");
}

bool weighted(const std::vector<DropPoint>& points) {
  return std::all_of(points.begin(), points.end(),
                     [](const DropPoint& point) { return point.uncertainty.si() > 0.0; });
}

/// Two parameters by linear least squares; rows are divided by their uncertainties already.
struct TwoParameters {
  Eigen::Vector2d value;
  Eigen::Matrix2d covariance;
  ChiSquare fit;
};

TwoParameters solve(const Matrix& rows, const Eigen::VectorXd& right, bool has_weights) {
  TwoParameters result;
  const Eigen::Matrix2d normal = rows.transpose() * rows;
  result.covariance = normal.inverse();
  result.value = result.covariance * (rows.transpose() * right);
  const double squares = (right - rows * result.value).squaredNorm();
  result.fit.dof = static_cast<double>(rows.rows() - 2);
  if (has_weights) {
    result.fit.value = squares;
    if (rows.rows() > 2) result.fit.tail = numerics::chi_square_tail(squares, result.fit.dof);
  } else if (rows.rows() > 2) {
    result.covariance *= squares / result.fit.dof;
  } else {
    result.covariance.setZero();
  }
  return result;
}

}  // namespace

QuadraticFit fit_quadratic(const std::vector<DropPoint>& points) {
  const double scale = checked_scale(points);
  const bool has_weights = weighted(points);
  const bool relative = std::none_of(points.begin(), points.end(), [](const DropPoint& point) {
    return point.drop == Pressure{};
  });
  const auto n = static_cast<Index>(points.size());
  Matrix rows(n, 2);
  Eigen::VectorXd right(n);
  for (Index i = 0; i < n; ++i) {
    const DropPoint& point = points[static_cast<std::size_t>(i)];
    const double weight = has_weights ? 1.0 / point.uncertainty.si()
                                      : (relative ? 1.0 / std::abs(point.drop.si()) : 1.0);
    const double q = point.flow_rate.si() / scale;
    rows(i, 0) = weight * q;
    rows(i, 1) = weight * q * q;
    right(i) = weight * point.drop.si();
  }
  const TwoParameters found = solve(rows, right, has_weights);
  QuadraticFit fit;
  fit.linear = found.value[0] / scale;
  fit.quadratic = found.value[1] / (scale * scale);
  fit.linear_uncertainty = std::sqrt(found.covariance(0, 0)) / scale;
  fit.quadratic_uncertainty = std::sqrt(found.covariance(1, 1)) / (scale * scale);
  fit.fit = found.fit;
  return fit;
}

PowerFit fit_power(const std::vector<DropPoint>& points) {
  const double scale = checked_scale(points);
  const bool has_weights = weighted(points);
  const auto n = static_cast<Index>(points.size());
  Matrix rows(n, 2);
  Eigen::VectorXd right(n);
  for (Index i = 0; i < n; ++i) {
    const DropPoint& point = points[static_cast<std::size_t>(i)];
    const double drop = point.drop.si();
    if (!(drop > 0.0)) {
      throw InputError(kWhere, fmt::format("a drop of {:g} Pa has no logarithm", drop),
                       "Leave out points without a positive drop, or fit the quadratic");
    }
    const double weight = has_weights ? drop / point.uncertainty.si() : 1.0;
    rows(i, 0) = weight;
    rows(i, 1) = weight * std::log(point.flow_rate.si() / scale);
    right(i) = weight * std::log(drop);
  }
  const TwoParameters found = solve(rows, right, has_weights);
  PowerFit fit;
  fit.exponent = found.value[1];
  fit.exponent_uncertainty = std::sqrt(found.covariance(1, 1));
  fit.at_unit = std::exp(found.value[0] - fit.exponent * std::log(scale));
  fit.fit = found.fit;
  return fit;
}

}  // namespace manoscope::validation

#include "manoscope/numerics/smoothing_spline.hpp"

#include <Eigen/Cholesky>
#include <algorithm>
#include <cmath>
#include <numbers>
#include <utility>

#include "manoscope/core/error.hpp"

namespace manoscope::numerics {
namespace {

/// The weight grows by a factor of e from one try to the next, the wavelength by e^(1/4).
constexpr int kSteps = 40;

Penalty penalty_of(const NaturalSpline& spline, const Array1& bend) {
  const Index inner = spline.nodes().size() - 2;
  MANO_ASSERT(bend.size() == inner && bend.minCoeff() > 0.0);
  Penalty penalty{spline.roughness(bend.square().inverse()), 0.0, inner};
  const Eigen::LLT<Matrix> factors(Matrix(penalty.matrix.bottomRightCorner(inner, inner)));
  penalty.log_determinant = 2.0 * Matrix(factors.matrixL()).diagonal().array().log().sum();
  return penalty;
}

/// What the data tell of a length of the curve: 1/sigma^2 a unit of length, of their median.
double information(const NoisyValues& data) {
  std::vector<double> squares(data.sigma.begin(), data.sigma.end());
  const auto middle = squares.begin() + static_cast<Index>(squares.size() / 2);
  std::nth_element(squares.begin(), middle, squares.end());
  const Index n = data.x.size();
  return static_cast<double>(n) / (*middle * *middle * (data.x[n - 1] - data.x[0]));
}

}  // namespace

SmoothingSpline::SmoothingSpline(NoisyValues data, const Array1& knots,
                                 const std::vector<Array1>& bends, double finest_ripple)
    : data_(std::move(data)), spline_(knots), to_values_(spline_.from_coefficients()) {
  MANO_ASSERT(!bends.empty() && finest_ripple > 0.0 && data_.x.size() >= 4);
  MANO_ASSERT(data_.y.size() == data_.x.size() && data_.sigma.size() == data_.x.size());
  MANO_ASSERT(data_.sigma.minCoeff() > 0.0);
  if (data_.window.size() == 0) {
    model_ = sampling(data_.x);
  } else {  // by Gauss' rule of two points, exact for cubics
    const Array1 reach = data_.window / (2.0 * std::numbers::sqrt3);
    model_ = 0.5 * (sampling(data_.x - reach) + sampling(data_.x + reach));
  }
  const Array1 weight = data_.sigma.square().inverse();
  const Matrix weighted = weight.matrix().asDiagonal() * model_;
  const NormalEquations equations{model_.transpose() * weighted,
                                  weighted.transpose() * data_.y.matrix(),
                                  (weight * data_.y.square()).sum()};
  std::vector<Penalty> penalties;
  for (const Array1& bend : bends) penalties.push_back(penalty_of(spline_, bend));
  // Where c = 1: information (g - y) + weight g'''' = 0, so that half is left at
  // k^4 = information / weight.
  constexpr double kTurn = 2.0 * std::numbers::pi;
  const double known = information(data_);
  fit_ =
      fit_penalised(equations, penalties, {known * std::pow(finest_ripple / kTurn, 4.0), kSteps});
  half_wavelength_ = kTurn * std::pow(fit_.weight / known, 0.25);
  // The difference of large sums that fit_penalised() forms is lost in round-off for small misfits.
  fit_.misfit =
      ((model_ * fit_.coefficients).array() - data_.y).square().cwiseProduct(weight).sum();
}

Array1 SmoothingSpline::value(const Array1& x) const {
  return (sampling(x) * fit_.coefficients).array();
}

Matrix SmoothingSpline::weights(const Array1& x) const {
  const Array1 weight = data_.sigma.square().inverse();
  return sampling(x) * fit_.covariance * model_.transpose() * weight.matrix().asDiagonal();
}

Array1 SmoothingSpline::standard(const Array1& x) const {
  const Matrix at = sampling(x);
  return (at * fit_.covariance).cwiseProduct(at).rowwise().sum().array().max(0.0).sqrt();
}

}  // namespace manoscope::numerics

#include "manoscope/numerics/propagation.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <boost/math/distributions/normal.hpp>
#include <boost/math/distributions/students_t.hpp>
#include <cmath>
#include <limits>
#include <string>
#include <vector>

#include "manoscope/core/error.hpp"

namespace manoscope::numerics {
namespace {

constexpr const char* kWhere = "propagation of uncertainty";
constexpr double kInfinity = std::numeric_limits<double>::infinity();

[[noreturn]] void refuse(const std::string& found, const char* mend) {
  throw InputError(kWhere, found, mend);
}

/// Step by which an input is shifted, `part` of its standard uncertainty.
double step(const Estimates& inputs, Index j, double part) {
  const double sigma = std::sqrt(inputs.covariance(j, j));
  // The sensitivity to an exactly known input has no effect; it is reported all the same.
  return sigma > 0.0 ? part * sigma : 1e-3 * std::max(std::abs(inputs.value(j)), 1e-3);
}

Eigen::VectorXd shifted(const Model& model, const Eigen::VectorXd& at, Index j, double by) {
  Eigen::VectorXd x = at;
  x(j) += by;
  return model(x);
}

Matrix differences(const Model& model, const Estimates& inputs, Index n_outputs) {
  const Index n = inputs.value.size();
  Matrix result(n_outputs, n);
  for (Index j = 0; j < n; ++j) {
    const auto slope = [&](double h) -> Eigen::VectorXd {
      // The distance that the two points really have after rounding.
      const double up = inputs.value(j) + h, down = inputs.value(j) - h;
      return (shifted(model, inputs.value, j, up - inputs.value(j)) -
              shifted(model, inputs.value, j, down - inputs.value(j))) /
             (up - down);
    };
    const double h = step(inputs, j, 1e-2);
    result.col(j) = (4.0 * slope(0.5 * h) - slope(h)) / 3.0;  // Richardson: error of order h^4
  }
  return result;
}

/// Groups of inputs joined by covariances: the number of its group for each input.
std::vector<Index> groups_of(const Matrix& covariance) {
  const Index n = covariance.rows();
  std::vector<Index> group(static_cast<std::size_t>(n));
  for (Index i = 0; i < n; ++i) group[static_cast<std::size_t>(i)] = i;
  for (Index i = 0; i < n; ++i) {
    for (Index j = 0; j < i; ++j) {
      const Index from = group[static_cast<std::size_t>(i)],
                  to = group[static_cast<std::size_t>(j)];
      if (covariance(i, j) != 0.0 && from != to) std::replace(group.begin(), group.end(), from, to);
    }
  }
  return group;
}

/// Welch-Satterthwaite, over groups of inputs.
double effective_degrees_of_freedom(const Eigen::RowVectorXd& sensitivity, const Estimates& inputs,
                                    double variance) {
  const Index n = inputs.value.size();
  if (inputs.degrees_of_freedom.size() == 0 || variance == 0.0) return kInfinity;
  const std::vector<Index> group = groups_of(inputs.covariance);
  double sum = 0.0;
  for (Index g = 0; g < n; ++g) {
    Eigen::RowVectorXd part = Eigen::RowVectorXd::Zero(n);
    double nu = kInfinity;
    for (Index j = 0; j < n; ++j) {
      if (group[static_cast<std::size_t>(j)] != g) continue;
      part(j) = sensitivity(j);
      nu = inputs.degrees_of_freedom(j);
    }
    const double share = part.dot(part * inputs.covariance) / variance;
    sum += share * share / nu;
  }
  return sum > 0.0 ? 1.0 / sum : kInfinity;
}

/// sum_ij (f_ij^2/2 + f_i f_ijj) u_i^2 u_j^2 by differences.
Eigen::VectorXd second_order_variance(const Model& model, const Estimates& inputs,
                                      const Matrix& sensitivity) {
  // Short against a standard uncertainty, and long enough for third differences.
  constexpr double kStep = 0.05;
  const Index n = inputs.value.size();
  const Eigen::VectorXd sigma = inputs.covariance.diagonal().cwiseSqrt();
  const auto at = [&](Index i, double a, Index j, double b) -> Eigen::VectorXd {
    Eigen::VectorXd x = inputs.value;
    x(i) += a * kStep * sigma(i);
    x(j) += b * kStep * sigma(j);
    return model(x);
  };
  const Eigen::VectorXd centre = model(inputs.value);
  Eigen::VectorXd variance = Eigen::VectorXd::Zero(centre.size());
  for (Index i = 0; i < n; ++i) {
    if (sigma(i) == 0.0) continue;
    const Eigen::ArrayXd first = sensitivity.col(i).array() * sigma(i);
    for (Index j = 0; j < n; ++j) {
      if (sigma(j) == 0.0) continue;
      Eigen::ArrayXd second, third;  // f_ij u_i u_j and f_ijj u_i u_j^2
      if (i == j) {
        const Eigen::ArrayXd up = at(i, 1.0, i, 0.0), down = at(i, -1.0, i, 0.0);
        second = up - 2.0 * centre.array() + down;
        third = 0.5 * (at(i, 2.0, i, 0.0) - at(i, -2.0, i, 0.0)).array() - (up - down);
      } else {
        const Eigen::ArrayXd uu = at(i, 1.0, j, 1.0), ud = at(i, 1.0, j, -1.0),
                             du = at(i, -1.0, j, 1.0), dd = at(i, -1.0, j, -1.0);
        second = 0.25 * (uu - ud - du + dd);
        const Eigen::ArrayXd along = (at(i, 1.0, i, 0.0) - at(i, -1.0, i, 0.0)).array();
        third = 0.5 * ((uu - du) - 2.0 * along + (ud - dd));
      }
      second /= kStep * kStep;
      third /= kStep * kStep * kStep;
      variance.array() += 0.5 * second.square() + first * third;
    }
  }
  return variance;
}

}  // namespace

Estimates Estimates::independent(const Eigen::VectorXd& value, const Eigen::VectorXd& sigma,
                                 const Eigen::VectorXd& degrees_of_freedom) {
  Estimates made;
  made.value = value;
  made.covariance = sigma.cwiseAbs2().asDiagonal();
  made.degrees_of_freedom = degrees_of_freedom;
  return made;
}

Estimates Estimates::mean_of(const Matrix& observations) {
  const Index n = observations.rows();
  if (n < 2) refuse(fmt::format("{} observations", n), "Give at least two");
  Estimates made;
  made.value = observations.colwise().mean();
  const Matrix off = observations.rowwise() - made.value.transpose();
  made.covariance = off.transpose() * off / static_cast<double>(n * (n - 1));
  made.degrees_of_freedom =
      Eigen::VectorXd::Constant(observations.cols(), static_cast<double>(n - 1));
  return made;
}

void Estimates::validate() const {
  const Index n = value.size();
  if (n == 0 || covariance.rows() != n || covariance.cols() != n ||
      (degrees_of_freedom.size() != 0 && degrees_of_freedom.size() != n)) {
    refuse(fmt::format("{} estimates, a covariance of {} x {}, {} degrees of freedom", n,
                       covariance.rows(), covariance.cols(), degrees_of_freedom.size()),
           "Give one row and column, and one or no degrees of freedom, for each estimate");
  }
  const auto finite = [](double number) { return std::isfinite(number); };
  if (!std::all_of(value.begin(), value.end(), finite) ||
      !std::all_of(covariance.data(), covariance.data() + covariance.size(), finite)) {
    refuse("an estimate or a covariance is not finite", "Give finite numbers");
  }
  if (covariance != covariance.transpose() || covariance.diagonal().minCoeff() < 0.0) {
    refuse("the covariance is not symmetric, or negative on its diagonal",
           "Give variances on the diagonal and each covariance twice");
  }
  if (degrees_of_freedom.size() == 0) return;
  if (!(degrees_of_freedom.array() > 0.0).all()) {
    refuse("a number of degrees of freedom is not above 0", "Give infinity for an exact one");
  }
  for (Index i = 0; i < n; ++i) {
    for (Index j = 0; j < i; ++j) {
      if (covariance(i, j) != 0.0 && degrees_of_freedom(i) != degrees_of_freedom(j)) {
        refuse(fmt::format("correlated estimates {} and {} have {:g} and {:g} degrees of freedom",
                           j, i, degrees_of_freedom(j), degrees_of_freedom(i)),
               "Give estimates made from the same observations the same number");
      }
    }
  }
}

Matrix LinearResult::correlation() const {
  const Eigen::VectorXd scale = sigma();
  Matrix result = covariance;
  for (Index i = 0; i < result.rows(); ++i) {
    for (Index j = 0; j < result.cols(); ++j) {
      const double both = scale(i) * scale(j);
      result(i, j) = i == j ? 1.0 : (both > 0.0 ? result(i, j) / both : 0.0);
    }
  }
  return result;
}

Interval LinearResult::interval(Index output, double coverage) const {
  const double half =
      coverage_factor(coverage, degrees_of_freedom(output)) * std::sqrt(covariance(output, output));
  return {value(output) - half, value(output) + half};
}

LinearResult propagate_linearly(const Model& model, const Estimates& inputs,
                                const LinearOptions& options) {
  inputs.validate();
  LinearResult result;
  result.value = model(inputs.value);
  const Index m = result.value.size(), n = inputs.value.size();
  result.sensitivity =
      options.sensitivity ? options.sensitivity(inputs.value) : differences(model, inputs, m);
  MANO_ASSERT(result.sensitivity.rows() == m && result.sensitivity.cols() == n);
  result.covariance = result.sensitivity * inputs.covariance * result.sensitivity.transpose();
  result.covariance.triangularView<Eigen::StrictlyUpper>() = result.covariance.transpose();
  result.degrees_of_freedom.resize(m);
  for (Index i = 0; i < m; ++i) {
    result.degrees_of_freedom(i) =
        effective_degrees_of_freedom(result.sensitivity.row(i), inputs, result.covariance(i, i));
  }
  if (options.second_order) {
    if (!inputs.covariance.isDiagonal(0.0)) {
      refuse("terms of second order are asked for of correlated inputs",
             "Leave them out, or use propagate_by_draws()");
    }
    result.covariance.diagonal() += second_order_variance(model, inputs, result.sensitivity);
  }
  return result;
}

double coverage_factor(double coverage, double degrees_of_freedom) {
  if (!(coverage > 0.0 && coverage < 1.0)) {
    refuse(fmt::format("coverage is {:g}", coverage), "Give a probability in (0, 1)");
  }
  if (!(degrees_of_freedom > 0.0)) {
    refuse(fmt::format("number of degrees of freedom is {:g}", degrees_of_freedom),
           "Give a number above 0");
  }
  const double tail = 0.5 * (1.0 - coverage);
  if (std::isinf(degrees_of_freedom)) {
    return boost::math::quantile(boost::math::complement(boost::math::normal(), tail));
  }
  return boost::math::quantile(
      boost::math::complement(boost::math::students_t(degrees_of_freedom), tail));
}

double numerical_tolerance(double sigma, int digits) {
  if (!(std::isfinite(sigma) && sigma > 0.0)) {
    refuse(fmt::format("standard uncertainty is {:g}", sigma), "Give a number above 0");
  }
  if (digits < 1 || digits > 8) {
    refuse(fmt::format("{} significant digits", digits), "Give 1 to 8");
  }
  int power = static_cast<int>(std::floor(std::log10(sigma))) - digits + 1;
  // 0.096 has the one digit 1 at 10^-1, not 9 or 10 at 10^-2.
  if (std::round(sigma / std::pow(10.0, power)) >= std::pow(10.0, digits)) ++power;
  return 0.5 * std::pow(10.0, power);
}

LinearValidation validate_linear(const Interval& linear, const Interval& monte_carlo, double sigma,
                                 int digits) {
  LinearValidation result;
  result.tolerance = numerical_tolerance(sigma, digits);
  result.d_low = std::abs(linear.low - monte_carlo.low);
  result.d_high = std::abs(linear.high - monte_carlo.high);
  result.valid = std::max(result.d_low, result.d_high) <= result.tolerance;
  return result;
}

}  // namespace manoscope::numerics

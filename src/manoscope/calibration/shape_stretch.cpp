#include "manoscope/calibration/shape_stretch.hpp"

#include <Eigen/Cholesky>
#include <Eigen/QR>
#include <algorithm>
#include <cmath>

namespace manoscope::calibration {
namespace {

constexpr int kPolynomials = 4;
using Polynomials = Eigen::Matrix<double, Eigen::Dynamic, kPolynomials, 0, kMostBins, kPolynomials>;
using Free = Eigen::Matrix<double, Eigen::Dynamic, 2, 0, kMostBins, 2>;
using Square = Eigen::Matrix<double, Eigen::Dynamic, Eigen::Dynamic, 0, kMostBins, kMostBins>;
using Modes =
    Eigen::Matrix<double, Eigen::Dynamic, kPolynomials + 2, 0, kMostBins, kPolynomials + 2>;

/// Orthonormal directions of phi and of the slope, as far as they are two.
template <class Matrix>
auto directions(const Matrix& modes) {
  Eigen::ColPivHouseholderQR<Matrix> factors(modes);
  factors.setThreshold(1e-9);
  using Columns = Eigen::Matrix<double, Eigen::Dynamic, Eigen::Dynamic, 0, kMostBins, kMostBins>;
  return Columns(factors.householderQ() * Columns::Identity(modes.rows(), factors.rank()));
}

}  // namespace

Polynomials even_polynomials(const BinVector& z) {
  Polynomials powers(z.size(), kPolynomials);
  for (Index i = 0; i < z.size(); ++i) {
    const double square = z[i] * z[i];
    powers.row(i) << 1.0, square, square * square, square * square * square;
  }
  const Eigen::HouseholderQR<Polynomials> factors(powers);
  const Polynomials thin = factors.householderQ() * Polynomials::Identity(z.size(), kPolynomials);
  return thin * std::sqrt(static_cast<double>(z.size()));
}

StretchMisfit stretch_misfit(const StretchShape& shape) {
  const Index n = shape.residual.size();
  const Polynomials even = even_polynomials(shape.z);
  Square covariance = (shape.smooth * shape.smooth / kPolynomials) * even * even.transpose();
  covariance.diagonal() += shape.sigma.cwiseAbs2();
  const Eigen::LLT<Square> factors(covariance);
  const auto whiten = [&](auto& values) { factors.matrixL().solveInPlace(values); };
  Free modes(n, 2);
  modes << shape.phi, shape.slope;
  // Both in units of the noise: what is far below it is no direction.
  for (int k = 0; k < 2; ++k) {
    const double size = modes.col(k).norm();
    if (size > 0.0) modes.col(k) *= shape.sigma.norm() / size;
  }
  whiten(modes);
  const auto taken = directions(modes);
  BinVector rest = shape.residual;
  whiten(rest);
  rest -= taken * (taken.transpose() * rest);
  Square noise = shape.sigma.asDiagonal();
  whiten(noise);
  noise -= taken * (taken.transpose() * noise);
  StretchMisfit misfit;
  misfit.chi_square = rest.squaredNorm();
  misfit.dof = noise.squaredNorm();
  const double mean_variance = shape.sigma.squaredNorm() / static_cast<double>(n);
  const double beyond = misfit.dof > 0.0 ? misfit.chi_square / misfit.dof - 1.0 : 0.0;
  misfit.excess = std::sqrt(std::max(0.0, beyond) * mean_variance);
  return misfit;
}

double moved_average(const StretchShape& shape) {
  constexpr int kIterations = 40;
  constexpr double kFar = 3.0;
  const Index n = shape.residual.size();
  const Polynomials even = even_polynomials(shape.z);
  Modes modes(n, kPolynomials + 2);
  modes << even, shape.phi, shape.slope / std::max(shape.slope.norm(), 1e-300);
  // The polynomials are held to their size, phi and the shift hardly at all.
  Eigen::Matrix<double, kPolynomials + 2, 1> held;
  const double prior = std::max(1e-24, shape.smooth * shape.smooth / kPolynomials);
  held << 1.0 / prior, 1.0 / prior, 1.0 / prior, 1.0 / prior, 0.0, 0.0;
  const double weight_of_one = static_cast<double>(n) / shape.sigma.squaredNorm();
  held.tail<2>().setConstant(1e-9 * weight_of_one);
  BinVector weight = shape.sigma.cwiseAbs2().cwiseInverse();
  BinVector rest = shape.residual;
  for (int iteration = 0; iteration < kIterations; ++iteration) {
    Eigen::Matrix<double, kPolynomials + 2, kPolynomials + 2> normal =
        modes.transpose() * weight.asDiagonal() * modes;
    normal.diagonal() += held;
    rest = shape.residual -
           modes * normal.ldlt().solve(modes.transpose() * (weight.asDiagonal() * shape.residual));
    for (Index i = 0; i < n; ++i) {
      const double distance = std::abs(rest[i]) / shape.sigma[i];
      const double doubt = iteration < kIterations / 2 ? std::max(1.0, distance)
                                                       : 1.0 + std::pow(distance / kFar, 2);
      weight[i] = 1.0 / (shape.sigma[i] * shape.sigma[i] * doubt);
    }
  }
  return rest.mean();
}

}  // namespace manoscope::calibration

#include "manoscope/wall/fit_law_solver.hpp"

#include <ceres/ceres.h>

#include <cmath>
#include <vector>

#include "manoscope/core/error.hpp"

namespace manoscope::wall {
namespace {

/// Residuals: (x - X)/sigma_x as the shift itself, then (y - y(X))/sigma_y, X = x - sigma_x shift.
class Residuals : public ceres::CostFunction {
 public:
  explicit Residuals(const LatentFit& fit) : fit_(fit) {
    set_num_residuals(static_cast<int>(2 * fit.x.size()));
    *mutable_parameter_block_sizes() = {static_cast<int>(fit.start.size()),
                                        static_cast<int>(fit.x.size())};
  }

  bool Evaluate(double const* const* parameters, double* residuals,
                double** jacobians) const override {
    using RowMajor = Eigen::Matrix<double, Eigen::Dynamic, Eigen::Dynamic, Eigen::RowMajor>;
    const Index n = fit_.x.size(), k = fit_.start.size();
    const Array1 theta = Eigen::Map<const Array1>(parameters[0], k);
    const Array1 shift = Eigen::Map<const Array1>(parameters[1], n);
    Array1 y, slope;
    const Array1 x = fit_.x - fit_.sigma_x * shift;
    if (!fit_.curve(theta, x, y, slope)) return false;
    Eigen::Map<Array1> out(residuals, 2 * n);
    out.head(n) = shift;
    out.tail(n) = (fit_.y - y) / fit_.sigma_y;
    if (jacobians == nullptr) return true;
    if (jacobians[0] != nullptr) {
      for (Index j = 0; j < k; ++j) {
        Array1 up, down;
        const double width = differences(theta, j, x, y, up, down);
        if (width == 0.0) return false;
        for (Index i = 0; i < n; ++i) {
          jacobians[0][i * k + j] = 0.0;
          jacobians[0][(n + i) * k + j] = -(up(i) - down(i)) / (width * fit_.sigma_y(i));
        }
      }
    }
    if (jacobians[1] != nullptr) {
      Eigen::Map<RowMajor> by_shift(jacobians[1], 2 * n, n);
      by_shift.setZero();
      by_shift.topRows(n).setIdentity();
      by_shift.bottomRows(n).diagonal() = (slope * fit_.sigma_x / fit_.sigma_y).matrix();
    }
    return true;
  }

 private:
  /// Curves on both sides of theta_j, or on one where the other does not exist; their distance.
  double differences(const Array1& theta, Index j, const Array1& x, const Array1& y, Array1& up,
                     Array1& down) const {
    Array1 moved = theta, slope;
    double width = 0.0;
    moved(j) = theta(j) + fit_.step(j);
    if (fit_.curve(moved, x, up, slope)) {
      width += fit_.step(j);
    } else {
      up = y;
    }
    moved(j) = theta(j) - fit_.step(j);
    if (fit_.curve(moved, x, down, slope)) {
      width += fit_.step(j);
    } else {
      down = y;
    }
    return width;
  }

  const LatentFit& fit_;
};

}  // namespace

LatentAnswer solve_latent_fit(const LatentFit& fit) {
  const Index n = fit.x.size(), k = fit.start.size();
  std::vector<double> theta(fit.start.begin(), fit.start.end()), shift(n, 0.0);
  ceres::Problem problem;
  problem.AddResidualBlock(new Residuals(fit), nullptr, theta.data(), shift.data());
  for (Index j = 0; j < k; ++j) {
    problem.SetParameterLowerBound(theta.data(), static_cast<int>(j), fit.lower(j));
    problem.SetParameterUpperBound(theta.data(), static_cast<int>(j), fit.upper(j));
  }
  ceres::Solver::Options options;
  options.linear_solver_type = ceres::DENSE_QR;
  options.num_threads = 1;
  options.logging_type = ceres::SILENT;
  options.max_num_iterations = fit.max_iterations;
  options.function_tolerance = 1e-14;
  options.parameter_tolerance = 1e-12;
  options.gradient_tolerance = 1e-12;
  ceres::Solver::Summary summary;
  // Latent abscissae that may move while the curve is still far off would follow it anywhere.
  problem.SetParameterBlockConstant(shift.data());
  ceres::Solve(options, &problem, &summary);
  if ((fit.sigma_x > 0.0).any()) {
    problem.SetParameterBlockVariable(shift.data());
    ceres::Solve(options, &problem, &summary);
  }

  LatentAnswer answer;
  answer.converged = summary.termination_type == ceres::CONVERGENCE;
  answer.theta = Eigen::Map<const Array1>(theta.data(), k);
  const Array1 moved = Eigen::Map<const Array1>(shift.data(), n);
  answer.x = fit.x - fit.sigma_x * moved;
  Array1 residuals(2 * n), by_theta(2 * n * k), by_shift(2 * n * n);
  const double* parameters[] = {theta.data(), shift.data()};
  double* jacobians[] = {by_theta.data(), by_shift.data()};
  const bool exists = Residuals(fit).Evaluate(parameters, residuals.data(), jacobians);
  MANO_ASSERT(exists);  // the solver only stands where the curve exists
  answer.residual.resize(n);
  answer.information = Matrix::Zero(k, k);
  for (Index i = 0; i < n; ++i) {
    const double off = residuals(n + i), along = by_shift((n + i) * n + i);
    answer.residual(i) = std::copysign(std::hypot(moved(i), off), off);
    // d(off)/d(shift) = along with weight 1 on the shift: the abscissa marginalised.
    const Eigen::Map<const Eigen::VectorXd> row(by_theta.data() + (n + i) * k, k);
    answer.information += row * row.transpose() / (1.0 + along * along);
  }
  return answer;
}

}  // namespace manoscope::wall

#include "manoscope/numerics/least_squares.hpp"

#include <ceres/ceres.h>
#include <fmt/format.h>

#include <Eigen/QR>
#include <algorithm>
#include <cmath>
#include <limits>
#include <string>
#include <vector>

#include "manoscope/core/error.hpp"
#include "manoscope/core/random.hpp"

namespace manoscope::numerics {
namespace {

constexpr const char* kWhere = "least squares";
constexpr int kPolishingSteps = 30;

[[noreturn]] void refuse(const std::string& found, const char* mend) {
  throw InputError(kWhere, found, mend);
}

/// Not by allFinite(), whose arithmetic raises a floating-point fault where the answer is no.
template <class Array>
bool finite(const Array& values) {
  return std::all_of(values.data(), values.data() + values.size(),
                     [](double value) { return std::isfinite(value); });
}

/// Residuals at given parameters; false where they do not exist.
bool residuals_at(const LeastSquaresProblem& problem, const Eigen::VectorXd& parameters,
                  Eigen::VectorXd& residuals) {
  residuals.resize(problem.n_residuals);
  if (!problem.residuals(parameters, residuals)) return false;
  MANO_ASSERT(residuals.size() == problem.n_residuals);
  return finite(residuals);
}

/// Derivative by parameter j by Ridders' method: central differences over steps that halve,
/// extrapolated to step 0 until rounding takes over. That of Ceres has a least first step of 0.01,
/// far too long for a parameter of 1e-4.
bool ridders(const LeastSquaresProblem& problem, const Eigen::VectorXd& at, Index j,
             Eigen::Ref<Eigen::VectorXd> derivative) {
  constexpr int kRows = 10, kShrinkings = 20;
  const double scale = std::max(std::abs(at(j)), 1e-3 * std::abs(problem.start(j)));
  double step = 1e-2 * (scale > 0.0 ? scale : 1.0);
  Eigen::VectorXd moved = at, up, down;
  const auto difference = [&](double h, Eigen::VectorXd& quotient) {
    moved(j) = at(j) + h;
    const double above = moved(j);
    if (!residuals_at(problem, moved, up)) return false;
    moved(j) = at(j) - h;
    if (!residuals_at(problem, moved, down)) return false;
    quotient = (up - down) / (above - moved(j));
    return finite(quotient);
  };
  std::vector<Eigen::VectorXd> row(1), above;
  int shrinkings = 0;
  while (!difference(step, row[0])) {
    if (++shrinkings > kShrinkings) return false;
    step *= 0.25;
  }
  derivative = row[0];
  double least = std::numeric_limits<double>::infinity();
  for (int i = 1; i < kRows; ++i) {
    above.swap(row);
    row.assign(static_cast<std::size_t>(i) + 1, {});
    step *= 0.5;
    if (!difference(step, row[0])) break;
    double factor = 1.0;
    for (std::size_t m = 1; m < row.size(); ++m) {
      factor *= 4.0;
      row[m] = (factor * row[m - 1] - above[m - 1]) / (factor - 1.0);
      const double error = std::max((row[m] - row[m - 1]).norm(), (row[m] - above[m - 1]).norm());
      if (error < least) {
        least = error;
        derivative = row[m];
      }
    }
    if (least <= 1e-14 * derivative.norm()) break;
    if ((row.back() - above.back()).norm() >= 2.0 * least) break;
  }
  return true;
}

class Cost : public ceres::CostFunction {
 public:
  explicit Cost(const LeastSquaresProblem& problem) : problem_(problem) {
    set_num_residuals(static_cast<int>(problem.n_residuals));
    *mutable_parameter_block_sizes() = {static_cast<int>(problem.start.size())};
  }

  bool Evaluate(double const* const* parameters, double* residuals,
                double** jacobians) const override {
    const Index n = problem_.n_residuals, k = problem_.start.size();
    const Eigen::VectorXd theta = Eigen::Map<const Eigen::VectorXd>(parameters[0], k);
    Eigen::VectorXd out;
    if (!residuals_at(problem_, theta, out)) return false;
    Eigen::Map<Eigen::VectorXd>(residuals, n) = out;
    if (jacobians == nullptr || jacobians[0] == nullptr) return true;
    Matrix jacobian(n, k);
    if (problem_.jacobian) {
      if (!problem_.jacobian(theta, jacobian)) return false;
    } else {
      for (Index j = 0; j < k; ++j) {
        if (!ridders(problem_, theta, j, jacobian.col(j))) return false;
      }
    }
    using RowMajor = Eigen::Matrix<double, Eigen::Dynamic, Eigen::Dynamic, Eigen::RowMajor>;
    Eigen::Map<RowMajor>(jacobians[0], n, k) = jacobian;
    return finite(jacobian);
  }

 private:
  const LeastSquaresProblem& problem_;
};

struct Point {
  Eigen::VectorXd parameters, residuals;
  Matrix jacobian;
  double sum_of_squares() const { return residuals.squaredNorm(); }
};

/// Residuals and derivatives at given parameters, where they exist.
std::optional<Point> evaluate(const ceres::CostFunction& cost, const Eigen::VectorXd& parameters) {
  const Index n = cost.num_residuals(), k = parameters.size();
  Eigen::Matrix<double, Eigen::Dynamic, Eigen::Dynamic, Eigen::RowMajor> jacobian(n, k);
  Point point{parameters, Eigen::VectorXd(n), {}};
  const double* blocks[] = {parameters.data()};
  double* jacobians[] = {jacobian.data()};
  if (!cost.Evaluate(blocks, point.residuals.data(), jacobians)) return std::nullopt;
  if (!finite(jacobian)) return std::nullopt;
  point.jacobian = jacobian;
  return point;
}

/// Jacobian with columns of length 1, factorised, and the lengths.
struct Factorised {
  Eigen::VectorXd length;
  Eigen::ColPivHouseholderQR<Matrix> qr;

  explicit Factorised(const Matrix& jacobian) {
    length = jacobian.colwise().norm();
    for (Index j = 0; j < length.size(); ++j) {
      if (length(j) == 0.0) length(j) = 1.0;
    }
    qr.setThreshold(1e-11);  // some ten times the error of a derivative by differences
    qr.compute(jacobian * length.cwiseInverse().asDiagonal());
  }
  bool full() const { return qr.rank() == length.size(); }
};

/// Parameters that a step may move: all but those that the sum of squares presses to a bound.
std::vector<Index> movable(const LeastSquaresProblem& problem, const Point& point) {
  const Eigen::VectorXd gradient = point.jacobian.transpose() * point.residuals;
  std::vector<Index> result;
  for (Index j = 0; j < gradient.size(); ++j) {
    const bool held = problem.lower.size() > 0 &&
                      ((point.parameters(j) <= problem.lower(j) && gradient(j) >= 0.0) ||
                       (point.parameters(j) >= problem.upper(j) && gradient(j) <= 0.0));
    if (!held) result.push_back(j);
  }
  return result;
}

/// Gauss-Newton steps within the bounds while they lower the sum of squares or, where that is down
/// to rounding, the part of the residuals that a step can take away.
Point polish(const ceres::CostFunction& cost, const LeastSquaresProblem& problem, Point point) {
  double removable = std::numeric_limits<double>::infinity();
  for (int i = 0; i < kPolishingSteps; ++i) {
    const std::vector<Index> columns = movable(problem, point);
    if (columns.empty()) break;
    const Factorised factorised(point.jacobian(Eigen::all, columns));
    if (!factorised.full()) break;
    const Eigen::VectorXd scaled_step = factorised.qr.solve(point.residuals);
    Eigen::VectorXd step = Eigen::VectorXd::Zero(point.parameters.size());
    step(columns) = scaled_step.cwiseQuotient(factorised.length);
    Eigen::VectorXd moved = point.parameters - step;
    if (problem.lower.size() > 0) moved = moved.cwiseMax(problem.lower).cwiseMin(problem.upper);
    const std::optional<Point> next = evaluate(cost, moved);
    if (!next) break;
    const double before = point.sum_of_squares(), after = next->sum_of_squares();
    const double size = scaled_step.norm();
    if (!(after < before) && !(after <= before * (1.0 + 1e-10) && size < 0.5 * removable)) break;
    removable = size;
    point = *next;
  }
  return point;
}

Eigen::VectorXd further_start(const LeastSquaresProblem& problem, const MultiStartOptions& options,
                              int number) {
  RandomStream random(options.seed, "further start", static_cast<std::uint64_t>(number));
  // Wide ones first, so that starts that agree have come from afar.
  constexpr double kSpreads[] = {1.5, 0.5, 0.1, 1.0};
  const double spread = options.spread * kSpreads[(number - 1) % 4];
  Eigen::VectorXd start = problem.start;
  for (Index j = 0; j < start.size(); ++j) {
    const bool bounded = problem.lower.size() > 0;
    const double z = std::clamp(random.normal(), -4.0, 4.0);
    const bool flip = random.uniform() < 0.5 && number % 4 == 0;
    start(j) = start(j) == 0.0 ? spread * z : start(j) * std::exp(spread * z);
    if (flip) start(j) = -start(j);
    if (!bounded) continue;
    const double low = problem.lower(j), high = problem.upper(j);
    const double between = random.uniform();
    if (number % 2 == 1 && std::isfinite(low) && std::isfinite(high)) {
      start(j) = low + between * (high - low);
    }
    start(j) = std::clamp(start(j), low, high);
  }
  return start;
}

/// Distance from the given start in units of its parameters.
double distance(const LeastSquaresProblem& problem, const LeastSquaresFit& fit) {
  double sum = 0.0;
  for (Index j = 0; j < problem.start.size(); ++j) {
    const double unit = problem.start(j) != 0.0 ? problem.start(j) : 1.0;
    sum += std::pow((fit.parameters(j) - problem.start(j)) / unit, 2);
  }
  return std::sqrt(sum);
}

/// Whether the minimum is a place rather than a level that goes on for ever: no parameter is
/// uncertain by more than a thousand times itself.
bool is_place(const LeastSquaresProblem& problem, const LeastSquaresFit& fit) {
  if (!fit.covariance) return false;
  if (fit.n_dof == 0) return true;
  const Eigen::VectorXd sigma = *fit.scaled_sigma();
  return (sigma.array() <=
          1e3 * fit.parameters.cwiseAbs().cwiseMax(problem.start.cwiseAbs()).array())
      .all();
}

}  // namespace

void LeastSquaresProblem::validate() const {
  const Index k = start.size();
  if (!residuals || k == 0 || n_residuals < k) {
    refuse(fmt::format("{} residuals for {} parameters", n_residuals, k),
           "Give residuals, not fewer than parameters");
  }
  if (!finite(start)) refuse("a start is not finite", "Give finite numbers");
  if (lower.size() == 0 && upper.size() == 0) return;
  if (lower.size() != k || upper.size() != k) {
    refuse(fmt::format("{} lower and {} upper bounds for {} parameters", lower.size(), upper.size(),
                       k),
           "Give none or one of each for every parameter");
  }
  for (Index j = 0; j < k; ++j) {
    if (!(lower(j) < upper(j) && lower(j) <= start(j) && start(j) <= upper(j))) {
      refuse(fmt::format("parameter {} starts at {:g} between the bounds {:g} and {:g}", j,
                         start(j), lower(j), upper(j)),
             "Give a lower bound below the upper one, and a start between them");
    }
  }
}

void LeastSquaresOptions::validate() const {
  if (max_iterations < 1)
    refuse(fmt::format("max_iterations is {}", max_iterations), "Give 1 or more");
  if (!(tolerance > 0.0 && tolerance < 1.0)) {
    refuse(fmt::format("tolerance is {:g}", tolerance), "Give a number in (0, 1)");
  }
}

void MultiStartOptions::validate() const {
  each.validate();
  if (most_starts < 1) refuse(fmt::format("most_starts is {}", most_starts), "Give 1 or more");
  if (agreeing < 1) refuse(fmt::format("agreeing is {}", agreeing), "Give 1 or more");
  if (!(spread > 0.0 && spread <= 10.0)) {
    refuse(fmt::format("spread is {:g}", spread), "Give a number in (0, 10]");
  }
}

double LeastSquaresFit::residual_sigma() const {
  MANO_ASSERT(n_dof > 0);
  return std::sqrt(sum_of_squares / static_cast<double>(n_dof));
}

std::optional<Eigen::VectorXd> LeastSquaresFit::scaled_sigma() const {
  if (!covariance) return std::nullopt;
  return residual_sigma() * covariance->diagonal().cwiseSqrt();
}

std::optional<LeastSquaresFit> fit_least_squares(const LeastSquaresProblem& problem,
                                                 const LeastSquaresOptions& options) {
  problem.validate();
  options.validate();
  const Index k = problem.start.size();
  Cost cost(problem);
  if (!evaluate(cost, problem.start)) return std::nullopt;

  Eigen::VectorXd parameters = problem.start;
  ceres::Problem::Options ownership;
  ownership.cost_function_ownership = ceres::DO_NOT_TAKE_OWNERSHIP;
  ceres::Problem solved(ownership);
  solved.AddResidualBlock(&cost, nullptr, parameters.data());
  for (Index j = 0; j < k && problem.lower.size() > 0; ++j) {
    if (std::isfinite(problem.lower(j))) {
      solved.SetParameterLowerBound(parameters.data(), static_cast<int>(j), problem.lower(j));
    }
    if (std::isfinite(problem.upper(j))) {
      solved.SetParameterUpperBound(parameters.data(), static_cast<int>(j), problem.upper(j));
    }
  }
  ceres::Solver::Options settings;
  settings.linear_solver_type = ceres::DENSE_QR;
  settings.num_threads = 1;
  settings.logging_type = ceres::SILENT;
  settings.max_num_iterations = options.max_iterations;
  settings.max_num_consecutive_invalid_steps = 20;
  settings.parameter_tolerance = options.tolerance;
  settings.function_tolerance = options.tolerance * options.tolerance;
  settings.gradient_tolerance = 1e-30;  // has the units of the parameters: left to the other two
  ceres::Solver::Summary summary;
  ceres::Solve(settings, &solved, &summary);

  const std::optional<Point> found = evaluate(cost, parameters);
  if (!found) return std::nullopt;
  const Point point = polish(cost, problem, *found);
  LeastSquaresFit fit;
  fit.parameters = point.parameters;
  fit.residuals = point.residuals;
  fit.jacobian = point.jacobian;
  fit.sum_of_squares = point.sum_of_squares();
  fit.n_dof = problem.n_residuals - k;
  const Factorised factorised(point.jacobian);
  // A long valley may take all iterations of the solver and be ended by the last steps.
  fit.converged = summary.termination_type == ceres::CONVERGENCE ||
                  factorised.qr.solve(point.residuals).norm() <= 1e-6 * point.residuals.norm();
  if (factorised.full()) {
    const Matrix r = factorised.qr.matrixQR().topRows(k).triangularView<Eigen::Upper>();
    const Matrix inverse = r.triangularView<Eigen::Upper>().solve(Matrix::Identity(k, k));
    const Matrix spread =
        factorised.length.cwiseInverse().asDiagonal() * (factorised.qr.colsPermutation() * inverse);
    fit.covariance = spread * spread.transpose();
  }
  return fit;
}

std::optional<MultiStartFit> fit_from_many_starts(const LeastSquaresProblem& problem,
                                                  const MultiStartOptions& options) {
  problem.validate();
  options.validate();
  std::optional<MultiStartFit> result;
  LeastSquaresProblem started = problem;
  double rounding = 0.0;  // sums of squares below it differ by rounding
  int number = 0;
  for (; number < options.most_starts; ++number) {
    // Many starts slide down to where a parameter goes to infinity: to agree there tells little.
    if (result && result->n_agreeing >= options.agreeing && is_place(problem, result->best)) break;
    if (number > 0) started.start = further_start(problem, options, number);
    const std::optional<LeastSquaresFit> fit = fit_least_squares(started, options.each);
    if (!fit) continue;
    if (!result) {
      Eigen::VectorXd residuals;
      residuals_at(problem, started.start, residuals);
      rounding = 1e-20 * residuals.squaredNorm();
      result = MultiStartFit{*fit, 0, 1};
      continue;
    }
    const double least = result->best.sum_of_squares, here = fit->sum_of_squares;
    if (std::abs(here - least) <= 1e-6 * least + rounding) {
      ++result->n_agreeing;
      const double nearer = distance(problem, *fit) / distance(problem, result->best);
      if (nearer < 0.999 || (nearer < 1.001 && here < least)) result->best = *fit;
    } else if (here < least) {
      result = MultiStartFit{*fit, 0, 1};
    }
  }
  if (result) result->n_starts = number;
  return result;
}

}  // namespace manoscope::numerics

#include "manoscope/numerics/monte_carlo.hpp"

#include <fmt/format.h>

#include <Eigen/Eigenvalues>
#include <algorithm>
#include <array>
#include <cmath>
#include <string>
#include <utility>

#include "manoscope/core/error.hpp"
#include "manoscope/core/parallel.hpp"

namespace manoscope::numerics {
namespace {

constexpr const char* kWhere = "Monte Carlo propagation";
constexpr Index kBlock = 1000;  // draws of one random stream

[[noreturn]] void refuse(const std::string& found, const char* mend) {
  throw InputError(kWhere, found, mend);
}

/// Outputs of all draws so far: one vector an output.
using Draws = std::vector<std::vector<double>>;

/// Appends n draws, the first of them number `from`; both multiples of kBlock or the end.
void draw(const Model& model, const Sampler& inputs, const MonteCarloOptions& options, Index from,
          Index n, Draws& draws) {
  for (std::vector<double>& output : draws) output.resize(static_cast<std::size_t>(from + n));
  parallel_for((n + kBlock - 1) / kBlock, options.n_threads, [&](Index block) {
    const Index begin = from + block * kBlock, end = std::min(begin + kBlock, from + n);
    RandomStream random(options.seed, "propagation", static_cast<std::uint64_t>(begin / kBlock));
    for (Index trial = begin; trial < end; ++trial) {
      const Eigen::VectorXd y = model(inputs(random));
      MANO_ASSERT(static_cast<std::size_t>(y.size()) == draws.size());
      if (!std::all_of(y.begin(), y.end(), [](double value) { return std::isfinite(value); })) {
        refuse(fmt::format("the model is not finite at draw {}", trial),
               "Give distributions within the model's range");
      }
      for (std::size_t i = 0; i < draws.size(); ++i) {
        draws[i][static_cast<std::size_t>(trial)] = y(static_cast<Index>(i));
      }
    }
  });
}

double mean(const double* begin, std::size_t n) {
  double sum = 0.0;
  for (std::size_t i = 0; i < n; ++i) sum += begin[i];
  return sum / static_cast<double>(n);
}

double covariance(const double* a, double mean_a, const double* b, double mean_b, std::size_t n) {
  double sum = 0.0;
  for (std::size_t i = 0; i < n; ++i) sum += (a[i] - mean_a) * (b[i] - mean_b);
  return sum / static_cast<double>(n - 1);
}

/// Number of draws that an interval spans (7.7.1).
std::size_t spanned(std::size_t n, double coverage) {
  const auto q = static_cast<std::size_t>(std::llround(coverage * static_cast<double>(n)));
  return std::clamp<std::size_t>(q, 1, n - 1);
}

Interval symmetric_interval(const std::vector<double>& sorted, double coverage) {
  const std::size_t n = sorted.size(), q = spanned(n, coverage);
  const std::size_t rank = std::max<std::size_t>(1, (n - q + 1) / 2);  // 7.7.2, counted from 1
  return {sorted[rank - 1], sorted[rank - 1 + q]};
}

Interval shortest_interval(const std::vector<double>& sorted, double coverage) {
  const std::size_t q = spanned(sorted.size(), coverage);
  std::size_t best = 0;
  for (std::size_t r = 0; r + q < sorted.size(); ++r) {
    if (sorted[r + q] - sorted[r] < sorted[best + q] - sorted[best]) best = r;
  }
  return {sorted[best], sorted[best + q]};
}

/// What 7.9 watches: value, standard uncertainty and end points of each section of draws.
class Stability {
 public:
  explicit Stability(std::size_t n_outputs) : kept_(n_outputs) {}

  void add(const Draws& draws, std::size_t from, std::size_t n, double coverage) {
    for (std::size_t i = 0; i < draws.size(); ++i) {
      std::vector<double> sorted(draws[i].begin() + static_cast<std::ptrdiff_t>(from),
                                 draws[i].begin() + static_cast<std::ptrdiff_t>(from + n));
      const double centre = mean(sorted.data(), n);
      const double sigma = std::sqrt(covariance(sorted.data(), centre, sorted.data(), centre, n));
      std::sort(sorted.begin(), sorted.end());
      const Interval ends = symmetric_interval(sorted, coverage);
      kept_[i].push_back({centre, sigma, ends.low, ends.high});
    }
  }

  /// Twice the standard deviation of the mean over the sections, the largest of the four.
  double doubt(std::size_t output) const {
    const auto& sections = kept_[output];
    const auto h = static_cast<double>(sections.size());
    double largest = 0.0;
    for (std::size_t which = 0; which < 4; ++which) {
      double sum = 0.0, squares = 0.0;
      for (const auto& one : sections) sum += one[which];
      for (const auto& one : sections) squares += std::pow(one[which] - sum / h, 2);
      largest = std::max(largest, 2.0 * std::sqrt(squares / (h * (h - 1.0))));
    }
    return largest;
  }

  std::size_t sections() const { return kept_.front().size(); }

 private:
  std::vector<std::vector<std::array<double, 4>>> kept_;
};

bool stable(const Stability& stability, const Draws& draws, const MonteCarloOptions& options) {
  if (stability.sections() < 2) return false;
  for (std::size_t i = 0; i < draws.size(); ++i) {
    const double centre = mean(draws[i].data(), draws[i].size());
    const double sigma =
        std::sqrt(covariance(draws[i].data(), centre, draws[i].data(), centre, draws[i].size()));
    if (sigma > 0.0 &&
        stability.doubt(i) >= options.tolerance_part * numerical_tolerance(sigma, options.digits)) {
      return false;
    }
  }
  return true;
}

}  // namespace

Sampler independent(std::vector<Distribution> distributions) {
  return [all = std::move(distributions)](RandomStream& random) {
    Eigen::VectorXd x(static_cast<Index>(all.size()));
    for (std::size_t i = 0; i < all.size(); ++i) x(static_cast<Index>(i)) = all[i].draw(random);
    return x;
  };
}

Sampler jointly_normal(const Estimates& estimates) {
  estimates.validate();
  // Eigenvectors rather than Cholesky: perfectly correlated quantities are allowed.
  const Eigen::SelfAdjointEigenSolver<Matrix> eigen(estimates.covariance);
  const double largest = std::max(0.0, eigen.eigenvalues().maxCoeff());
  if (eigen.eigenvalues().minCoeff() < -1e-12 * largest) {
    refuse("the covariance has a negative eigenvalue", "Correlations must fit one another");
  }
  const Matrix root =
      eigen.eigenvectors() * eigen.eigenvalues().cwiseMax(0.0).cwiseSqrt().asDiagonal();
  return [centre = estimates.value, root](RandomStream& random) -> Eigen::VectorXd {
    Eigen::VectorXd z(centre.size());
    for (Index i = 0; i < z.size(); ++i) z(i) = random.normal();
    return centre + root * z;
  };
}

void MonteCarloOptions::validate() const {
  if (!(coverage > 0.0 && coverage < 1.0)) {
    refuse(fmt::format("coverage is {:g}", coverage), "Give a probability in (0, 1)");
  }
  const double least = std::ceil(10.0 / (1.0 - coverage));  // some draws beyond each end point
  if (static_cast<double>(trials) < least || trials > 1'000'000'000) {
    refuse(fmt::format("trials is {}", trials),
           "Give at least 10/(1 - coverage), at most 1000000000");
  }
  if (digits < 0 || digits > 4) refuse(fmt::format("digits is {}", digits), "Give 0 to 4");
  if (!(tolerance_part > 0.0 && tolerance_part <= 1.0)) {
    refuse(fmt::format("tolerance_part is {:g}", tolerance_part), "Give a number in (0, 1]");
  }
  if (n_threads < 0) refuse(fmt::format("n_threads is {}", n_threads), "Give 0 or more");
}

MonteCarloResult propagate_by_draws(const Model& model, const Sampler& inputs,
                                    const MonteCarloOptions& options) {
  options.validate();
  RandomStream probe(options.seed, "propagation");
  const Index m = model(inputs(probe)).size();
  MANO_ASSERT(m > 0);
  Draws draws(static_cast<std::size_t>(m));
  MonteCarloResult result;
  if (options.digits == 0) {
    draw(model, inputs, options, 0, options.trials, draws);
    result.n_trials = options.trials;
  } else {
    // 7.9.4: sections of at least 10^4 draws and 100/(1 - p), whole blocks.
    const double wished = std::max(1e4, std::ceil(100.0 / (1.0 - options.coverage)));
    const Index section = static_cast<Index>(std::ceil(wished / kBlock)) * kBlock;
    Stability stability(draws.size());
    result.stable = false;
    while (!result.stable && (result.n_trials + section <= options.trials)) {
      draw(model, inputs, options, result.n_trials, section, draws);
      stability.add(draws, static_cast<std::size_t>(result.n_trials),
                    static_cast<std::size_t>(section), options.coverage);
      result.n_trials += section;
      result.stable = stable(stability, draws, options);
    }
    if (result.n_trials == 0) {  // fewer trials than one section
      draw(model, inputs, options, 0, options.trials, draws);
      result.n_trials = options.trials;
    }
  }

  const auto n = static_cast<std::size_t>(result.n_trials);
  result.value.resize(m);
  result.covariance.resize(m, m);
  for (Index i = 0; i < m; ++i) {
    const auto& a = draws[static_cast<std::size_t>(i)];
    result.value(i) = mean(a.data(), n);
    for (Index j = 0; j <= i; ++j) {
      const auto& b = draws[static_cast<std::size_t>(j)];
      result.covariance(i, j) = result.covariance(j, i) =
          covariance(a.data(), result.value(i), b.data(), result.value(j), n);
    }
  }
  for (std::vector<double>& output : draws) {
    std::sort(output.begin(), output.end());
    result.symmetric.push_back(symmetric_interval(output, options.coverage));
    result.shortest.push_back(shortest_interval(output, options.coverage));
  }
  return result;
}

}  // namespace manoscope::numerics

#include "manoscope/numerics/monte_carlo.hpp"

#include <gtest/gtest.h>

#include <cmath>
#include <limits>

#include "manoscope/core/error.hpp"

namespace manoscope::numerics {
namespace {

using Eigen::VectorXd;

// Numbers named "table" and "9.x" are those that JCGM 101:2008 prints. They come from draws, too,
// so a tolerance is half a unit of the last printed digit and 4 standard deviations of both: of a
// mean sigma/sqrt(M), of a standard deviation at most sigma/sqrt(M) for the distributions here, of
// an end point sqrt(q (1 - q)/M)/f with the density f there, q = (1 - p)/2. We draw M = 10^6 times,
// the standard as often or more where it prints what is compared here.
constexpr Index kDraws = 1'000'000;
constexpr double kPart = 4.0 * 1.5e-3;  // 4 * sqrt(2)/sqrt(M): of a standard deviation

double end_point_noise(double q, double density) {
  return 4.0 * std::sqrt(2.0) * std::sqrt(q * (1.0 - q) / kDraws) / density;
}

VectorXd sum(const VectorXd& x) { return VectorXd::Constant(1, x.sum()); }

MonteCarloResult draw(const Model& model, const Sampler& inputs, double coverage = 0.95) {
  MonteCarloOptions options;
  options.trials = kDraws;
  options.coverage = coverage;
  return propagate_by_draws(model, inputs, options);
}

LinearResult linear(const Model& model, const VectorXd& value, const VectorXd& sigma,
                    bool second_order = false) {
  LinearOptions options;
  options.second_order = second_order;
  return propagate_linearly(model, Estimates::independent(value, sigma), options);
}

TEST(PropagateByDraws, GivesTheAdditiveModelsOfJcgm101) {
  const double root3 = std::sqrt(3.0);
  const auto rectangle = [&](double sigma) {
    return Distribution::rectangular(-root3 * sigma, root3 * sigma);
  };
  {  // 9.2.2, table 2: four normal quantities; 0.00, 2.00, +-3.92
    const MonteCarloResult result =
        draw(sum, independent(std::vector(4, Distribution::normal(0.0, 1.0))));
    EXPECT_NEAR(result.value(0), 0.0, 0.005 + 2.0 * kPart);
    EXPECT_NEAR(result.sigma()(0), 2.0, 0.005 + 2.0 * kPart);
    const double noise = end_point_noise(0.025, 0.0584 / 2.0);  // normal density at 1.96
    EXPECT_NEAR(result.symmetric[0].low, -3.92, 0.005 + noise);
    EXPECT_NEAR(result.symmetric[0].high, 3.92, 0.005 + noise);
    const LinearResult gum = linear(sum, VectorXd::Zero(4), VectorXd::Ones(4));
    EXPECT_NEAR(gum.interval(0, 0.95).high, 3.92, 0.005);
  }
  {  // 9.2.3, table 3: four rectangular ones; end points +-2 sqrt(3) (2 - (3/5)^(1/4)) = +-3.88
    const MonteCarloResult result = draw(sum, independent(std::vector(4, rectangle(1.0))));
    EXPECT_NEAR(result.value(0), 0.0, 0.005 + 2.0 * kPart);
    EXPECT_NEAR(result.sigma()(0), 2.0, 0.005 + 2.0 * kPart);
    const double exact = 2.0 * root3 * (2.0 - std::pow(0.6, 0.25));
    EXPECT_NEAR(exact, 3.88, 0.005);
    // Density of the sum at t half-widths from its end: t^3/(12 sqrt(3)), t = (24 q)^(1/4).
    const double noise = end_point_noise(0.025, std::pow(24.0 * 0.025, 0.75) / (12.0 * root3));
    EXPECT_NEAR(result.symmetric[0].low, -exact, noise);
    EXPECT_NEAR(result.symmetric[0].high, exact, noise);
    EXPECT_NEAR(result.shortest[0].width(), 2.0 * exact, 2.0 * noise);
  }
  {  // 9.2.4, table 4: one of them ten times as wide; 0.0, 10.1, +-17.0; linear +-19.9
    const MonteCarloResult result =
        draw(sum, independent({rectangle(1.0), rectangle(1.0), rectangle(1.0), rectangle(10.0)}));
    EXPECT_NEAR(result.value(0), 0.0, 0.05 + 10.1 * kPart);
    EXPECT_NEAR(result.sigma()(0), 10.1, 0.05 + 10.1 * kPart);
    const double noise = end_point_noise(0.025, 0.02);  // 1/(20 sqrt(3)), less at the rim
    EXPECT_NEAR(result.symmetric[0].low, -17.0, 0.05 + noise);
    EXPECT_NEAR(result.symmetric[0].high, 17.0, 0.05 + noise);
    VectorXd sigma = VectorXd::Ones(4);
    sigma(3) = 10.0;
    const LinearResult gum = linear(sum, VectorXd::Zero(4), sigma);
    EXPECT_NEAR(gum.sigma()(0), 10.1, 0.05);
    EXPECT_NEAR(gum.interval(0, 0.95).high, 19.9, 0.05);
    EXPECT_FALSE(validate_linear(gum.interval(0, 0.95), result.symmetric[0], 10.1, 2).valid);
  }
}

/// 9.3, eq. 31: conventional mass less 100 g, in mg. Inputs: m_Rc, delta m_Rc, air density and the
/// densities of the two weights in kg/m^3 (table 5).
VectorXd mass(const VectorXd& x) {
  return VectorXd::Constant(
      1, (x(0) + x(1)) * (1.0 + (x(2) - 1.2) * (1.0 / x(3) - 1.0 / x(4))) - 100'000.0);
}

TEST(PropagateByDraws, GivesTheMassCalibrationOfJcgm101) {
  const std::vector<Distribution> inputs{
      Distribution::normal(100'000.0, 0.050), Distribution::normal(1.234, 0.020),
      Distribution::rectangular(1.10, 1.30), Distribution::rectangular(7000.0, 9000.0),
      Distribution::rectangular(7950.0, 8050.0)};
  VectorXd value(5), sigma(5);
  for (Index i = 0; i < 5; ++i) {
    value(i) = inputs[static_cast<std::size_t>(i)].mean();
    sigma(i) = inputs[static_cast<std::size_t>(i)].sigma();
  }
  const MonteCarloResult result = draw(mass, independent(inputs));
  const LinearResult first = linear(mass, value, sigma), second = linear(mass, value, sigma, true);
  // Table 6.
  EXPECT_NEAR(result.value(0), 1.2341, 0.00005 + 0.0754 * kPart);
  EXPECT_NEAR(result.sigma()(0), 0.0754, 0.00005 + 0.0754 * kPart);
  // Density near the end points, where it is close to a normal one. An end point of the shortest
  // interval wanders on: where the density is even at both ends, an interval is as short aside.
  const double noise = end_point_noise(0.025, 0.0584 / 0.0754);
  EXPECT_NEAR(result.shortest[0].low, 1.0834, 0.00005 + 4.0 * noise);
  EXPECT_NEAR(result.shortest[0].high, 1.3825, 0.00005 + 4.0 * noise);
  EXPECT_NEAR(result.shortest[0].width(), 1.3825 - 1.0834, 0.0001 + 2.0 * noise);
  EXPECT_NEAR(first.value(0), 1.2340, 0.00005);
  EXPECT_NEAR(first.sigma()(0), 0.0539, 0.00005);
  EXPECT_NEAR(first.interval(0, 0.95).low, 1.1285, 0.00005);
  EXPECT_NEAR(first.interval(0, 0.95).high, 1.3395, 0.00005);
  EXPECT_NEAR(second.sigma()(0), 0.0750, 0.00005);
  // Printed are 1.2340 -+ 1.96 * 0.0750, of the rounded standard uncertainty.
  EXPECT_NEAR(second.interval(0, 0.95).low, 1.0870, 0.00005 + 1.96 * 0.00005);
  EXPECT_NEAR(second.interval(0, 0.95).high, 1.3810, 0.00005 + 1.96 * 0.00005);
  // Validation with one significant digit: not to first order, but to second.
  const LinearValidation of_first =
      validate_linear(first.interval(0, 0.95), result.shortest[0], result.sigma()(0), 1);
  EXPECT_DOUBLE_EQ(of_first.tolerance, 0.005);
  EXPECT_NEAR(of_first.d_low, 0.0451, 0.00005 + 4.0 * noise);
  EXPECT_NEAR(of_first.d_high, 0.0430, 0.00005 + 4.0 * noise);
  EXPECT_FALSE(of_first.valid);
  EXPECT_TRUE(
      validate_linear(second.interval(0, 0.95), result.shortest[0], result.sigma()(0), 1).valid);
}

/// 9.4: comparison loss, x_1^2 + x_2^2, each known to 0.005; all numbers times 10^6.
VectorXd comparison_loss(const VectorXd& x) { return VectorXd::Constant(1, 1e6 * x.squaredNorm()); }

TEST(PropagateByDraws, GivesTheComparisonLossOfJcgm101) {
  struct Row {
    double correlation, x1;
    double value, sigma, low, high;  // Monte Carlo, shortest 95 % interval: 9.4.2 and 9.4.3
    double linear_value, linear_sigma, linear_low, linear_high;
  };
  const Row rows[] = {
      {0.0, 0.000, 50, 50, 0, 150, 0, 0, 0, 0},
      {0.0, 0.010, 150, 112, 0, 367, 100, 100, -96, 296},
      {0.0, 0.050, 2551, 502, 1590, 3543, 2500, 500, 1520, 3480},
      {0.9, 0.000, 50, 67, 0, 185, 0, 0, 0, 0},
      {0.9, 0.010, 150, 121, 13, 398, 100, 100, -96, 296},
      {0.9, 0.050, 2551, 505, 1628, 3555, 2500, 500, 1520, 3480},
  };
  for (const Row& row : rows) {
    SCOPED_TRACE(::testing::Message() << "x1 = " << row.x1 << ", r = " << row.correlation);
    constexpr double u = 0.005;
    Estimates inputs =
        Estimates::independent((VectorXd(2) << row.x1, 0.0).finished(), VectorXd::Constant(2, u));
    inputs.covariance(0, 1) = inputs.covariance(1, 0) = row.correlation * u * u;
    const LinearResult gum = propagate_linearly(comparison_loss, inputs);
    EXPECT_NEAR(gum.value(0), row.linear_value, 0.5);
    EXPECT_NEAR(gum.sigma()(0), row.linear_sigma, 0.5);
    EXPECT_NEAR(gum.interval(0, 0.95).low, row.linear_low, 0.5);
    EXPECT_NEAR(gum.interval(0, 0.95).high, row.linear_high, 0.5);

    const MonteCarloResult result = draw(comparison_loss, jointly_normal(inputs));
    // Exact: x1^2 + 2 u^2 and 4 u^2 x1^2 + 4 u^4 (1 + r^2).
    const double exact_sigma =
        1e6 * std::sqrt(4.0 * u * u * row.x1 * row.x1 +
                        4.0 * std::pow(u, 4) * (1.0 + row.correlation * row.correlation));
    EXPECT_NEAR(result.value(0), 1e6 * (row.x1 * row.x1 + 2.0 * u * u), exact_sigma * kPart);
    // Fourth moments up to 15 times the variance squared: sqrt(14/4) of the normal noise, doubled.
    EXPECT_NEAR(result.sigma()(0), exact_sigma, 3.0 * exact_sigma * kPart);
    EXPECT_NEAR(result.value(0), row.value, 0.5 + exact_sigma * kPart);
    EXPECT_NEAR(result.sigma()(0), row.sigma, 0.5 + 3.0 * exact_sigma * kPart);
    // Near an end point the density is at least 0.03/sigma; shortest intervals wander, see above.
    const double noise = 4.0 * end_point_noise(0.025, 0.03 / exact_sigma);
    EXPECT_NEAR(result.shortest[0].low, row.low, 0.5 + noise);
    EXPECT_NEAR(result.shortest[0].high, row.high, 0.5 + noise);
  }
}

TEST(PropagateByDraws, GivesTheGaugeBlockOfJcgm101) {
  // 9.5, table 10 and eq. 37, in nm: the deviation from 50 mm of the gauge of GUM H.1.
  const auto deviation = [](const VectorXd& x) -> VectorXd {
    return VectorXd::Constant(
        1, x(0) + x(1) + x(2) + x(3) - x(0) * (x(7) * (x(5) + x(6)) + x(4) * x(8)) - 50e6);
  };
  const MonteCarloResult result =
      draw(deviation,
           independent(
               {Distribution::student_t(50'000'623.0, 25.0, 18.0),
                Distribution::student_t(215.0, 6.0, 24.0), Distribution::student_t(0.0, 4.0, 5.0),
                Distribution::student_t(0.0, 7.0, 8.0), Distribution::rectangular(9.5e-6, 13.5e-6),
                Distribution::normal(-0.1, 0.2), Distribution::arcsine(-0.5, 0.5),
                Distribution::doubtful_rectangular(-1e-6, 1e-6, 0.1e-6),
                Distribution::doubtful_rectangular(-0.050, 0.050, 0.025)}),
           0.99);
  // Table 12: 838, 36, [745, 932]. Density at the end points as of a normal one, 0.0145/sigma.
  const double noise = end_point_noise(0.005, 0.0145 / 36.0);
  EXPECT_NEAR(result.value(0), 838.0, 0.5 + 36.0 * kPart);
  EXPECT_NEAR(result.sigma()(0), 36.0, 0.5 + 36.0 * kPart);
  EXPECT_NEAR(result.symmetric[0].low, 745.0, 0.5 + noise);
  EXPECT_NEAR(result.symmetric[0].high, 932.0, 0.5 + noise);
}

TEST(PropagateByDraws, GivesTheSameBytesOnAnyNumberOfThreads) {
  const Sampler inputs =
      independent({Distribution::normal(1.0, 0.1), Distribution::student_t(2.0, 0.1, 5.0)});
  const auto model = [](const VectorXd& x) -> VectorXd {
    return (VectorXd(2) << x(0) * x(1), std::exp(x(0))).finished();
  };
  for (const int digits : {0, 2}) {
    MonteCarloOptions options;
    options.trials = 123'456;
    options.digits = digits;
    options.n_threads = 1;
    const MonteCarloResult one = propagate_by_draws(model, inputs, options);
    options.n_threads = 2;
    const MonteCarloResult two = propagate_by_draws(model, inputs, options);
    EXPECT_EQ(one.n_trials, two.n_trials);
    EXPECT_EQ(one.value, two.value);
    EXPECT_EQ(one.covariance, two.covariance);
    for (std::size_t i = 0; i < 2; ++i) {
      EXPECT_EQ(one.symmetric[i].low, two.symmetric[i].low);
      EXPECT_EQ(one.shortest[i].high, two.shortest[i].high);
    }
    options.seed = 2;
    EXPECT_NE(one.value, propagate_by_draws(model, inputs, options).value);
  }
}

TEST(PropagateByDraws, DrawsUntilTheDigitsAskedForAreStable) {
  // Of 200 seeds, the value and the end points lie within the tolerance of the exact ones as often
  // as 2 standard deviations tell, 95 %; at least 90 % of 200 with a chance above 0.998.
  const auto model = [](const VectorXd& x) -> VectorXd { return x; };
  const Sampler inputs = independent({Distribution::normal(5.0, 1.0)});
  MonteCarloOptions options;
  options.trials = 10'000'000;
  options.digits = 2;  // tolerance 0.05
  int close = 0;
  Index most = 0;
  for (std::uint64_t seed = 1; seed <= 200; ++seed) {
    options.seed = seed;
    const MonteCarloResult result = propagate_by_draws(model, inputs, options);
    EXPECT_TRUE(result.stable);
    most = std::max(most, result.n_trials);
    close += std::abs(result.value(0) - 5.0) < 0.05 &&
             std::abs(result.symmetric[0].low - 5.0 + 1.95996) < 0.05 &&
             std::abs(result.symmetric[0].high - 5.0 - 1.95996) < 0.05;
  }
  EXPECT_GE(close, 180);
  options.digits = 3;  // a tenth of the tolerance: a hundred times the draws, but for their noise
  const MonteCarloResult finer = propagate_by_draws(model, inputs, options);
  EXPECT_TRUE(finer.stable);
  EXPECT_GT(finer.n_trials, 5 * most);
  EXPECT_NEAR(finer.symmetric[0].high, 5.0 + 1.95996, 0.005);
  options.trials = 20'000;
  EXPECT_FALSE(propagate_by_draws(model, inputs, options).stable);
}

TEST(PropagateByDraws, KeepsTheCovarianceOfJointlyNormalQuantities) {
  Estimates inputs = Estimates::independent(VectorXd::Ones(3), VectorXd::Ones(3));
  inputs.covariance << 4.0, 2.0, -1.0, 2.0, 1.0, -0.5, -1.0, -0.5, 9.0;  // the first two as one
  const MonteCarloResult result =
      draw([](const VectorXd& x) -> VectorXd { return x; }, jointly_normal(inputs));
  for (Index i = 0; i < 3; ++i) {
    for (Index j = 0; j < 3; ++j) {
      const double both =
          inputs.covariance(i, i) * inputs.covariance(j, j) + std::pow(inputs.covariance(i, j), 2);
      EXPECT_NEAR(result.covariance(i, j), inputs.covariance(i, j),
                  4.0 * std::sqrt(both / kDraws));  // 4 sigma of a covariance of normal ones
    }
  }
  inputs.covariance(0, 1) = inputs.covariance(1, 0) = 2.1;
  EXPECT_THROW(jointly_normal(inputs), InputError);
}

TEST(PropagateByDraws, RefusesBadOptionsAndModelsThatAreNotFinite) {
  const Sampler inputs = independent({Distribution::normal(0.0, 1.0)});
  const auto option = [&](auto change) {
    MonteCarloOptions options;
    change(options);
    propagate_by_draws(sum, inputs, options);
  };
  EXPECT_THROW(option([](MonteCarloOptions& o) { o.trials = 100; }), InputError);
  EXPECT_THROW(option([](MonteCarloOptions& o) { o.coverage = 1.0; }), InputError);
  EXPECT_THROW(option([](MonteCarloOptions& o) { o.digits = 5; }), InputError);
  EXPECT_THROW(option([](MonteCarloOptions& o) { o.tolerance_part = 0.0; }), InputError);
  EXPECT_THROW(option([](MonteCarloOptions& o) { o.n_threads = -1; }), InputError);
  const auto infinite = [](const VectorXd& x) -> VectorXd {
    return VectorXd::Constant(1, x(0) > 0.0 ? std::numeric_limits<double>::infinity() : 0.0);
  };
  EXPECT_THROW(propagate_by_draws(infinite, inputs), InputError);
}

}  // namespace
}  // namespace manoscope::numerics

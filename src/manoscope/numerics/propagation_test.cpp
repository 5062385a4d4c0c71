#include "manoscope/numerics/propagation.hpp"

#include <fmt/format.h>
#include <gtest/gtest.h>

#include <cmath>
#include <limits>
#include <string>

#include "manoscope/core/error.hpp"
#include "manoscope/numerics/least_squares.hpp"

namespace manoscope::numerics {
namespace {

using Eigen::VectorXd;

/// As a table prints it.
std::string printed(double value, int decimals) { return fmt::format("{:.{}f}", value, decimals); }

/// GUM (JCGM 100:2008) H.1, end gauge. Lengths in nm, temperatures in K. Inputs: l_s, mean d, d_1
/// and d_2 of the comparator, delta alpha, mean theta, its cycle, alpha_s, delta theta. Values:
/// H.1.3 and H.1.4, before they are rounded there: the mean of five repetitions with a pooled s of
/// 13 nm (24 degrees of freedom), 10 nm at 95 % with t = 2.57, 20 nm at three standard deviations.
Estimates end_gauge() {
  constexpr double kExact = std::numeric_limits<double>::infinity();
  VectorXd value(9), sigma(9), nu(9);
  value << 50'000'623.0, 215.0, 0.0, 0.0, 0.0, -0.1, 0.0, 11.5e-6, 0.0;
  sigma << 75.0 / 3.0, 13.0 / std::sqrt(5.0), 10.0 / 2.57, 20.0 / 3.0, 1e-6 / std::sqrt(3.0), 0.2,
      0.5 / std::sqrt(2.0), 2e-6 / std::sqrt(3.0), 0.05 / std::sqrt(3.0);
  nu << 18.0, 24.0, 5.0, 8.0, 50.0, kExact, kExact, kExact, 2.0;
  return Estimates::independent(value, sigma, nu);
}

VectorXd end_gauge_length(const VectorXd& x) {  // eq. H.3
  VectorXd l(1);
  l << x(0) + x(1) + x(2) + x(3) - x(0) * (x(4) * (x(5) + x(6)) + x(7) * x(8));
  return l;
}

TEST(PropagateLinearly, GivesThePrintedNumbersOfTheEndGaugeOfGumH1) {
  const Estimates inputs = end_gauge();
  const LinearResult length = propagate_linearly(end_gauge_length, inputs);
  EXPECT_EQ(printed(length.value(0), 0), "50000838");  // H.1.6
  const VectorXd part = length.sensitivity.row(0).transpose().cwiseAbs().cwiseProduct(
      inputs.covariance.diagonal().cwiseSqrt());
  EXPECT_EQ(printed(part(0), 0), "25");  // table H.1, contributions in nm
  EXPECT_EQ(printed(part(1), 1), "5.8");
  EXPECT_EQ(printed(part(2), 1), "3.9");
  EXPECT_EQ(printed(part(3), 1), "6.7");
  EXPECT_EQ(printed(part(4), 1), "2.9");
  EXPECT_NEAR(part(5) + part(6) + part(7), 0.0, 1e-6);  // of round-off: 1e-16 of 50 mm
  EXPECT_EQ(printed(part(8), 1), "16.6");
  EXPECT_EQ(printed(part.segment(1, 3).norm(), 1), "9.7");
  EXPECT_EQ(printed(length.covariance(0, 0), 0), "1002");  // H.1.4, nm^2
  EXPECT_EQ(printed(length.sigma()(0), 0), "32");
  EXPECT_EQ(printed(length.degrees_of_freedom(0), 1), "16.7");  // H.1.6
  EXPECT_EQ(printed(coverage_factor(0.99, std::floor(length.degrees_of_freedom(0))), 2), "2.92");
  EXPECT_EQ(printed(2.92 * 32.0, 0), "93");  // U_99, of the rounded factors

  // Effective degrees of freedom of the comparator's difference alone: 25.6 (H.1.6).
  const Estimates difference = Estimates::independent(
      inputs.value.segment(1, 3), inputs.covariance.diagonal().segment(1, 3).cwiseSqrt(),
      inputs.degrees_of_freedom.segment(1, 3));
  const auto sum = [](const VectorXd& x) -> VectorXd { return VectorXd::Constant(1, x.sum()); };
  EXPECT_EQ(printed(propagate_linearly(sum, difference).degrees_of_freedom(0), 1), "25.6");

  LinearOptions options;  // H.1.7: 11.7 nm and 1.7 nm of second order make it 34 nm
  options.second_order = true;
  const LinearResult second = propagate_linearly(end_gauge_length, inputs, options);
  EXPECT_EQ(printed(second.sigma()(0), 0), "34");
  EXPECT_EQ(printed(std::sqrt(second.covariance(0, 0) - length.covariance(0, 0)), 1),
            printed(std::hypot(11.7, 1.7), 1));
}

/// GUM H.2, table H.2: five simultaneous observations of V/V, I/mA, phi/rad.
Matrix impedance_observations() {
  Matrix rows(5, 3);
  rows << 5.007, 19.663, 1.0456,  //
      4.994, 19.639, 1.0438,      //
      5.005, 19.640, 1.0468,      //
      4.990, 19.685, 1.0428,      //
      4.999, 19.678, 1.0433;
  return rows;
}

VectorXd impedance(const VectorXd& x) {  // R, X, Z in ohm
  const double z = x(0) / (1e-3 * x(1));
  VectorXd made(3);
  made << z * std::cos(x(2)), z * std::sin(x(2)), z;
  return made;
}

Matrix impedance_sensitivity(const VectorXd& x) {
  const VectorXd y = impedance(x);
  Matrix rows(3, 3);
  rows << y(0) / x(0), -y(0) / x(1), -y(1),  //
      y(1) / x(0), -y(1) / x(1), y(0),       //
      y(2) / x(0), -y(2) / x(1), 0.0;
  return rows;
}

TEST(PropagateLinearly, GivesThePrintedNumbersOfResistanceAndReactanceOfGumH2) {
  const Estimates inputs = Estimates::mean_of(impedance_observations());
  EXPECT_EQ(printed(inputs.value(0), 4), "4.9990");  // table H.2
  EXPECT_EQ(printed(inputs.value(1), 4), "19.6610");
  EXPECT_EQ(printed(inputs.value(2), 5), "1.04446");
  EXPECT_EQ(printed(std::sqrt(inputs.covariance(0, 0)), 4), "0.0032");
  EXPECT_EQ(printed(std::sqrt(inputs.covariance(1, 1)), 4), "0.0095");
  EXPECT_EQ(printed(std::sqrt(inputs.covariance(2, 2)), 5), "0.00075");
  LinearResult same;
  same.covariance = inputs.covariance;
  EXPECT_EQ(printed(same.correlation()(0, 1), 2), "-0.36");
  EXPECT_EQ(printed(same.correlation()(0, 2), 2), "0.86");
  EXPECT_EQ(printed(same.correlation()(1, 2), 2), "-0.65");

  // Table H.3, approach 1: the law of propagation at the means.
  LinearOptions given;
  given.sensitivity = impedance_sensitivity;
  for (const LinearOptions& options : {LinearOptions{}, given}) {
    const LinearResult result = propagate_linearly(impedance, inputs, options);
    EXPECT_EQ(printed(result.value(0), 3), "127.732");
    EXPECT_EQ(printed(result.value(1), 3), "219.847");
    EXPECT_EQ(printed(result.value(2), 3), "254.260");
    EXPECT_EQ(printed(result.sigma()(0), 3), "0.071");
    // Printed is 0.295, as of approach 2 (below); at full precision this one is 0.29558.
    EXPECT_NEAR(result.sigma()(1), 0.295, 0.001);
    EXPECT_EQ(printed(result.sigma()(2), 3), "0.236");
    EXPECT_EQ(printed(result.correlation()(0, 1), 3), "-0.588");
    EXPECT_EQ(printed(result.correlation()(0, 2), 3), "-0.485");
    EXPECT_EQ(printed(result.correlation()(1, 2), 3), "0.993");
    EXPECT_NEAR(result.degrees_of_freedom(0), 4.0, 1e-9);  // all from the same five observations
    // Differences against derivatives: the stated error of the differences.
    EXPECT_LT((result.sensitivity - impedance_sensitivity(inputs.value)).norm(),
              1e-9 * result.sensitivity.norm());
  }

  // Table H.4, approach 2: each observation through the model, then their mean.
  Matrix through(5, 3);
  for (Index k = 0; k < 5; ++k) {
    through.row(k) = impedance(impedance_observations().row(k).transpose()).transpose();
  }
  const Estimates mean = Estimates::mean_of(through);
  same.covariance = mean.covariance;
  EXPECT_EQ(printed(mean.value(0), 3), "127.732");
  EXPECT_EQ(printed(mean.value(1), 3), "219.847");
  EXPECT_EQ(printed(mean.value(2), 3), "254.260");
  EXPECT_EQ(printed(same.sigma()(0), 3), "0.071");
  EXPECT_EQ(printed(same.sigma()(1), 3), "0.295");
  EXPECT_EQ(printed(same.sigma()(2), 3), "0.236");
  EXPECT_EQ(printed(same.correlation()(0, 1), 3), "-0.588");
  EXPECT_EQ(printed(same.correlation()(0, 2), 3), "-0.485");
  EXPECT_EQ(printed(same.correlation()(1, 2), 3), "0.993");
}

TEST(PropagateLinearly, GivesThePrintedNumbersOfTheThermometerOfGumH3) {
  VectorXd t(11), b(11), predicted(11), left(11);  // table H.6, degrees Celsius
  t << 21.521, 22.012, 22.512, 23.003, 23.507, 23.999, 24.513, 25.002, 25.503, 26.010, 26.511;
  b << -0.171, -0.169, -0.166, -0.159, -0.164, -0.165, -0.156, -0.157, -0.159, -0.161, -0.160;
  predicted << -0.1679, -0.1668, -0.1657, -0.1646, -0.1635, -0.1625, -0.1614, -0.1603, -0.1592,
      -0.1581, -0.1570;
  left << -0.0031, -0.0022, -0.0003, 0.0056, -0.0005, -0.0025, 0.0054, 0.0033, 0.0002, -0.0029,
      -0.0030;
  LeastSquaresProblem line;
  line.n_residuals = 11;
  line.start = VectorXd::Zero(2);
  line.residuals = [&](const VectorXd& y, VectorXd& residuals) {
    residuals = b.array() - y(0) - y(1) * (t.array() - 20.0);
    return true;
  };
  const auto fit = fit_least_squares(line);
  ASSERT_TRUE(fit && fit->covariance);
  for (Index k = 0; k < 11; ++k) {
    EXPECT_EQ(printed(b(k) - fit->residuals(k), 4), printed(predicted(k), 4));
    EXPECT_EQ(printed(fit->residuals(k), 4), printed(left(k), 4));
  }
  EXPECT_EQ(printed(fit->residual_sigma(), 4), "0.0035");  // H.3.2
  Estimates curve;
  curve.value = fit->parameters;
  curve.covariance = std::pow(fit->residual_sigma(), 2) * *fit->covariance;
  curve.covariance(0, 1) = curve.covariance(1, 0);
  curve.degrees_of_freedom = VectorXd::Constant(2, static_cast<double>(fit->n_dof));
  EXPECT_EQ(printed(curve.value(0), 4), "-0.1712");
  EXPECT_EQ(printed(curve.value(1), 5), "0.00218");
  EXPECT_EQ(printed(std::sqrt(curve.covariance(0, 0)), 4), "0.0029");
  EXPECT_EQ(printed(std::sqrt(curve.covariance(1, 1)), 5), "0.00067");
  LinearResult same;
  same.covariance = curve.covariance;
  EXPECT_EQ(printed(same.correlation()(0, 1), 3), "-0.930");

  const auto at_30 = [](const VectorXd& y) -> VectorXd {
    return VectorXd::Constant(1, y(0) + y(1) * (30.0 - 20.0));
  };
  const LinearResult correction = propagate_linearly(at_30, curve);
  EXPECT_EQ(printed(correction.value(0), 4), "-0.1494");  // H.3.4
  EXPECT_EQ(printed(correction.sigma()(0), 4), "0.0041");
  EXPECT_NEAR(correction.degrees_of_freedom(0), 9.0, 1e-9);
}

TEST(PropagateLinearly, AgreesWithExactVarianceToSecondOrderOfASquare) {
  // x^2 of a normal x has the variance 4 x^2 u^2 + 2 u^4; of x^3, order u^4: 9 x^4 u^2 + 36 x^2
  // u^4.
  const Estimates x =
      Estimates::independent(VectorXd::Constant(1, 3.0), VectorXd::Constant(1, 0.2));
  const auto powers = [](const VectorXd& in) -> VectorXd {
    return (VectorXd(2) << in(0) * in(0), in(0) * in(0) * in(0)).finished();
  };
  LinearOptions options;
  options.second_order = true;
  const LinearResult result = propagate_linearly(powers, x, options);
  const double u2 = 0.04;
  EXPECT_NEAR(result.covariance(0, 0), 4.0 * 9.0 * u2 + 2.0 * u2 * u2, 1e-9);
  EXPECT_NEAR(result.covariance(1, 1), 9.0 * 81.0 * u2 + 36.0 * 9.0 * u2 * u2, 1e-8);
}

TEST(PropagateLinearly, RefusesEstimatesThatDoNotFitTogether) {
  const auto sum = [](const VectorXd& x) -> VectorXd { return VectorXd::Constant(1, x.sum()); };
  const auto of = [](double covariance, double nu) {
    Estimates made = Estimates::independent(VectorXd::Ones(2), VectorXd::Ones(2));
    made.covariance(0, 1) = made.covariance(1, 0) = covariance;
    made.degrees_of_freedom = (VectorXd(2) << 5.0, nu).finished();
    return made;
  };
  EXPECT_NO_THROW(propagate_linearly(sum, of(0.5, 5.0)));
  EXPECT_THROW(propagate_linearly(sum, of(0.5, 6.0)), InputError);
  EXPECT_THROW(propagate_linearly(sum, of(0.0, 0.0)), InputError);
  Estimates lopsided = of(0.5, 5.0);
  lopsided.covariance(0, 1) = 0.4;
  EXPECT_THROW(propagate_linearly(sum, lopsided), InputError);
  LinearOptions options;
  options.second_order = true;
  EXPECT_THROW(propagate_linearly(sum, of(0.5, 5.0), options), InputError);
}

TEST(CoverageFactor, IsThatOfTheTableOfTheGum) {
  EXPECT_EQ(printed(coverage_factor(0.95, 4.0), 2), "2.78");  // GUM table G.2
  EXPECT_EQ(printed(coverage_factor(0.99, 1.0), 2), "63.66");
  EXPECT_EQ(printed(coverage_factor(0.9545, 10.0), 2), "2.28");
  EXPECT_EQ(printed(coverage_factor(0.95, std::numeric_limits<double>::infinity()), 3), "1.960");
  EXPECT_THROW(coverage_factor(1.0, 4.0), InputError);
  EXPECT_THROW(coverage_factor(0.95, 0.0), InputError);
}

TEST(NumericalTolerance, IsHalfAUnitOfTheLastMeaningfulDigit) {
  EXPECT_DOUBLE_EQ(numerical_tolerance(0.00035, 2), 0.5e-5);  // JCGM 101, 7.9.2, examples 1 and 2
  EXPECT_DOUBLE_EQ(numerical_tolerance(2.0, 1), 0.5);
  EXPECT_DOUBLE_EQ(numerical_tolerance(0.096, 1), 0.05);  // rounds to 0.1
  EXPECT_THROW(numerical_tolerance(0.0, 1), InputError);
}

}  // namespace
}  // namespace manoscope::numerics

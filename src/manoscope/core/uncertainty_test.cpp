#include "manoscope/core/uncertainty.hpp"

#include <gtest/gtest.h>

#include <cmath>

#include "manoscope/core/random.hpp"

namespace manoscope {
namespace {

Uncertainty example() {
  Uncertainty uncertainty;
  uncertainty.independent = Array1::LinSpaced(4, 0.5, 1.5);
  uncertainty.modes.push_back({"piston", "leveling", Array1::Constant(4, 2.0)});
  uncertainty.modes.push_back({"tilt", "leveling", Array1::LinSpaced(4, -1.0, 1.0)});
  return uncertainty;
}

TEST(Uncertainty, DiagonalOfTheCovarianceIsTheVariance) {
  const Uncertainty uncertainty = example();
  const Array1 variance = uncertainty.covariance().diagonal().array();
  EXPECT_LT((variance.sqrt() - uncertainty.standard()).abs().maxCoeff(), 1e-14);  // round-off
}

TEST(Uncertainty, CovarianceOfSumsEqualsTheMatrixProduct) {
  const Uncertainty uncertainty = example();
  const Array1 a = Array1::LinSpaced(4, 1.0, -2.0), b = Array1::LinSpaced(4, 0.0, 3.0);
  const double expected = a.matrix().transpose() * uncertainty.covariance() * b.matrix();
  EXPECT_NEAR(uncertainty.covariance(a, b), expected, 1e-12 * std::abs(expected));  // round-off
}

TEST(Uncertainty, CovarianceIsWhatDrawsOfItsVariablesShow) {
  const Uncertainty uncertainty = example();
  RandomStream stream(3, "draws");
  constexpr int kDraws = 40000;
  Matrix sum = Matrix::Zero(4, 4);
  for (int draw = 0; draw < kDraws; ++draw) {
    Array1 value(4);
    for (Index i = 0; i < 4; ++i) value[i] = uncertainty.independent[i] * stream.normal();
    for (const ErrorMode& mode : uncertainty.modes) value += mode.effect * stream.normal();
    sum += value.matrix() * value.matrix().transpose();
  }
  // Five standard errors of a sample covariance with entries up to 7.25.
  EXPECT_LT((sum / kDraws - uncertainty.covariance()).cwiseAbs().maxCoeff(),
            5.0 * std::sqrt(2.0 / kDraws) * 7.25);
}

TEST(Estimate, IsAsUncertainAsItsLeastKnownVariable) {
  const Estimate estimate{1.0, {{"noise", "", std::nan("")}, {"gain", "", 3.0}}};
  EXPECT_TRUE(std::isnan(estimate.standard_uncertainty()));
}

TEST(Estimate, SharesOnlyVariablesOfTheSameName) {
  const Estimate a{1.0, {{"gain", "gauge", 3.0}, {"zero", "gauge", 4.0}}};
  const Estimate b{2.0, {{"gain", "gauge", -2.0}, {"h0", "geometry", 1.0}}};
  EXPECT_DOUBLE_EQ(a.standard_uncertainty(), 5.0);
  EXPECT_DOUBLE_EQ(covariance(a, b), -6.0);
}

}  // namespace
}  // namespace manoscope

#include "manoscope/calibration/shape_stretch.hpp"

#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <vector>

#include "manoscope/core/random.hpp"
#include "manoscope/numerics/chi_square.hpp"

namespace manoscope::calibration {
namespace {

constexpr Index kBins = 16;
constexpr double kNoise = 4e-9;

/// A membrane of 20 um, without misfit.
StretchShape membrane(Index n = kBins, double smooth = 0.0) {
  StretchShape shape;
  shape.z = BinVector(n);
  for (Index i = 0; i < n; ++i) {
    shape.z[i] = 0.96 * (2.0 * (static_cast<double>(i) + 0.5) / static_cast<double>(n) - 1.0);
  }
  shape.residual = BinVector::Zero(n);
  shape.sigma = BinVector::Constant(n, kNoise);
  shape.phi = (1.5 * (1.0 - shape.z.array().square())).matrix();
  shape.slope = -6e-5 * shape.z;
  shape.smooth = smooth;
  return shape;
}

TEST(EvenPolynomials, AreOrthonormal) {
  const auto even = even_polynomials(membrane().z);
  const Eigen::Matrix4d products = even.transpose() * even / static_cast<double>(kBins);
  EXPECT_LT((products - Eigen::Matrix4d::Identity()).cwiseAbs().maxCoeff(), 1e-13);
}

TEST(StretchMisfit, CountsWhatIsFree) {
  EXPECT_NEAR(stretch_misfit(membrane()).dof, kBins - 2.0, 1e-9);
  // phi is an even polynomial of the second degree: the four cost three more.
  EXPECT_NEAR(stretch_misfit(membrane(kBins, 1e-4)).dof, kBins - 5.0, 1e-6);
  const double partly = stretch_misfit(membrane(kBins, kNoise)).dof;
  EXPECT_GT(partly, kBins - 5.0);
  EXPECT_LT(partly, kBins - 2.0);
  // A flat wall has no slope that could be shifted.
  StretchShape flat = membrane();
  flat.slope.setZero();
  EXPECT_NEAR(stretch_misfit(flat).dof, kBins - 1.0, 1e-9);
}

TEST(StretchMisfit, DoesNotMindTheAverageTheShiftAndWhatIsAllowed) {
  StretchShape shape = membrane(kBins, 1e-5);
  shape.residual = 3e-8 * shape.phi + 2e-3 * shape.slope;
  shape.residual += 2e-8 * even_polynomials(shape.z).col(2);
  const StretchMisfit misfit = stretch_misfit(shape);
  // (20 nm)^2 n / (10 um / 2)^2: what is left of the polynomial.
  EXPECT_LT(misfit.chi_square, 1e-3);
  EXPECT_EQ(misfit.excess, 0.0);
}

TEST(StretchMisfit, IsChiSquareOfItsDegreesOfFreedomUnderNoise) {
  RandomStream random(11, "stretch");
  for (const double smooth : {0.0, 1e-6}) {
    std::vector<double> chances;
    for (int trial = 0; trial < 4000; ++trial) {
      StretchShape shape = membrane(kBins, smooth);
      for (double& value : shape.residual) value = kNoise * random.normal();
      const StretchMisfit misfit = stretch_misfit(shape);
      chances.push_back(numerics::chi_square_tail(misfit.chi_square, misfit.dof));
    }
    std::sort(chances.begin(), chances.end());
    double farthest = 0.0;  // from uniform: Kolmogorov and Smirnov
    for (std::size_t i = 0; i < chances.size(); ++i) {
      const double expected = (static_cast<double>(i) + 0.5) / static_cast<double>(chances.size());
      farthest = std::max(farthest, std::abs(chances[i] - expected));
    }
    EXPECT_LT(farthest, 1.95 / std::sqrt(4000.0)) << smooth;  // one in a thousand
  }
}

TEST(StretchMisfit, SeesABumpOfTenTimesTheNoiseInOneBinAndItsSize) {
  for (Index bin = 0; bin < kBins; ++bin) {
    StretchShape shape = membrane(kBins, 2.0 * kNoise);
    shape.residual[bin] = 10.0 * kNoise;
    const StretchMisfit misfit = stretch_misfit(shape);
    EXPECT_LT(numerics::chi_square_tail(misfit.chi_square, misfit.dof), 1e-3) << bin;
    // Its root mean square, but for what the free shapes take of a bump: most at the side.
    const double size = 10.0 * kNoise / std::sqrt(static_cast<double>(kBins));
    EXPECT_LT(misfit.excess, 1.1 * size);
    EXPECT_GT(misfit.excess, 0.5 * size) << bin;
  }
}

TEST(MovedAverage, IsThatOfADeformationOfFewBins) {
  for (const double height : {-300e-9, 80e-9}) {
    for (const Index first : {1, 5, 10}) {
      // Smooth shapes of a thirtieth of the bump: more, and they could be most of its average.
      StretchShape shape = membrane(kBins, std::abs(height) / 30.0);
      BinVector bump = BinVector::Zero(kBins);
      bump.segment(first, 4).setConstant(height);
      // The check sees the bump minus what its average makes the calibrated shape be.
      shape.residual = bump - bump.mean() * shape.phi;
      // The shift and the polynomials take a part; the rest, to a third.
      EXPECT_NEAR(moved_average(shape) / bump.mean(), 1.0, 0.33) << height << ' ' << first;
    }
  }
}

}  // namespace
}  // namespace manoscope::calibration

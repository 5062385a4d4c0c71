#include "manoscope/calibration/shape_survey.hpp"

#include <gtest/gtest.h>

#include <cmath>

#include "manoscope/core/flags.hpp"

namespace manoscope::calibration {
namespace {

constexpr double kWidth = 1.7e-3;

/// Cells of zeta = f(x) times a clamped plate.
template <class F>
CrossSections plate(const F& f) {
  CrossSections cells;
  cells.x = Array1::LinSpaced(40, 0.1e-3, 8e-3);
  cells.z = Array1::LinSpaced(16, -0.45 * kWidth, 0.45 * kWidth);
  cells.zeta = Array2(16, 40);
  for (Index b = 0; b < 16; ++b) {
    const double u = 2.0 * cells.z[b] / kWidth;
    for (Index j = 0; j < 40; ++j) {
      cells.zeta(b, j) = f(cells.x[j]) * (1.0 - u * u) * (1.0 - u * u);
    }
  }
  cells.sigma = Array2::Constant(16, 40, 1e-9);
  cells.flags = Flags2::Zero(16, 40);
  return cells;
}

TEST(Survey, TellsTheCurvatureOfAParabola) {
  const CrossSections cells = plate([](double x) { return 1e-5 - 3.0 * x * x; });
  const SurveyedMap surveyed = survey({0.0, &cells}, kWidth);
  const double mean = surveyed.average[7] / (1e-5 - 3.0 * cells.x[7] * cells.x[7]);
  for (Index j = 0; j < cells.x.size(); ++j) {
    EXPECT_NEAR(surveyed.curvature[j] / (-6.0 * mean), 1.0,
                1e-9);  // round-off over steps of 0.2 mm
  }
}

TEST(Survey, BridgesBadCellsAndTellsWhereTooFewAreGood) {
  const auto flat = [](double) { return 20e-6; };
  const CrossSections whole = plate(flat);
  CrossSections holed = whole;
  for (const Index b : {0, 5, 6, 12}) holed.flags(b, 3) = PixelFlag::no_data;
  for (Index b = 0; b < 6; ++b) holed.flags(b, 20) = PixelFlag::no_data;
  holed.zeta = (holed.flags == 0).select(holed.zeta, 0.0);
  const SurveyedMap surveyed = survey({0.0, &holed}, kWidth);
  // A cubic errs by at most the fourth derivative times the product of the distances from its four
  // points over 24: with points h apart 4 h^4 in a gap of two, 15 h^4 beyond the outermost of four.
  // The plate's fourth derivative is 384 crest / w^4.
  const double h = whole.z[1] - whole.z[0];
  const double bound = 384.0 * 20e-6 / std::pow(kWidth, 4) * 15.0 * std::pow(h, 4) / 24.0;
  EXPECT_LT((surveyed.whole.col(3) - whole.zeta.col(3)).abs().maxCoeff(), bound);
  EXPECT_GT((surveyed.whole.col(3) - whole.zeta.col(3)).abs().maxCoeff(), 0.0);
  EXPECT_TRUE(std::isnan(surveyed.average[20]));
  EXPECT_TRUE(std::isnan(surveyed.whole(10, 20)));
  // One missing stretch among five does not matter to the curvature.
  EXPECT_NEAR(surveyed.curvature[21], 0.0, 1e-9);
}

TEST(SlopeAcross, IsExactForMeansOfAQuartic) {
  const double bin = 0.1;
  const auto whole = [](double z) { return z * z - 0.5 * z * z * z + 0.2 * std::pow(z, 4); };
  const auto integral = [](double z) {
    return z * z * z / 3.0 - 0.125 * std::pow(z, 4) + 0.04 * std::pow(z, 5);
  };
  BinVector means(12);
  for (Index b = 0; b < 12; ++b) {
    const double low = -0.6 + bin * static_cast<double>(b);
    means[b] = (integral(low + bin) - integral(low)) / bin;
  }
  const BinVector slope = slope_across(means, bin);
  for (Index b = 0; b < 12; ++b) {
    const double low = -0.6 + bin * static_cast<double>(b);
    // Of z^4 the cubics miss -0.8 bin^4 at every inner edge, 1.2 at the last but one, -4.8 at the
    // last.
    const double missed = b == 0 || b == 11 ? 6.0 : (b == 1 || b == 10 ? 2.0 : 0.0);
    const double bound = 0.2 * missed * std::pow(bin, 3) + 1e-12;
    EXPECT_NEAR(slope[b], (whole(low + bin) - whole(low)) / bin, bound) << b;
  }
}

}  // namespace
}  // namespace manoscope::calibration

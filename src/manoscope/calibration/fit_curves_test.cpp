#include "manoscope/calibration/fit_curves.hpp"

#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <limits>

#include "manoscope/core/error.hpp"
#include "manoscope/core/random.hpp"
#include "tests/support/local_wall.hpp"
#include "tests/support/quiet_traps.hpp"

namespace manoscope::calibration {
namespace {

using test::even;
using test::exact_profile;
using test::level;
using test::log_spaced;
using test::one_station;

template <class F>
std::vector<Level> sampled(const std::vector<double>& pressures, F&& zeta_of) {
  std::vector<double> zetas;
  for (const double p : pressures) zetas.push_back(zeta_of(p));
  return one_station(pressures, zetas);
}

/// Largest error of the deflection between the levels, as a pressure, Pa.
template <class F>
double worst_error(const std::vector<double>& pressures, F&& zeta_of, double from, double to) {
  const auto curves = fit_curves(sampled(pressures, zeta_of));
  const ConstitutiveCurve& curve = curves.curves.at(0).value();
  double worst = 0.0;
  for (double p = from; p <= to; p += (to - from) / 997.0) {
    worst = std::max(worst, std::abs(curve.zeta(p) - zeta_of(p)) / curve.slope(p));
  }
  return worst;
}

TEST(FitCurves, ConvergesAtThirdOrderOnACubeRootWall) {
  const auto zeta = [](double p) { return 1e-6 * (std::cbrt(p + 3e3) - std::cbrt(3e3)); };
  const auto worst = [&](int n) { return worst_error(even(n, 0.0, 48e3), zeta, 8e3, 40e3); };
  const double coarse = worst(17), middle = worst(33), fine = worst(65);
  // Third order of the interpolant; the fitted p_s moves a little with the levels.
  EXPECT_GT(std::log2(coarse / middle), 2.5);
  EXPECT_GT(std::log2(middle / fine), 2.5);
  EXPECT_LT(coarse, 0.001 * 48e3);
}

TEST(FitCurves, FollowsAMembraneThroughAFewLogSpacedLevels) {
  const test::LocalWall membrane;
  const double x = 0.5 * membrane.length;
  const auto zeta = [&](double p) { return membrane.zeta(x, p); };
  // Straight in the fitted coordinate but for the grid step of p_s.
  EXPECT_LT(worst_error(log_spaced(12, 100.0, 50e3), zeta, 0.0, 50e3), 0.0005 * 50e3);
}

TEST(FitCurves, IsExactOnALinearWall) {
  const auto zeta = [](double p) { return 1e-9 * p - 3e-6; };
  // The coordinate bends by 1e-4 of the range at most, which the cubic follows.
  EXPECT_LT(worst_error(even(21, 0.0, 50e3), zeta, 0.0, 50e3), 1e-6 * 50e3);
  EXPECT_LT(worst_error(log_spaced(21, 100.0, 50e3), zeta, 0.0, 50e3), 1e-5 * 50e3);
  EXPECT_LT(worst_error(even(15, -20e3, 20e3), zeta, -20e3, 20e3), 1e-6 * 40e3);
}

TEST(FitCurves, DoesNotDependOnTheOrderOfLevels) {
  const auto zeta = [](double p) { return 1e-6 * std::cbrt(p + 3e3); };
  auto levels = sampled(log_spaced(14, 100.0, 50e3), zeta);
  const auto expected = fit_curves(levels);
  std::reverse(levels.begin(), levels.end());
  std::swap(levels[2], levels[9]);
  const auto curves = fit_curves(levels);
  for (double p = 10.0; p < 50e3; p *= 1.3) {
    EXPECT_EQ(curves.curves[0]->zeta(p), expected.curves[0]->zeta(p));
  }
}

std::vector<std::size_t> knot_sizes(const ConstitutiveCurve& curve) {
  std::vector<std::size_t> sizes;
  for (const auto& knot : curve.knots()) sizes.push_back(knot.levels.size());
  return sizes;
}

TEST(FitCurves, PoolsLevelsWhoseLabelsCannotBeToldApart) {
  // Labels of 10 Pa differ by 14.1 Pa standard; two of that is 28.3 Pa.
  const std::vector<double> pressures{200.0, 1000.0, 1028.0, 2000.0, 2029.0, 9000.0};
  std::vector<double> zetas;
  for (const double p : pressures) zetas.push_back(1e-9 * p);
  const auto curves = fit_curves(one_station(pressures, zetas, 0.0, 10.0));
  const auto& knots = curves.curves[0]->knots();
  EXPECT_EQ(knot_sizes(*curves.curves[0]), (std::vector<std::size_t>{1, 2, 1, 1, 1}));
  EXPECT_DOUBLE_EQ(knots[1].pressure, 1014.0);
  EXPECT_DOUBLE_EQ(knots[1].zeta, 1.014e-6);
}

TEST(FitCurves, DoesNotPoolAVentedLevelForItsLabelIsExact) {
  auto levels = one_station({0.0, 15.0, 5e3, 9e3}, {0.0, 2e-8, 4e-6, 6e-6}, 0.0, 10.0);
  levels[0].uncertainty = Pressure{};
  EXPECT_EQ(fit_curves(levels).curves[0]->knots().size(), 4U);
}

TEST(FitCurves, SurvivesLevelsSwappedByNoiseOnTheirLabels) {
  // True pressures 1000 and 1010, read as 1012 and 1001: deflection falls between the labels.
  const auto levels = one_station({0.0, 500.0, 1012.0, 1001.0, 2000.0},
                                  {0.0, 0.5e-6, 1.00e-6, 1.01e-6, 2e-6}, 1e-9, 10.0);
  const auto curve = *fit_curves(levels).curves[0];
  EXPECT_EQ(curve.pressures(1.005e-6).size(), 1U);
  EXPECT_NEAR(curve.pressures(1.005e-6)[0], 1005.0, 10.0 / std::sqrt(2.0));  // label of the pair
}

TEST(FitCurves, PoolsAFallWithinTheNoiseAndKeepsOneBeyondIt) {
  const std::vector<double> pressures{0.0, 1e3, 2e3, 3e3, 4e3};
  const double sigma = 10e-9;  // of a difference: 14.1 nm; three of that is 42.4 nm
  for (const double fall : {0.0, 20e-9, 42e-9, 43e-9, 500e-9}) {
    const auto levels = one_station(pressures, {0.0, 1e-6, 1e-6 - fall, 2e-6, 3e-6}, sigma);
    const auto curve = *fit_curves(levels).curves[0];
    const bool real = fall > 42.5e-9;
    EXPECT_EQ(curve.knots().size(), real ? 5U : 4U) << fall;
    EXPECT_EQ(curve.pressures(1e-6 - 0.5 * fall).size(), real ? 3U : 1U) << fall;
  }
}

TEST(FitCurves, CountsNoiseOfLabelsWhenItJudgesAFall) {
  // Slope 1 nm/Pa: 100 Pa on a label is 100 nm. The labels are too far apart to be pooled as such.
  const std::vector<double> pressures{0.0, 1e3, 1.3e3, 2.3e3, 3.3e3};
  const std::vector<double> zetas{0.0, 1.1e-6, 1.0e-6, 2.3e-6, 3.3e-6};
  EXPECT_EQ(fit_curves(one_station(pressures, zetas, 1e-9, 100.0)).curves[0]->knots().size(), 4U);
  EXPECT_EQ(fit_curves(one_station(pressures, zetas, 1e-9, 5.0)).curves[0]->knots().size(), 5U);
}

TEST(FitCurves, KeepsARealFoldOverSeveralLevels) {
  const auto zeta = [](double p) { return 1e-6 * (p / 1e3 - 2.0 * std::sin(p / 1e3)); };
  const auto pressures = even(31, 0.0, 9e3);
  std::vector<double> zetas;
  for (const double p : pressures) zetas.push_back(zeta(p));
  const auto curve = *fit_curves(one_station(pressures, zetas, 20e-9)).curves[0];
  EXPECT_EQ(curve.pressures(zeta(6.3e3)).size(), 3U);  // dz/dp < 0 around 2 pi thousand pascal
  EXPECT_EQ(curve.pressures(zeta(3.1e3)).size(), 1U);
  // The first fall, from zero, is as real: no knot is missing.
  EXPECT_EQ(curve.knots().size(), pressures.size());
}

TEST(FitCurves, JudgesEachStationOnItsOwn) {
  const Array1 x = Array1::LinSpaced(2, 1e-3, 2e-3);
  std::vector<Level> levels;
  for (int k = 0; k < 6; ++k) {
    Profile profile = exact_profile(x, [&](double) { return 1e-6 * k; });
    profile.uncertainty.independent << 10e-9, 1e-9;
    if (k == 3) profile.zeta.setConstant(2e-6 - 20e-9);
    levels.push_back(level("h" + std::to_string(k), 1e3 * k, 0.0, profile));
  }
  const auto curves = fit_curves(levels);
  EXPECT_EQ(curves.curves[0]->knots().size(), 5U);
  EXPECT_EQ(curves.curves[1]->knots().size(), 6U);
}

TEST(FitCurves, SeldomTakesNoiseForAFold) {
  // Three adjacent levels see no change of deflection at all; 2000 stations of pure noise there.
  constexpr Index kStations = 2000;
  const Array1 x = Array1::LinSpaced(kStations, 1e-3, 9e-3);
  const std::vector<double> truth{0.0, 1e-6, 2e-6, 2e-6, 2e-6, 3e-6, 4e-6};
  RandomStream stream(11, "noise");
  std::vector<Level> levels;
  for (std::size_t k = 0; k < truth.size(); ++k) {
    Profile profile = exact_profile(x, [&](double) { return truth[k] + 10e-9 * stream.normal(); });
    profile.uncertainty.independent.setConstant(10e-9);
    levels.push_back(level("h" + std::to_string(k), 1e3 * static_cast<double>(k), 0.0, profile));
  }
  const auto curves = fit_curves(levels);
  int folds = 0;
  for (const auto& curve : curves.curves) {
    const auto& knots = curve->knots();
    for (std::size_t j = 1; j < knots.size(); ++j) folds += knots[j].zeta <= knots[j - 1].zeta;
  }
  // Three differences, one-sided 3 sigma each: 3 x 0.00135 x 2000 = 8 expected, 5 sigma above it.
  EXPECT_LE(folds, 8 + 5 * 3);
}

TEST(FitCurves, LeavesOutLevelsWithoutDataAtAStation) {
  const auto zeta = [](double p) { return 1e-6 * std::cbrt(p + 3e3); };
  auto levels = sampled(even(9, 0.0, 16e3), zeta);
  for (const std::size_t k : {0, 4, 8}) {
    levels[k].profile.flags[0] = StationFlag::no_data;
    levels[k].profile.zeta[0] = 0.0;
  }
  const auto curve = *fit_curves(levels).curves[0];
  EXPECT_EQ(curve.knots().size(), 6U);
  EXPECT_DOUBLE_EQ(curve.lowest(), 2e3);
  EXPECT_DOUBLE_EQ(curve.highest(), 14e3);
  EXPECT_EQ(curve.knots()[3].levels, std::vector<Index>{5});
  EXPECT_NEAR(curve.zeta(8e3) / zeta(8e3), 1.0, 1e-3);
}

TEST(FitCurves, HasNoCurveWhereFewerThanTwoLevelsCount) {
  auto levels = sampled(even(5, 0.0, 8e3), [](double p) { return 1e-9 * p; });
  for (std::size_t k = 2; k < 5; ++k) levels[k].profile.flags[0] = StationFlag::no_data;
  EXPECT_TRUE(fit_curves(levels).curves[0].has_value());  // two: a line
  EXPECT_NEAR(fit_curves(levels).curves[0]->zeta(1e3), 1e-6, 1e-10);
  levels[1].profile.flags[0] = StationFlag::no_data;
  EXPECT_FALSE(fit_curves(levels).curves[0].has_value());
  levels[0].profile.flags[0] = StationFlag::no_data;
  EXPECT_FALSE(fit_curves(levels).curves[0].has_value());
}

TEST(FitCurves, HasNoCurveForAWallThatDoesNotMove) {
  const auto levels = sampled(even(5, 0.0, 8e3), [](double) { return 0.0; });
  EXPECT_FALSE(fit_curves(levels).curves[0].has_value());
}

TEST(FitCurves, TakesEveryFallForRealWhereNoUncertaintyIsGiven) {
  const auto levels =
      one_station({0.0, 1e3, 2e3, 3e3, 4e3, 5e3}, {0.0, 2e-6, 2e-6 - 1e-15, 2.5e-6, 2.5e-6, 3e-6});
  const auto curve = *fit_curves(levels).curves[0];
  EXPECT_EQ(knot_sizes(curve), (std::vector<std::size_t>{1, 1, 1, 2, 1}));  // equal is no fall
  EXPECT_LT(curve.knots()[2].zeta, curve.knots()[1].zeta);
}

TEST(ExpectCurves, KeepReadingsToComeApartAndPoolTheirKnots) {
  const auto zeta = [](double p) { return 2e-9 * p; };
  std::vector<double> zetas;
  const std::vector<double> pressures{0.0, 1e3, 2e3, 2e3, 3e3, 3e3, 3e3};
  for (const double p : pressures) zetas.push_back(zeta(p));
  const auto levels = one_station(pressures, zetas, 1e-9, 10.0);
  const auto curves = expect_curves(levels);  // one station: no joint estimate
  EXPECT_EQ(curves.levels.size(), 7u);
  EXPECT_EQ(knot_sizes(*curves.curves[0]), (std::vector<std::size_t>{1, 1, 2, 3}));
  // fit_curves() has merged what bears one label.
  EXPECT_EQ(fit_curves(levels).levels.size(), 4u);
  // u bends by 1e-5 of itself where p_s is a hundred times the range.
  EXPECT_NEAR(curves.curves[0]->zeta(2.5e3), zeta(2.5e3), 1e-5 * zeta(2.5e3));
  EXPECT_THROW(expect_curves(one_station({0.0, 1e3, 1e3}, {0.0, 1e-6, 1e-6})), InputError);
}

TEST(FitCurves, RefusesOptionsOutOfRange) {
  const test::QuietTraps quiet;
  const auto levels = sampled(even(5, 0.0, 8e3), [](double p) { return 1e-9 * p; });
  for (const double bad : {-1.0, std::numeric_limits<double>::quiet_NaN()}) {
    for (const bool first : {true, false}) {
      FitCurvesOptions options;
      (first ? options.pooling : options.fold_significance) = bad;
      try {
        fit_curves(levels, options);
        ADD_FAILURE() << "no error";
      } catch (const InputError& error) {
        EXPECT_EQ(error.where(), first ? "--pooling" : "--fold-significance");
      }
    }
  }
}

}  // namespace
}  // namespace manoscope::calibration

#include "manoscope/validation/error_split.hpp"

#include <gtest/gtest.h>

#include <cmath>
#include <limits>

#include "manoscope/calibration/fit_curves.hpp"
#include "manoscope/core/random.hpp"
#include "tests/support/local_wall.hpp"

namespace manoscope::validation {
namespace {

constexpr double kNan = std::numeric_limits<double>::quiet_NaN();

/// A local wall at 40 stations, 12 levels whose labels and maps err, one run.
struct Case {
  test::LocalWall wall;
  Array1 x = wall.stations(40);
  std::vector<double> pressures = test::log_spaced(12, 50.0, 20e3);
  SplitCurves curves;
  SplitInput run;

  explicit Case(double label_noise, double map_noise) {
    RandomStream stream(3, "split");
    std::vector<calibration::Level> measured, relabelled, ideal;
    std::vector<std::vector<TrueCurve::Node>> nodes(40);
    for (std::size_t k = 0; k < pressures.size(); ++k) {
      const double p = pressures[k], label = k == 0 ? 0.0 : p + label_noise * stream.normal();
      const Profile still = test::exact_profile(x, [&](double at) { return wall.zeta(at, p); });
      Profile seen = still;
      for (Index i = 0; i < 40; ++i) seen.zeta[i] += map_noise * stream.normal();
      const std::string name = "h" + std::to_string(k);
      measured.push_back(test::level(name, label, 0.0, seen));
      relabelled.push_back(test::level(name, p, 0.0, seen));
      ideal.push_back(test::level(name, p, 0.0, still));
      for (Index i = 0; i < 40; ++i) {
        const double zeta = still.zeta[i];
        nodes[static_cast<std::size_t>(i)].push_back(
            {p, zeta, wall.taper(x[i]) / (wall.stiffness + 3.0 * wall.stretching * zeta * zeta)});
      }
    }
    curves.measured = calibration::fit_curves(measured);
    curves.relabelled = calibration::fit_curves(relabelled);
    curves.true_curves = calibration::fit_curves(ideal);
    for (const auto& of_station : nodes) curves.exact.emplace_back(of_station);
    run.true_pressure = Array1::LinSpaced(40, 15e3, 400.0);
    run.true_deflection = run.deflection = run.pressure = Array1(40);
    run.answered = Flags1::Ones(40);
    for (Index i = 0; i < 40; ++i) {
      run.true_deflection[i] = wall.zeta(x[i], run.true_pressure[i]);
      run.deflection[i] = run.true_deflection[i] + map_noise * stream.normal();
      run.pressure[i] =
          curves.measured.curves[static_cast<std::size_t>(i)]->pressures(run.deflection[i])[0];
    }
    run.local_pressure = run.pressure;
  }
};

TEST(ErrorSplit, AddsUpToTheErrorAtEveryStation) {
  const Case test(10.0, 20e-9);
  const ErrorSplit split = split_error(test.run, test.curves);
  ASSERT_TRUE((split.split != 0).all());
  const Array1 error = test.run.pressure - test.run.true_pressure;
  const Array1 sum = split.labels + split.maps + split.curve_shape + split.locality;
  EXPECT_LT((sum - error).abs().maxCoeff(), 1e-10);  // round-off of 15 kPa in four differences
  EXPECT_LT((split.curve_shape + split.locality - split.curve_shape_and_locality).abs().maxCoeff(),
            1e-10);
  EXPECT_GT(split.labels.abs().maxCoeff(), 1.0);
  EXPECT_GT(split.maps.abs().maxCoeff(), 1.0);
}

TEST(ErrorSplit, OfWrongLabelsAloneIsLabelsAndCurveShape) {
  const Case test(10.0, 0.0);
  const ErrorSplit split = split_error(test.run, test.curves);
  EXPECT_GT(split.labels.abs().maxCoeff(), 1.0);
  EXPECT_EQ(split.maps.abs().maxCoeff(), 0.0);
  // p is cubic in zeta: the interpolant is exact to the round-off of 20 kPa.
  EXPECT_LT(split.locality.abs().maxCoeff(), 1e-8);
}

TEST(ErrorSplit, OfNoisyMapsAloneHasNoLabels) {
  const Case test(0.0, 20e-9);
  const ErrorSplit split = split_error(test.run, test.curves);
  EXPECT_EQ(split.labels.abs().maxCoeff(), 0.0);
  EXPECT_GT(split.maps.abs().maxCoeff(), 1.0);
  EXPECT_LT(split.locality.abs().maxCoeff(), 1e-8);
}

TEST(ErrorSplit, GivesToLocalityWhatTheStaticWallDoesNotExplain) {
  Case test(10.0, 20e-9);
  const ErrorSplit before = split_error(test.run, test.curves);
  test.run.true_pressure -= 7.0;  // under p(x) the wall stands where 7 Pa more would put it at rest
  const ErrorSplit split = split_error(test.run, test.curves);
  EXPECT_LT((split.locality - 7.0).abs().maxCoeff(), 1e-8);
  EXPECT_TRUE((split.labels == before.labels).all());
  EXPECT_TRUE((split.maps == before.maps).all());
  EXPECT_TRUE((split.curve_shape == before.curve_shape).all());
}

TEST(ErrorSplit, TellsApartWhatHeedingTheNeighboursChanged) {
  Case test(10.0, 20e-9);
  const ErrorSplit before = split_error(test.run, test.curves);
  EXPECT_EQ(before.neighbourhood.abs().maxCoeff(), 0.0);
  test.run.pressure += Array1::LinSpaced(40, -3.0, 5.0);
  const ErrorSplit split = split_error(test.run, test.curves);
  EXPECT_LT((split.neighbourhood - Array1::LinSpaced(40, -3.0, 5.0)).abs().maxCoeff(), 1e-10);
  EXPECT_TRUE((split.labels == before.labels).all());
  const Array1 sum =
      split.neighbourhood + split.labels + split.maps + split.curve_shape + split.locality;
  EXPECT_LT((sum - test.run.pressure + test.run.true_pressure).abs().maxCoeff(), 1e-10);
}

TEST(ErrorSplit, GivesOneSumWhereTheComplianceIsUnknown) {
  Case test(10.0, 20e-9);
  const ErrorSplit known = split_error(test.run, test.curves);
  test.curves.exact.clear();
  const ErrorSplit split = split_error(test.run, test.curves);
  EXPECT_EQ(split.locality.size(), 0);
  EXPECT_EQ(split.curve_shape.size(), 0);
  EXPECT_TRUE((split.curve_shape_and_locality == known.curve_shape_and_locality).all());
  const SplitSummary summary = summarise(split, Flags1::Ones(40), test.run.answered);
  EXPECT_FALSE(summary.locality);
  EXPECT_FALSE(summary.curve_shape);
}

TEST(ErrorSplit, LeavesOutStationsThatAnyReadingCannotAnswer) {
  Case test(10.0, 20e-9);
  test.run.answered[3] = 0;
  test.run.pressure[3] = test.run.local_pressure[3] = test.run.deflection[3] =
      kNan;                           // a NaN that is compared traps
  test.run.true_deflection[5] = 1.0;  // beyond every level
  test.run.local_pressure[7] += 1.0;  // not what these curves give
  test.curves.relabelled.curves[9].reset();
  const ErrorSplit split = split_error(test.run, test.curves);
  for (const Index i : {3, 5, 7, 9}) {
    EXPECT_EQ(split.split[i], 0) << i;
    EXPECT_EQ(split.maps[i], 0.0) << i;
  }
  EXPECT_EQ((split.split != 0).count(), 36);
  Flags1 inside = Flags1::Zero(40);
  inside.head(8).setOnes();
  const SplitSummary summary = summarise(split, inside, test.run.answered);
  EXPECT_EQ(summary.n_split, 5);     // 0, 1, 2, 4, 6
  EXPECT_EQ(summary.n_left_out, 2);  // 5 and 7; 3 had no answer to split
}

TEST(ErrorSplit, IsSummedUpOverTheStretch) {
  ErrorSplit split;
  split.split = Flags1::Ones(4);
  split.neighbourhood = Array1::Zero(4);
  split.labels = Array1{{3.0, -4.0, 0.0, 99.0}};
  split.maps = Array1{{-3.0, 4.0, 6.0, 99.0}};
  split.curve_shape_and_locality = Array1::Constant(4, 1.0);
  split.curve_shape = Array1::Constant(4, 3.0);
  split.locality = Array1::Constant(4, -2.0);
  Flags1 inside = Flags1::Ones(4);
  inside[3] = 0;
  const SplitSummary found = summarise(split, inside, Flags1::Ones(4));
  EXPECT_EQ(found.n_split, 3);
  EXPECT_DOUBLE_EQ(found.labels.mean, -1.0 / 3.0);
  EXPECT_DOUBLE_EQ(found.labels.rms, std::sqrt(25.0 / 3.0));
  EXPECT_DOUBLE_EQ(found.labels.largest, 4.0);
  EXPECT_DOUBLE_EQ(found.locality->rms, 2.0);
  EXPECT_DOUBLE_EQ(found.curve_shape->mean, 3.0);
  // Labels and maps cancel at two stations: total 1, 1, 7.
  EXPECT_DOUBLE_EQ(found.total.rms, std::sqrt(51.0 / 3.0));
  const SplitSummary nothing = summarise(split, Flags1::Zero(4), Flags1::Ones(4));
  EXPECT_EQ(nothing.n_split, 0);
  EXPECT_EQ(nothing.total.rms, 0.0);
}

}  // namespace
}  // namespace manoscope::validation

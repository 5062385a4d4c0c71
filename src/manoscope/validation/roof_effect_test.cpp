#include "manoscope/validation/roof_effect.hpp"

#include <gtest/gtest.h>

#include <cmath>
#include <string>

#include "manoscope/core/error.hpp"
#include "manoscope/numerics/quadrature.hpp"
#include "manoscope/validation/test_roof.hpp"

namespace manoscope::validation {
namespace {

constexpr double kNoise = 2e-9;
const FlowRate kFlow = 20.0 * mL_per_min;

SmoothRoof roof_of(const TrueRoof& truth, const flow::Channel& channel = kRoofChannel) {
  const SmoothShape along(profile_of(truth, kNoise, 1), channel);
  return SmoothRoof::through(along, cells_of(truth, kNoise, 1), channel,
                             flow::WallShape::parabola())
      .value();
}

/// int dx / int h^3 ds, the drop between plates up to a factor.
double lubrication(const std::function<double(double, double)>& zeta,
                   Length height = kRoofChannel.height) {
  const double h = height.si();
  return mean_over(0.0, kRoofChannel.length.si(), 300, [&](double x) {
    return 1.0 / mean_over(-1.0, 1.0, 200, [&](double s) { return std::pow(h + zeta(x, s), 3); });
  });
}

TEST(RoofEffect, OfADepartureIsThatBetweenPlatesWhereTheGapIsThin) {
  flow::Channel thin = kRoofChannel;
  thin.height = 30.0 * um;
  const auto pointed = [](double x, double s) {
    return 20e-6 * end_rise(x) * (1.0 - s * s) * (1.2 - 1.0 * s * s);
  };
  const auto parabolic = [](double x, double s) {
    return 20e-6 * end_rise(x) * (1.0 - s * s) * (1.2 - 1.0 / 5.0);
  };
  const RoofEffect effect =
      roof_effect(roof_of(pointed, thin), flow::WallShape::parabola(), 1.0 * mPa_s, kFlow);
  const double plates = lubrication(pointed, thin.height) / lubrication(parabolic, thin.height) - 1;
  // Side walls, 0.03 of the width high, move the answer by about as much of the flow.
  EXPECT_NEAR(effect.departure / plates, 1.0, 0.1) << effect.departure << " " << plates;
  EXPECT_LT(plates, -0.01);
}

TEST(RoofEffect, OfADepartureIsSeenBesideSideWalls) {
  // Below a flat roof a departure of mean 0 acts by the side layers alone, to first order.
  const auto by = [](double size) {
    const TrueRoof bent = [size](double x, double s) {
      return size * end_rise(x) * (1.0 - s * s) * (0.2 - s * s);
    };
    return roof_effect(roof_of(bent), flow::WallShape::parabola(), 1.0 * mPa_s, kFlow).departure;
  };
  const double once = by(2e-6), back = by(-2e-6);
  EXPECT_NEAR(once / back, -1.0, 0.1);
  EXPECT_LT(once, 0.0);  // more room where the flow is
}

TEST(RoofEffect, OfWhatIsOddIsOfSecondOrder) {
  const auto askew = [](double by) {
    return
        [by](double x, double s) { return 20e-6 * end_rise(x) * (1.0 - s * s) * (1.0 + by * s); };
  };
  const auto effect_of = [](const TrueRoof& truth) {
    return roof_effect(roof_of(truth), flow::WallShape::parabola(), 1.0 * mPa_s, kFlow);
  };
  const double once = effect_of(askew(0.2)).odd, twice = effect_of(askew(0.4)).odd;
  EXPECT_NEAR(twice / once, 4.0, 0.1);
  const double plates = lubrication(askew(0.4)) / lubrication(askew(0.0)) - 1.0;
  EXPECT_NEAR(twice / plates, 1.0, 0.25) << twice << " " << plates;
  EXPECT_LT(once, 0.0);  // a gap that is wider on one side lets more through
}

TEST(RoofEffect, ErrorOfThePressureCoversThatOfOtherDraws) {
  const auto effect_of = [](std::uint64_t seed) {
    const SmoothShape along(profile_of(buckled_roof, kNoise, 1), kRoofChannel);
    const SmoothRoof roof = SmoothRoof::through(along, cells_of(buckled_roof, 50 * kNoise, seed),
                                                kRoofChannel, flow::WallShape::parabola())
                                .value();
    return roof_effect(roof, flow::WallShape::parabola(), 1.0 * mPa_s, kFlow);
  };
  double sum = 0.0, square = 0.0;
  constexpr int kDraws = 16;  // their scatter is known to 18 %
  for (std::uint64_t seed = 1; seed <= kDraws; ++seed) {
    const double one = effect_of(seed).departure;
    sum += one / kDraws;
    square += one * one / kDraws;
  }
  const RoofEffect effect = effect_of(1);
  const double h = kRoofChannel.height.si(), w = kRoofChannel.width.si();
  const double pressure = 12e-3 * kFlow.si() * kRoofChannel.length.si() / (w * h * h * h);  // rough
  const double stated = effect.pressure_error[0] / pressure;
  const double scatter = std::sqrt((square - sum * sum) * kDraws / (kDraws - 1.0));
  RecordProperty("stated over scatter", std::to_string(stated / scatter));
  // Stated is an error of one sign all along. That of a draw keeps its sign over about a width of
  // the wall: less by the root of their number, three, at most.
  EXPECT_GT(stated, 0.82 * scatter);
  EXPECT_LT(stated, 3.0 * 1.36 * scatter);
  EXPECT_EQ(effect.pressure_error[effect.x.size() - 1], 0.0);
}

TEST(RoofEffect, NamesThePlaceWhereTheGapCloses) {
  flow::Channel shallow = kRoofChannel;
  shallow.height = 8.0 * um;
  const auto dent = [](double x, double s) {
    return -10e-6 * (1.0 - s * s) * std::exp(-std::pow((x - 6e-3) / 1e-3, 2));
  };
  try {
    roof_effect(roof_of(dent, shallow), flow::WallShape::parabola(), 1.0 * mPa_s, kFlow);
    FAIL() << "a closed gap has a resistance";
  } catch (const InputError& error) {
    const auto at = error.found().find("x = ");
    ASSERT_NE(at, std::string::npos) << error.what();
    EXPECT_NEAR(std::stod(error.found().substr(at + 4)), 6.0, 0.5) << error.what();
  }
}

}  // namespace
}  // namespace manoscope::validation

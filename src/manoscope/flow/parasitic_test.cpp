#include "manoscope/flow/parasitic.hpp"

#include <gtest/gtest.h>

#include <cmath>

#include "manoscope/core/error.hpp"

namespace manoscope::flow {
namespace {

TEST(PassageDrop, IsPoiseuilleFlowBetweenWalls) {
  const RigidPassage passage{5.0 * mm, 1.7 * mm, 175.0 * um};
  // By hand: 12 eta l Q/(w h^3 F) with F = 0.9351214392 at h/w = 0.1029411765 (term-by-term sum).
  const double by_hand =
      12.0 * 1e-3 * 5e-3 * (5e-6 / 60.0) / (1.7e-3 * std::pow(175e-6, 3) * 0.9351214392);
  EXPECT_NEAR(passage_drop(1.0 * mPa_s, 5.0 * mL_per_min, passage).si() / by_hand, 1.0, 1e-9);
}

TEST(PassageDrop, IsLinearInFlowRateAndLength) {
  const RigidPassage passage{5.0 * mm, 1.7 * mm, 175.0 * um};
  RigidPassage longer = passage;
  longer.length = 10.0 * mm;
  const double one = passage_drop(1.0 * mPa_s, 5.0 * mL_per_min, passage).si();
  EXPECT_DOUBLE_EQ(passage_drop(1.0 * mPa_s, 5.0 * mL_per_min, longer).si(), 2.0 * one);
  EXPECT_DOUBLE_EQ(passage_drop(1.0 * mPa_s, -10.0 * mL_per_min, passage).si(), -2.0 * one);
}

TEST(PassageDrop, RefusesAPassageWithoutSize) {
  EXPECT_THROW(passage_drop(1.0 * mPa_s, 1.0 * mL_per_min, {Length{}, 1.7 * mm, 175.0 * um}),
               InputError);
  EXPECT_THROW(passage_drop(1.0 * mPa_s, 1.0 * mL_per_min, {5.0 * mm, 1.7 * mm, Length{}}),
               InputError);
}

}  // namespace
}  // namespace manoscope::flow

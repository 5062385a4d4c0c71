#include "manoscope/flow/wall_friction.hpp"

#include <gtest/gtest.h>

#include <cmath>

#include "manoscope/flow/section_flow.hpp"

namespace manoscope::flow {
namespace {

constexpr Channel kChannel{15.5 * mm, 1.7 * mm, 175.0 * um};
constexpr Fluid kWater{1.0 * mPa_s, 998.0 * kg_per_m3};
constexpr FlowRate kFlow = 20.0 * mL_per_min;

SectionsAlong sections(double zeta, const Channel& channel = kChannel) {
  const Array1 x = Array1::LinSpaced(32, 0.0, channel.length.si());
  const SectionFamily family(channel, WallShape::parabola(), -1.0 * um, 60.0 * um);
  return sections_along(family, x, Array1::Constant(32, zeta));
}

TEST(WallFriction, OfAFlatChannelBalancesThePressureOnItsEnds) {
  const SectionsAlong flat = sections(0.0);
  const double drop = friction_drop(flat, kWater, kFlow)(31);
  // No fluid is accelerated: drag = drop times area. Round-off of the sums.
  EXPECT_NEAR(
      friction_drag(flat, kWater, kFlow, Length{}, kChannel.length) / (drop * 1.7e-3 * 175e-6), 1.0,
      1e-10);
  // The table of sections is within 1e-8 of the series.
  EXPECT_NEAR(relative_drag(flat, kChannel, kWater, kFlow, 1.0 * mm, 9.0 * mm), 1.0, 1e-7);
}

TEST(WallFriction, OfABulgedChannelFallsAsTheGapSquared) {
  // h 175 -> 210 um: (175/210)^2 = 0.694, and the section's factor F 0.9351 -> 0.9686 (zeta/2h0 =
  // 0.2, docs/flow-models.md, four digits): drag goes as 1/(h^2 F).
  EXPECT_NEAR(relative_drag(sections(35e-6), kChannel, kWater, kFlow, Length{}, kChannel.length),
              std::pow(175.0 / 210.0, 2) * 0.9351 / 0.9686, 2e-4);
}

TEST(WallFriction, OfAWideChannelIsThatBetweenPlates) {
  // Side walls take a share of the order of h/w = 1/400 of the mean shear.
  const Channel wide{15.5 * mm, 40.0 * mm, 100.0 * um};
  const SectionFamily family(wide, WallShape::parabola(), -1.0 * um, 1.0 * um);
  const Array1 x = Array1::LinSpaced(4, 0.0, 15.5e-3);
  const WallShear shear =
      wall_shear(sections_along(family, x, Array1::Zero(4)), kWater, 50.0 * mL_per_min);
  const double plates =
      plate_shear(kWater.viscosity, 50.0 * mL_per_min, wide.width, wide.height).si();
  EXPECT_NEAR(shear.roof(1) / plates, 1.0, 1.0 / 400.0);
  EXPECT_NEAR(shear.floor(1) / shear.roof(1), 1.0, 1e-4);  // both flat: the shears' own 2e-5
  // By hand, the paper's form with its half gap: 3 eta q / (2 h0^2).
  const double q = 50e-6 / 60.0 / 40e-3;
  EXPECT_NEAR(plates / (3.0 * 1e-3 * q / (2.0 * 50e-6 * 50e-6)), 1.0, 1e-12);
}

}  // namespace
}  // namespace manoscope::flow

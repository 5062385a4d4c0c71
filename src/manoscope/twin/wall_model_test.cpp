#include "manoscope/twin/wall_model.hpp"

#include <gtest/gtest.h>

#include "manoscope/wall/continuation.hpp"

namespace manoscope::twin {
namespace {

wall::FopplVonKarmanOptions coarse(double tolerance) {
  wall::FopplVonKarmanOptions options;
  options.n_cells_x = 12;
  options.n_cells_z = 4;
  options.design_pressure = 1.0 * kPa;
  options.tolerance = tolerance;
  return options;
}

WallAtRest under(const WallModel& model, const WallAtRest& from, double p) {
  const Array1 ends = Array1::LinSpaced(2, 0.0, model.length.si());
  return model.load(from, ends, Array1::Constant(2, p));
}

/// A wall compressed to three times its buckling stress, with a slight downward shape.
wall::ClampedWall buckled() {
  wall::ClampedWall wall{3.0 * mm, 1.7 * mm, 1.0 * um, 250.0 * GPa, 0.23};
  wall.prestress = 3.0 * wall::FopplVonKarman(wall, coarse(1e-9)).critical_prestress();
  wall.initial_shape = {-0.05 * um, 0.1};
  return wall;
}

TEST(PlateModel, ComplianceIsTheRowSumOfTheInfluenceAndADifferenceOfLoads) {
  wall::ClampedWall wall{3.0 * mm, 1.7 * mm, 1.0 * um, 250.0 * GPa, 0.23, 10.0 * MPa};
  wall.preload = {700.0 * Pa, 0.2};
  const WallModel model = plate_model(wall, coarse(1e-11));
  const Array1 x = Array1::LinSpaced(9, 0.2e-3, 2.8e-3);
  // Bowed in by its preload, near flat, and stretched.
  for (const double p : {0.0, 690.0, 3e3}) {
    const WallAtRest state = under(model, model.rest(), p);
    const Array1 compliance = state.compliance(x);
    // One tangent of the wall, solved for one load and for nine: round-off of the solution.
    const Array1 sums = state.influence(x).rowwise().sum().array();
    EXPECT_LT((sums / compliance - 1.0).abs().maxCoeff(), 1e-8) << p;
    const auto difference = [&](double h) {
      return Array1(
          (under(model, state, p + h).deflection(x) - under(model, state, p - h).deflection(x)) /
          (2.0 * h));
    };
    // Two steps, so that the second-order error cancels: fourth order in 2 Pa of 700, 1e-9; the
    // residual of 1e-11 of such loads over such a step, 1e-7.
    const Array1 slope = (4.0 * difference(1.0) - difference(2.0)) / 3.0;
    EXPECT_LT((slope / compliance - 1.0).abs().maxCoeff(), 1e-6) << p;
  }
}

TEST(PlateModel, RemembersEverySnapThroughOnItsWay) {
  const WallModel model = plate_model(buckled(), coarse(1e-9));
  const WallAtRest rest = model.rest();
  EXPECT_TRUE(rest.snaps.empty());
  EXPECT_LT(rest.deflection(Array1::Constant(1, 1.5e-3))(0), 0.0);
  const WallAtRest before = under(model, rest, 0.5);
  EXPECT_TRUE(before.snaps.empty());
  const WallAtRest up = under(model, before, 160.0);
  ASSERT_EQ(up.snaps.size(), 1u);
  EXPECT_GT(up.snaps[0].jump, 0.0);
  EXPECT_NEAR(up.snaps[0].at, 1.5e-3, 0.6e-3);
  // All of the way from below to above but what is elastic before and after.
  const Array1 there = Array1::Constant(1, up.snaps[0].at);
  const double way = (up.deflection(there) - before.deflection(there))(0);
  EXPECT_GT(up.snaps[0].jump, 0.3 * way);
  EXPECT_LT(up.snaps[0].jump, way);
  // Past it there is one branch; on the way back it ends at another pressure.
  EXPECT_EQ(under(model, up, 1e3).snaps.size(), 1u);
  const WallAtRest back = under(model, up, 0.0);
  EXPECT_EQ(back.snaps.size(), 1u);
  const WallAtRest down = under(model, back, -160.0);
  ASSERT_EQ(down.snaps.size(), 2u);
  EXPECT_LT(down.snaps[1].jump, 0.0);
}

TEST(MembraneModel, NeverSnaps) {
  const wall::TaperedMembrane membrane(
      3.0 * mm, {1.7 * mm, 1.0 * um, 250.0 * GPa, 0.23, 10.0 * MPa}, {700.0 * Pa, 0.0});
  const WallModel model = membrane_model(membrane);
  EXPECT_TRUE(under(model, model.rest(), 5e3).snaps.empty());
}

TEST(SectionShape, OfAMembraneIsTheParabola) {
  const wall::TaperedMembrane membrane(
      3.0 * mm, {1.7 * mm, 1.0 * um, 250.0 * GPa, 0.23, 10.0 * MPa}, {700.0 * Pa, 0.2});
  const WallModel model = membrane_model(membrane);
  // Bowed in here, out there, and on average hardly at all.
  const WallAtRest state = model.load(model.rest(), Array1::LinSpaced(2, 0.0, 3e-3),
                                      Array1::LinSpaced(2, 1200.0, 200.0));
  const flow::WallShape shape = section_shape(state, 3.0 * mm, 1.7 * mm);
  for (const double s : {0.0, 0.3, 0.7, 1.0}) {
    EXPECT_NEAR(shape.value(s), flow::WallShape::parabola().value(s), 1e-12) << s;
  }
}

TEST(SectionShape, OfALongPlateUnderASmallLoadIsTheClampedStrip) {
  const wall::ClampedWall wall{12.0 * mm, 1.7 * mm, 20.0 * um, 250.0 * GPa, 0.23};
  wall::FopplVonKarmanOptions options;
  options.n_cells_x = 24;
  options.n_cells_z = 6;
  const WallModel model = plate_model(wall, options);
  const flow::WallShape shape = section_shape(under(model, model.rest(), 1e3), 12.0 * mm, 1.7 * mm);
  // Sections next to an end, of a width or so, are a little more pointed; they stand out less.
  for (const double s : {0.0, 0.3, 0.7}) {
    EXPECT_NEAR(shape.value(s), flow::WallShape::clamped_strip().value(s), 5e-3) << s;
  }
}

TEST(SectionShape, OfAFlatWallIsAParabola) {
  const WallModel model =
      plate_model({3.0 * mm, 1.7 * mm, 1.0 * um, 250.0 * GPa, 0.23}, coarse(1e-9));
  EXPECT_DOUBLE_EQ(section_shape(model.rest(), 3.0 * mm, 1.7 * mm).crest(), 1.5);
}

}  // namespace
}  // namespace manoscope::twin

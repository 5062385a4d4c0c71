#include "manoscope/flow/section_family.hpp"

#include <gtest/gtest.h>

#include <cmath>

#include "manoscope/core/error.hpp"

namespace manoscope::flow {
namespace {

const Channel kChannel{15.5 * mm, 1.7 * mm, 175.0 * um};

TEST(SectionFamily, AnswersBetweenItsNodesAsTheSectionItself) {
  for (const WallShape& shape : {WallShape::parabola(), WallShape::clamped_strip()}) {
    const SectionFamily family(kChannel, shape, -30.0 * um, 60.0 * um);
    EXPECT_LE(family.error(), 1e-8);
    EXPECT_LE(family.n_nodes(), 33);
    for (const double deflection : {-30.0, -22.2, -3.0, 0.0, 7.7, 33.0, 51.4, 60.0}) {
      const Length zeta = deflection * um;
      const CrossSection table = family.at(zeta);
      const CrossSection exact =
          solve_cross_section(bulged_roof(kChannel.width, kChannel.height, zeta, shape));
      // The table's sections have the degree of its least gap, this one has its own: resistance
      // and factors within 1e-9, slopes at the walls within 1e-4 (sides) and 2e-6.
      EXPECT_NEAR(table.conductance / exact.conductance, 1.0, 1e-9) << deflection;
      EXPECT_NEAR(table.momentum_factor / exact.momentum_factor, 1.0, 1e-9) << deflection;
      EXPECT_NEAR(table.energy_factor / exact.energy_factor, 1.0, 2e-9) << deflection;
      EXPECT_NEAR(table.floor_shear / exact.floor_shear, 1.0, 2e-6) << deflection;
      EXPECT_NEAR(table.roof_shear / exact.roof_shear, 1.0, 2e-6) << deflection;
      EXPECT_NEAR(table.side_shear / exact.side_shear, 1.0, 1e-4) << deflection;
      EXPECT_NEAR(table.perimeter / exact.perimeter, 1.0, 1e-9) << deflection;
      EXPECT_NEAR(table.area / exact.area, 1.0, 1e-12);
    }
  }
}

TEST(SectionFamily, SaysHowFarItIsFromATightTolerance) {
  SectionFamilyOptions options;
  options.tolerance = 1e-11;
  options.most_nodes = 5;
  const SectionFamily family(kChannel, WallShape::parabola(), -30.0 * um, 60.0 * um, options);
  EXPECT_EQ(family.n_nodes(), 5);
  EXPECT_GT(family.error(), 1e-11);
}

TEST(SectionFamily, SolvesAFewSectionsForThousandsOfStations) {
  const Index n = 3000;
  const Array1 x = Array1::LinSpaced(n, 0.0, 15.5e-3);
  const Array1 zeta = 33e-6 * (1.0 - 0.6 * x / 15.5e-3);
  const SectionFamily family = SectionFamily::of(kChannel, WallShape::parabola(), zeta);
  const SectionsAlong along = sections_along(family, x, zeta);
  EXPECT_LE(family.n_nodes(), 17);
  EXPECT_NEAR(along.area(0), 1.7e-3 * 208e-6, 1e-15);
  EXPECT_EQ(along.conductance(100), family.at(Length::from_si(zeta(100))).conductance);
}

TEST(SectionsAlong, AreThoseOfTheSectionsGiven) {
  const Array1 x = Array1::LinSpaced(2, 0.0, 1e-3);
  const CrossSection flat = solve_cross_section(flat_roof(1.7 * mm, 175.0 * um));
  const CrossSection high = solve_cross_section(flat_roof(1.7 * mm, 200.0 * um));
  const SectionsAlong along = sections_along(x, {flat, high});
  EXPECT_EQ(along.conductance(0), flat.conductance);
  EXPECT_EQ(along.momentum_factor(1), high.momentum_factor);
  EXPECT_THROW(sections_along(x, {flat}), InputError);
}

TEST(SectionFamily, RefusesWhatItDoesNotCover) {
  const SectionFamily family(kChannel, WallShape::parabola(), Length{}, 10.0 * um);
  EXPECT_THROW(family.at(11.0 * um), InputError);
  EXPECT_THROW(family.at(-1.0 * um), InputError);
  EXPECT_THROW(SectionFamily(kChannel, WallShape::parabola(), 1.0 * um, 1.0 * um), InputError);
  EXPECT_THROW(SectionFamily(kChannel, WallShape::parabola(), -150.0 * um, 1.0 * um), InputError);
  Array1 x(2), zeta(2);
  x << 1.0, 0.0;
  zeta << 1e-6, 2e-6;
  EXPECT_THROW(sections_along(family, x, zeta), InputError);
  EXPECT_THROW(sections_along(family, x.head(1), zeta.head(1)), InputError);
}

}  // namespace
}  // namespace manoscope::flow

#include "manoscope/wall/plate_strip.hpp"

#include <gtest/gtest.h>

#include <cmath>
#include <numbers>

#include "manoscope/core/error.hpp"
#include "manoscope/core/random.hpp"
#include "manoscope/wall/bulge.hpp"
#include "manoscope/wall/foppl_von_karman.hpp"

namespace manoscope::wall {
namespace {

using std::numbers::pi;

WallSection nitride(double prestress_mpa) {
  return {1.7 * mm, 1.0 * um, 250.0 * GPa, 0.23, prestress_mpa * MPa};
}
WallSection silicone(double thickness_um, double prestress_kpa = 0.0) {
  return {1.7 * mm, thickness_um * um, 1.5 * MPa, 0.49, prestress_kpa * kPa, 5.0 / 6.0};
}

TEST(PlateStrip, IsTheClampedPlateUnderASmallLoad) {
  const PlateStrip law(nitride(0.0));
  const double stiffness = nitride(0.0).bending_stiffness(), p = 1e-6;
  const double w = 1.7e-3;
  const Length crest = law.crest(Pressure::from_si(p));
  // 1e-6 of the thickness: stretching takes 0.7 (1e-6)^2 of it.
  EXPECT_NEAR(crest.si() / (p * std::pow(w, 4) / (384.0 * stiffness)), 1.0, 1e-10);
  EXPECT_NEAR(law.mean_over_crest(crest), 8.0 / 15.0, 1e-10);
  EXPECT_NEAR(law.shape(crest, 0.5), 0.75 * 0.75, 1e-10);
}

TEST(PlateStrip, BecomesTheMembraneAsTheEdgeLayerShrinks) {
  // At given pressure the membrane's pressure for the strip's crest is low by 1.5 d/a (stretching
  // carries) to 2 d/a (prestress carries), d = sqrt(D/N): ever better as d/a falls.
  for (const double prestress : {0.0, 200.0}) {
    double before = 1.0;
    for (const double p : {1e3, 1e4, 1e5, 1e6}) {
      const PlateStrip strip(nitride(prestress));
      const LongMembrane membrane(nitride(prestress));
      const Length crest = strip.crest(Pressure::from_si(p));
      const double layer =
          std::sqrt(nitride(0.0).bending_stiffness() / strip.tension(Pressure::from_si(p))) /
          0.85e-3;
      const double deviation = 1.0 - membrane.pressure(crest).si() / p;
      EXPECT_LT(deviation, before);
      EXPECT_GT(deviation, (1.5 - 3.0 * layer) * layer) << p;
      EXPECT_LT(deviation, (2.0 + 3.0 * layer) * layer) << p;
      EXPECT_NEAR(strip.mean_over_crest(crest), 2.0 / 3.0, 0.7 * layer);
      before = deviation;
    }
  }
}

TEST(PlateStrip, IsMidChannelOfALongFopplVonKarmanWall) {
  // An independent solution: two-dimensional elements, ten widths long; the ends' influence at the
  // middle is exp(-5 pi) or less where tension carries and exp(-5 4.73/1.7 ..) of bending, below
  // 1e-6. Discretisation of the edge layer 1e-5.
  struct Row {
    WallSection section;
    double pressure, tolerance;
  };
  const Row rows[] = {{nitride(0.0), 20.0, 2e-5},         {nitride(0.0), 5e3, 2e-5},
                      {nitride(50.0), 5e3, 2e-5},         {nitride(-0.2), 100.0, 2e-5},
                      {silicone(200.0), 4e3, 2e-5},       {silicone(605.0), 20e3, 2e-5},
                      {silicone(200.0, 10.0), 4e3, 2e-5}, {silicone(200.0, -20.0), 1e3, 2e-5}};
  for (const Row& row : rows) {
    const WallSection& s = row.section;
    ClampedWall wall{17.0 * mm,       s.width,     s.thickness,       s.youngs_modulus,
                     s.poisson_ratio, s.prestress, s.shear_correction};
    FopplVonKarmanOptions options;
    options.n_cells_x = 36;
    options.n_cells_z = 16;
    options.design_pressure = Pressure::from_si(row.pressure);
    const WallState state =
        FopplVonKarman(wall, options).equilibrium(WallLoad::uniform(options.design_pressure));
    const PlateStrip law(s);
    const Length crest = law.crest(options.design_pressure);
    EXPECT_NEAR(state.deflection(8.5e-3, 0.0) / crest.si(), 1.0, row.tolerance) << row.pressure;
    EXPECT_NEAR(state.average_deflection(8.5e-3) / law.deflection(options.design_pressure).si(),
                1.0, row.tolerance)
        << row.pressure;
    for (const double z : {0.3, 0.6, 0.9}) {
      EXPECT_NEAR(state.deflection(8.5e-3, z * 0.85e-3) / crest.si(), law.shape(crest, z),
                  row.tolerance)
          << row.pressure;
    }
  }
}

TEST(PlateStrip, InverseGivesBackThePressureForAnyWall) {
  RandomStream random(3, "strips");
  for (int i = 0; i < 2000; ++i) {
    WallSection section;
    section.width = std::pow(10.0, random.uniform(-4.0, -2.0)) * metre;
    section.thickness = std::pow(10.0, random.uniform(-4.0, -0.3)) * section.width;
    section.youngs_modulus = std::pow(10.0, random.uniform(5.0, 11.5)) * Pa;
    section.poisson_ratio = random.uniform(0.0, 0.5);
    section.shear_correction = i % 2 == 0 ? 0.0 : 5.0 / 6.0;
    section.prestress = i % 3 == 0
                            ? random.uniform(0.0, 0.99) * PlateStrip::buckling_prestress(section)
                            : random.uniform(0.0, 0.01) * section.youngs_modulus;
    const PlateStrip law(section);
    const double z = std::pow(10.0, random.uniform(-4.0, -0.7)) * section.half_width();
    const Pressure p = law.pressure(Length::from_si(z));
    // Round-off through two roots, magnified near buckling.
    EXPECT_NEAR(law.crest(p).si() / z, 1.0, 1e-10) << "draw " << i;
    EXPECT_EQ(law.crest(-p).si(), -law.crest(p).si());
    EXPECT_NEAR(law.mean_over_crest(Length::from_si(z)) * z / law.deflection(p).si(), 1.0, 1e-10);
  }
}

TEST(PlateStrip, CompliancesAreDerivatives) {
  for (const WallSection& section :
       {nitride(0.0), nitride(100.0), nitride(-0.25), silicone(200.0), silicone(605.0, 30.0)}) {
    const PlateStrip law(section);
    for (const double p : {5.0, 300.0, 2e4}) {
      const double step = 1e-4 * p;
      const Pressure up = Pressure::from_si(p + step), down = Pressure::from_si(p - step);
      // Central differences: truncation 1e-8 of order one, round-off 1e-13/1e-4.
      const Length crest = law.crest(Pressure::from_si(p));
      EXPECT_NEAR(
          (law.crest(up) - law.crest(down)).si() / (2.0 * step) / law.crest_compliance(crest), 1.0,
          5e-8);
      EXPECT_NEAR((law.deflection(up) - law.deflection(down)).si() / (2.0 * step) /
                      law.deflection_compliance(Pressure::from_si(p)),
                  1.0, 5e-8);
    }
  }
}

TEST(PlateStrip, AverageIsTheIntegralOfItsShape) {
  for (const WallSection& section : {nitride(0.0), nitride(100.0), silicone(605.0)}) {
    const PlateStrip law(section);
    const Length crest = 3.0 * um;
    double sum = 0.0;
    const int n = 20000;
    for (int i = 0; i < n; ++i) sum += law.shape(crest, (2.0 * i + 1.0) / n - 1.0) / n;
    EXPECT_NEAR(law.mean_over_crest(crest) / sum, 1.0, 1e-6);  // midpoint rule, 1/(2 n)^2 u
  }
}

TEST(PlateStrip, SoftensWithoutLimitTowardsBucklingAndRefusesBeyond) {
  const Pressure limit = PlateStrip::buckling_prestress(nitride(0.0));
  const double stiffness = nitride(0.0).bending_stiffness();
  EXPECT_NEAR(limit.si() / (-4.0 * pi * pi * stiffness / (1.7e-3 * 1.7e-3 * 1e-6)), 1.0, 1e-14);
  WallSection section = nitride(0.0);
  const double flat = PlateStrip(section).crest_compliance(Length{});
  for (const double share : {0.9, 0.99, 0.999}) {
    section.prestress = share * limit;
    // The buckling mode 1 + cos(pi s) alone is left: 4/(pi^4 (1 - share)) against 1/24, and a
    // remainder that does not grow.
    const double expected = 24.0 * 4.0 / (std::pow(pi, 4) * (1.0 - share));
    EXPECT_NEAR(PlateStrip(section).crest_compliance(Length{}) / flat / expected, 1.0,
                0.2 * (1.0 - share))
        << share;
  }
  for (const double share : {1.0, 1.001, 5.0}) {
    section.prestress = share * limit;
    EXPECT_THROW(PlateStrip{section}, InputError);
  }
  // A wall that shears buckles earlier (Engesser).
  WallSection thick = silicone(605.0);
  const double thin = PlateStrip::buckling_prestress({1.7 * mm, 605.0 * um, 1.5 * MPa, 0.49}).si();
  EXPECT_NEAR(1.0 / PlateStrip::buckling_prestress(thick).si() - 1.0 / thin,
              -605e-6 / thick.shear_stiffness(), 1e-12);
}

TEST(PlateStrip, RefusesWhatIsNoWall) {
  WallSection section = nitride(0.0);
  section.thickness = -1.0 * um;
  EXPECT_THROW(PlateStrip{section}, InputError);
  section = nitride(0.0);
  section.shear_correction = 1.5;
  EXPECT_THROW(PlateStrip{section}, InputError);
}

}  // namespace
}  // namespace manoscope::wall

#include "manoscope/wall/wall_laws.hpp"

#include <gtest/gtest.h>

#include "manoscope/core/error.hpp"

namespace manoscope::wall {
namespace {

const WallSection kWall{1.7 * mm, 200.0 * um, 1.5 * MPa, 0.49, 5.0 * kPa, 5.0 / 6.0};
constexpr LawKind kAll[] = {LawKind::long_membrane,     LawKind::plate_strip,
                            LawKind::elastomer_strip,   LawKind::circular_plate,
                            LawKind::circular_membrane, LawKind::square_plate,
                            LawKind::square_membrane};

TEST(WallLaws, EachIsFoundByItsName) {
  for (const LawKind kind : kAll) {
    EXPECT_EQ(law_kind(name(kind)), kind);
    EXPECT_EQ(make_wall_law(kind, kWall).index(), static_cast<std::size_t>(kind));
  }
  EXPECT_THROW(law_kind("membrane"), InputError);
}

TEST(WallLaws, AllAreOddMonotonicAndInvertible) {
  for (const LawKind kind : kAll) {
    std::visit(
        [&](const auto& law) {
          double before = 0.0;
          for (const double p : {10.0, 100.0, 1000.0, 4000.0}) {
            const Length crest = law.crest(Pressure::from_si(p));
            EXPECT_GT(crest.si(), before) << name(kind);
            EXPECT_NEAR(law.pressure(crest).si() / p, 1.0, 1e-12) << name(kind);
            EXPECT_EQ(law.crest(Pressure::from_si(-p)).si(), -crest.si()) << name(kind);
            before = crest.si();
          }
        },
        make_wall_law(kind, kWall));
  }
}

TEST(WallLaws, ShapesFallFromOneAtTheCrestToZeroAtTheEdges) {
  for (const LawKind kind : kAll) {
    std::visit(
        [&](const auto& law) {
          const Length crest = 30.0 * um;
          EXPECT_NEAR(law.shape(crest, 0.0), 1.0, 1e-10) << name(kind);
          for (double s = 0.05; s < 1.0; s += 0.05) {
            EXPECT_LT(law.shape(crest, s), law.shape(crest, s - 0.05)) << name(kind);
            EXPECT_NEAR(law.shape(crest, -s), law.shape(crest, s), 1e-12) << name(kind);
          }
          EXPECT_EQ(law.shape(crest, 1.0), 0.0);
          EXPECT_EQ(law.shape(crest, -2.0), 0.0);
          double sum = 0.0;
          for (int i = 0; i < 4000; ++i) sum += law.shape(crest, (i + 0.5) / 4000.0) / 4000.0;
          EXPECT_NEAR(law.mean_over_crest(crest), sum, 1e-6) << name(kind);  // midpoint rule
        },
        make_wall_law(kind, kWall));
  }
}

TEST(WallLaws, ComplianceOfTheAverageIsItsDerivative) {
  for (const LawKind kind : kAll) {
    const AnyWallLaw law = make_wall_law(kind, kWall);
    const double p = 2e3, step = 0.1;
    const double slope = (deflection(law, Pressure::from_si(p + step)).si() -
                          deflection(law, Pressure::from_si(p - step)).si()) /
                         (2.0 * step);
    // Central difference: (step/p)^2 = 2.5e-9 of order one, round-off 1e-13 p/step.
    EXPECT_NEAR(deflection_compliance(law, Pressure::from_si(p)) / slope, 1.0, 3e-8) << name(kind);
  }
}

TEST(WallLaws, ManyPressuresAreEachOne) {
  const PlateStrip law(kWall);
  const Array1 p = Array1::LinSpaced(5, -1e3, 3e3), z = deflection(law, p);
  for (Index i = 0; i < p.size(); ++i) {
    EXPECT_EQ(z(i), law.deflection(Pressure::from_si(p(i))).si());
  }
}

}  // namespace
}  // namespace manoscope::wall

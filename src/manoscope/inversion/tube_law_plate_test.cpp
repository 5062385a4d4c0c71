// The tube law of clamped Foeppl-von Karman walls, against what is known of them otherwise.
#include <gtest/gtest.h>

#include <cmath>
#include <numbers>
#include <string>
#include <vector>

#include "manoscope/calibration/fit_curves.hpp"
#include "manoscope/inversion/test_flow.hpp"
#include "manoscope/inversion/tube_law.hpp"
#include "manoscope/wall/continuation.hpp"
#include "tests/support/local_wall.hpp"

namespace manoscope::inversion {
namespace {

constexpr flow::Fluid kWater{1.0 * mPa_s, 998.0 * kg_per_m3};

/// A clamped wall over a channel, solved at levels and under a flow; maps without errors.
struct PlateChannel {
  wall::ClampedWall wall;
  flow::Channel channel;
  FlowRate flow_rate;
  wall::FopplVonKarman model;
  wall::LoadPath path;
  calibration::ConstitutiveCurves curves;
  Profile state;

  PlateChannel(const wall::ClampedWall& clamped, const std::vector<double>& pressures, Length gap,
               FlowRate rate, double outlet)
      : wall(clamped),
        channel{clamped.length, clamped.width, gap},
        flow_rate(rate),
        model(clamped, options(pressures.back())) {
    const Array1 steps =
        Eigen::Map<const Array1>(pressures.data(), static_cast<Index>(pressures.size()));
    path = wall::follow_pressure(
        model, model.equilibrium(wall::WallLoad::uniform(Pressure::from_si(steps[0]))), steps);
    const Array1 x = Array1::LinSpaced(400, 0.01e-3, wall.length.si() - 0.01e-3);
    std::vector<calibration::Level> levels;
    for (std::size_t k = 0; k < path.states.size(); ++k) {
      levels.push_back(
          test::level("h" + std::to_string(k), pressures[k], 0.0, profile(x, path.states[k])));
    }
    curves = calibration::fit_curves(levels);
    const wall::WallState* last = &path.states[path.states.size() / 2];
    wall::WallState here = *last;
    const Array1 p = test_support::flow_pressure(
        channel, kWater, flow_rate, x, outlet, [&](const Array1& pressure) {
          here = model.equilibrium(wall::WallLoad::along(x, pressure), here);
          return here.average_deflection(x);
        });
    state = profile(x, here);
  }

  static wall::FopplVonKarmanOptions options(double highest) {
    wall::FopplVonKarmanOptions options;
    options.n_cells_x = 36;
    options.n_cells_z = 4;
    options.design_pressure = Pressure::from_si(highest);
    options.tolerance = 1e-8;
    return options;
  }
  static Profile profile(const Array1& x, const wall::WallState& solved) {
    return test::exact_profile(x, [&](double at) { return solved.average_deflection(at); });
  }

  TubeLawAtRest at_rest() const { return tube_law_at_rest(curves, wall.length, wall.width); }
  TubeLawUnderFlow under_flow() const {
    return tube_law_under_flow(curves, state, read_pressure(curves, state), channel, kWater,
                               flow_rate, at_rest().start);
  }
  /// b of ripples of pressure at mid-channel, much longer than the wall's reach, at a level: half
  /// the second moment of the influence operator over its sum is L^2 = -b/a.
  double b_of_long_ripples(std::size_t level) const {
    const Array1 stations = Array1::LinSpaced(161, 0.0, wall.length.si());
    const Matrix influence = model.influence(path.states[level], stations);
    const Eigen::RowVectorXd row = influence.row(80);
    const Array1 distance = stations - stations[80];
    const double sum = row.sum();
    return -0.5 * (row.transpose().array() * distance.square()).sum() / (sum * sum);
  }
};

/// b that a membrane of that tension has in an equation of second order: its width average is held
/// back by 12 N/w^2 and forgets over w/pi, the decay of its first mode across.
double of_membrane(double tension) {
  return -12.0 * tension / (std::numbers::pi * std::numbers::pi);
}

/// Tension across a long stretched wall: the strain of a parabola's arc, (2/3) (crest/(w/2))^2.
double tension_across(const wall::ClampedWall& wall, double deflection) {
  const double crest = 1.5 * deflection, half = 0.5 * wall.width.si();
  const double stretch = wall.youngs_modulus.si() * wall.thickness.si() /
                         (1.0 - wall.poisson_ratio * wall.poisson_ratio);
  return wall.prestress.si() * wall.thickness.si() +
         stretch * 2.0 / 3.0 * crest * crest / (half * half);
}

TEST(TubeLawOfAPlate, UnderTensionIsThatOfAMembrane) {
  // Bending and stretching add 1 % to the stiffness that 400 N/m give it.
  const wall::ClampedWall taut{12.0 * mm, 1.0 * mm, 0.5 * um, 200.0 * GPa, 0.25, 800.0 * MPa};
  const PlateChannel made(taut, test::even(8, 0.0, 7000.0), 150.0 * um, 15.0 * mL_per_min, 300.0);
  const auto rest = made.at_rest();
  ASSERT_TRUE(rest.small.has_value()) << rest.reason;
  // The third mode across forgets three times sooner; near the edge it has a share of 1/81 of the
  // deflection and 1/9 of the curvature: b there is up to a tenth nearer to 0.
  EXPECT_NEAR(rest.small->value / of_membrane(400.0), 1.0, 0.05);
  EXPECT_LT(rest.small->uncertainty, 0.05 * 400.0);
  const auto flow = made.under_flow();
  ASSERT_TRUE(flow.law.has_value()) << flow.reason;
  EXPECT_NEAR(flow.law->b / of_membrane(400.0), 1.0, 0.1);
  EXPECT_NEAR(flow.law->b / made.b_of_long_ripples(3), 1.0, 0.1);
  EXPECT_NEAR(flow.law->healing_length() / (1e-3 / std::numbers::pi), 1.0, 0.05);
  EXPECT_GT(flow.law->significance(), 10.0);
  EXPECT_NEAR(flow.resistance_factor, 1.0, 0.01);
}

TEST(TubeLawOfAPlate, StretchedIsTheAxialTensionUnderFlowAndThatAcrossAtRest) {
  const wall::ClampedWall thin{10.0 * mm, 1.0 * mm, 0.4 * um, 250.0 * GPa, 0.23, 20.0 * MPa};
  const auto pressures = test::log_spaced(16, 150.0, 20e3);
  const PlateChannel made(thin, pressures, 120.0 * um, 10.0 * mL_per_min, 300.0);
  const auto rest = made.at_rest();
  ASSERT_TRUE(rest.small.has_value()) << rest.reason;
  EXPECT_NEAR(rest.small->value / of_membrane(8.0), 1.0, 0.1);  // as above
  const double before = 8.0;
  for (const std::size_t k : {std::size_t{8}, std::size_t{12}, std::size_t{15}}) {
    ASSERT_TRUE(rest.levels[k].has_value());
    const TubeLaw& at = *rest.levels[k];
    const double across = tension_across(thin, at.deflection);
    EXPECT_NEAR(-at.b / across, 1.0, 0.15) << k;
    // Plane strain: what stretches across pulls along by Poisson's ratio. A membrane's b is 12/pi^2
    // times its axial tension, a stretched wall's the tension itself: three times less than above.
    const double along = before + 0.23 * (across - before);
    const double share = -made.b_of_long_ripples(k) / along;
    EXPECT_GT(share, 0.95) << k;
    EXPECT_LT(share, 1.25) << k;
  }
  const auto flow = made.under_flow();
  ASSERT_TRUE(flow.law.has_value()) << flow.reason;
  std::size_t nearest = 1;
  for (std::size_t k = 1; k < pressures.size(); ++k) {
    if (!rest.levels[k]) continue;
    const auto off = [&](std::size_t j) {
      return std::abs(rest.levels[j]->deflection - flow.law->deflection);
    };
    if (!rest.levels[nearest] || off(k) < off(nearest)) nearest = k;
  }
  // p(x) spans a factor of six, b of two; its own uncertainty says how far one number holds.
  EXPECT_NEAR(flow.law->b, made.b_of_long_ripples(nearest), 2.0 * flow.law->uncertainty);
  EXPECT_LT(flow.law->uncertainty, 0.2 * -flow.law->b);
  EXPECT_GT(flow.law->significance(), 5.0);
}

TEST(TubeLawOfAPlate, ThickAndShearedHoldsOnlyRoughlyAndSaysSo) {
  const wall::ClampedWall thick{10.0 * mm, 1.0 * mm,   350.0 * um, 1.5 * MPa,
                                0.49,      Pressure{}, 5.0 / 6.0};
  const PlateChannel made(thick, test::even(10, 0.0, 20e3), 120.0 * um, 12.0 * mL_per_min, 300.0);
  const auto rest = made.at_rest();
  ASSERT_TRUE(rest.small.has_value()) << rest.reason;
  const double ripples = made.b_of_long_ripples(2);
  // Shear alone would give kappa G t = 147 N/m; bending, of fourth order, is no part of the law:
  // near the ends b is half as large again as for long ripples, and differs within a width by as
  // much.
  EXPECT_NEAR(rest.small->value, ripples, 1.5 * rest.small->uncertainty);
  ASSERT_TRUE(rest.levels[5].has_value());
  EXPECT_GT(rest.levels[5]->misfit, 0.15 * -rest.levels[5]->b);
  const auto flow = made.under_flow();
  ASSERT_TRUE(flow.law.has_value()) << flow.reason;
  EXPECT_NEAR(flow.law->b, ripples, 2.0 * flow.law->uncertainty);
  EXPECT_GT(flow.law->significance(), 5.0);
}

}  // namespace
}  // namespace manoscope::inversion

#include "manoscope/inversion/tube_law.hpp"

#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <string>
#include <utility>
#include <vector>

#include "manoscope/calibration/fit_curves.hpp"
#include "manoscope/core/flags.hpp"
#include "manoscope/core/random.hpp"
#include "manoscope/inversion/test_flow.hpp"
#include "tests/support/line_wall.hpp"
#include "tests/support/local_wall.hpp"

namespace manoscope::inversion {
namespace {

using calibration::ConstitutiveCurves;
using test::LineWall;
using test::LocalWall;

constexpr double kPixelNoise = 2e-9;  // m, of one width-averaged column
constexpr double kLabelNoise = 5.0;   // Pa
constexpr double kPlaneNoise = 1e-9;  // m, of the rim's plane

/// A map of a wall: pixels and plane drawn and stated.
Profile noisy(Profile map, const std::string& name, RandomStream& random) {
  const Index n = map.x.size();
  map.uncertainty.independent.setConstant(kPixelNoise);
  for (double& zeta : map.zeta) zeta += kPixelNoise * random.normal();
  const Array1 plane = Array1::Constant(n, kPlaneNoise);
  map.zeta += plane * random.normal();
  map.uncertainty.modes.push_back({"plane of " + name, "leveling", plane});
  return map;
}

/// A calibration of exact profiles with errors of maps and labels.
ConstitutiveCurves calibrate(const std::vector<double>& pressures,
                             const std::vector<Profile>& exact, RandomStream& random) {
  std::vector<calibration::Level> levels;
  for (std::size_t k = 0; k < exact.size(); ++k) {
    const std::string name = "h" + std::to_string(k);
    const bool vented = pressures[k] == 0.0;
    const double label = pressures[k] + (vented ? 0.0 : kLabelNoise * random.normal());
    levels.push_back(
        test::level(name, label, vented ? 0.0 : kLabelNoise, noisy(exact[k], name, random)));
  }
  return calibration::fit_curves(levels);
}

struct Statistics {
  double n = 0.0, sum = 0.0, squares = 0.0, beyond = 0.0;
  void add(double pull) {
    n += 1.0;
    sum += pull;
    squares += pull * pull;
    beyond += std::abs(pull) > 1.96 ? 1.0 : 0.0;
  }
  double mean() const { return sum / n; }
  double width() const { return std::sqrt(squares / n - mean() * mean()); }
};

constexpr flow::Fluid kWater{1.0 * mPa_s, 998.0 * kg_per_m3};

/// Exact levels of a wall, and one flow run over it.
struct Truth {
  flow::Channel channel;
  FlowRate flow_rate{};
  std::vector<double> pressures;
  std::vector<Profile> levels;
  Profile state;
};

/// A wall that obeys the law.
Truth lawful(const LineWall& wall, FlowRate flow_rate, double outlet) {
  constexpr Index kEvery = 8;  // nodes a station: 400 stations of 20 um
  Truth truth{{Length::from_si(wall.length), 1.0 * mm, 150.0 * um},
              flow_rate,
              test::even(14, 0.0, 7800.0),
              {},
              {}};
  const Array1 nodes = LineWall::nodes_of(wall.length);
  const Array1 x = LineWall::at_stations(nodes, kEvery);
  const auto profile = [&](const Array1& pressure) {
    Profile made = test::exact_profile(x, [](double) { return 0.0; });
    made.zeta = LineWall::at_stations(wall.solve(pressure), kEvery);
    return made;
  };
  for (const double p : truth.pressures) {
    truth.levels.push_back(profile(Array1::Constant(nodes.size(), p)));
  }
  truth.state =
      profile(test_support::flow_pressure(truth.channel, kWater, flow_rate, nodes, outlet,
                                          [&](const Array1& p) { return wall.solve(p); }));
  return truth;
}

/// A wall that answers to the pressure at x alone, softer towards its middle: b = 0.
Truth local(const LocalWall& wall, FlowRate flow_rate, double outlet,
            double momentum_factor = 1.2) {
  Truth truth{{Length::from_si(wall.length), 1.7 * mm, 175.0 * um},
              flow_rate,
              test::log_spaced(16, 200.0, 15e3),
              {},
              {}};
  const Array1 x = Array1::LinSpaced(387, 0.02e-3, wall.length - 0.02e-3);
  const auto deflections = [&](const Array1& p) {
    Array1 zeta(x.size());
    for (Index i = 0; i < x.size(); ++i) zeta[i] = wall.zeta(x[i], p[i]);
    return zeta;
  };
  const auto profile = [&](const Array1& p) {
    Profile made = test::exact_profile(x, [](double) { return 0.0; });
    made.zeta = deflections(p);
    return made;
  };
  for (const double p : truth.pressures) {
    truth.levels.push_back(profile(Array1::Constant(x.size(), p)));
  }
  truth.state = profile(test_support::flow_pressure(truth.channel, kWater, flow_rate, x, outlet,
                                                    deflections, momentum_factor));
  return truth;
}

/// A curve set without any error.
ConstitutiveCurves exact_curves(const Truth& truth) {
  std::vector<calibration::Level> levels;
  for (std::size_t k = 0; k < truth.levels.size(); ++k) {
    levels.push_back(
        test::level("h" + std::to_string(k), truth.pressures[k], 0.0, truth.levels[k]));
  }
  return calibration::fit_curves(levels);
}

TubeLawUnderFlow under_flow(const ConstitutiveCurves& curves, const Profile& state,
                            const Truth& truth, double start) {
  return tube_law_under_flow(curves, state, read_pressure(curves, state), truth.channel, kWater,
                             truth.flow_rate, start);
}

TEST(TubeLawAtRest, FindsTheLawOfAWallThatObeysIt) {
  const LineWall wall;
  const Truth truth = lawful(wall, 20.0 * mL_per_min, 300.0);
  const auto law = tube_law_at_rest(exact_curves(truth), truth.channel.length, truth.channel.width);
  EXPECT_EQ(law.reason, "");
  EXPECT_FALSE(law.levels[0].has_value());  // flat
  for (std::size_t k = 2; k < law.levels.size(); ++k) {
    ASSERT_TRUE(law.levels[k].has_value()) << k;
    const TubeLaw& at = *law.levels[k];
    // A cubic law is straight in the scale in which f is interpolated; what is left are its steps
    // of 20 % in that scale.
    EXPECT_NEAR(at.b / wall.b, 1.0, 0.02) << k;
    const double zeta = at.deflection;
    EXPECT_NEAR(zeta / truth.levels[k].zeta[200], 1.0, 1e-3) << k;
    EXPECT_NEAR(at.stiffness / (wall.a + 3.0 * wall.c * zeta * zeta), 1.0, 0.02) << k;
    EXPECT_NEAR(at.healing_length() / std::sqrt(-wall.b / at.stiffness), 1.0, 0.01) << k;
  }
  ASSERT_TRUE(law.small.has_value());
  EXPECT_NEAR(law.small->value / wall.b, 1.0, 0.02);
}

TEST(TubeLawUnderFlow, FindsTheLawOfAWallThatObeysIt) {
  for (const double b : {-6.25, -2.0}) {
    LineWall wall;
    wall.b = b;
    const Truth truth = lawful(wall, 20.0 * mL_per_min, 300.0);
    const auto found = under_flow(exact_curves(truth), truth.state, truth, 0.0);
    ASSERT_TRUE(found.law.has_value()) << found.reason;
    // Over a window the pressure is taken as a straight line.
    EXPECT_NEAR(found.law->b / b, 1.0, 0.02) << b;
    EXPECT_NEAR(found.resistance_factor, 1.0, 2e-3) << b;
  }
}

TEST(TubeLaw, HasPullsOfWidthOneWhereAWallObeysIt) {
  constexpr int kExperiments = 100;
  Statistics rest, flow, small;
  for (int i = 0; i < kExperiments; ++i) {
    RandomStream random(5, "lawful", static_cast<std::uint64_t>(i));
    LineWall wall;
    wall.a *= random.uniform(0.7, 1.4);
    wall.c *= random.uniform(0.5, 2.0);
    wall.b = random.uniform(-12.0, -3.0);
    const Truth truth =
        lawful(wall, random.uniform(8.0, 25.0) * mL_per_min, random.uniform(100.0, 900.0));
    const ConstitutiveCurves curves = calibrate(truth.pressures, truth.levels, random);
    const Profile state = noisy(truth.state, "f", random);
    const auto at_rest = tube_law_at_rest(curves, truth.channel.length, truth.channel.width);
    ASSERT_TRUE(at_rest.levels[7].has_value() && at_rest.small.has_value()) << i;
    rest.add((at_rest.levels[7]->b - wall.b) / at_rest.levels[7]->uncertainty);
    small.add((at_rest.small->value - wall.b) / at_rest.small->uncertainty);
    const auto found = under_flow(curves, state, truth, at_rest.start);
    if (found.law) flow.add((found.law->b - wall.b) / found.law->uncertainty);
  }
  EXPECT_GT(flow.n, 0.95 * kExperiments);
  EXPECT_GT(flow.width(), 0.5);
  // Four standard errors of mean and width. On top: half a standard uncertainty of bias, as
  // labels estimated together may have (fit_curves()). Bars may be wider than the errors: these
  // walls follow the law of estimate_labels() exactly, and their curves need none of the doubt of
  // interpolation; at rest the 0.3 % for f are most of the bars where nothing else is off.
  const double mean = 4.0 / std::sqrt(kExperiments) + 0.5;
  const double width = 4.0 / std::sqrt(2.0 * kExperiments);
  const double alarms = 0.05 + 4.0 * std::sqrt(0.05 * 0.95 / kExperiments);
  for (const auto& [of, name] :
       {std::pair{&rest, "at rest"}, {&small, "small"}, {&flow, "under flow"}}) {
    EXPECT_NEAR(of->mean(), 0.0, mean) << name;
    EXPECT_LT(of->width(), 1.0 + width) << name;
    EXPECT_LT(of->beyond / of->n, alarms) << name;
  }
}

TEST(TubeLawUnderFlow, SeldomSeesTensionInAWallThatAnswersToThePressureAtXAlone) {
  constexpr int kExperiments = 240;
  Statistics flow;
  double largest = 0.0;
  for (int i = 0; i < kExperiments; ++i) {
    RandomStream random(6, "local", static_cast<std::uint64_t>(i));
    LocalWall wall;
    wall.stiffness *= random.uniform(0.7, 1.4);
    wall.stretching *= random.uniform(0.5, 2.0);
    const Truth truth =
        local(wall, random.uniform(5.0, 50.0) * mL_per_min, random.uniform(100.0, 900.0));
    const ConstitutiveCurves curves = calibrate(truth.pressures, truth.levels, random);
    const auto found = under_flow(curves, noisy(truth.state, "f", random), truth, 0.0);
    if (!found.law) continue;
    flow.add(found.law->b / found.law->uncertainty);
    largest = std::max(largest, std::abs(found.law->b) / found.law->stiffness);
  }
  EXPECT_GT(flow.n, 0.8 * kExperiments);
  // Alarms at 1.96 standard uncertainties: 5 %, fewer where misfit widens the bars by chance.
  EXPECT_NEAR(flow.beyond / flow.n, 0.04, 0.02 + 4.0 * std::sqrt(0.05 * 0.95 / kExperiments));
  EXPECT_NEAR(flow.mean(), 0.0, 4.0 / std::sqrt(kExperiments) + 0.2);  // the curves' interpolation
  EXPECT_NEAR(flow.width(), 1.0, 4.0 / std::sqrt(2.0 * kExperiments) + 0.05);
  // The wall's own ends reach over 0.5 mm: what is seen of a healing length stays far below.
  EXPECT_LT(std::sqrt(largest), 0.3e-3);
}

TEST(TubeLawUnderFlow, StaysQuietWhenTheMomentumOfTheFlowIsAnother) {
  // beta of real sections is 1.22 to 1.34, that of a flat profile 1; 1.2 +- 0.1 is assumed.
  constexpr int kExperiments = 30;
  for (const double beta : {1.05, 1.35}) {
    const Truth truth = local(LocalWall{}, 30.0 * mL_per_min, 400.0, beta);
    Statistics flow;
    for (int i = 0; i < kExperiments; ++i) {
      RandomStream random(9, "momentum", static_cast<std::uint64_t>(i));
      const ConstitutiveCurves curves = calibrate(truth.pressures, truth.levels, random);
      const auto found = under_flow(curves, noisy(truth.state, "f", random), truth, 0.0);
      if (found.law) flow.add(found.law->b / found.law->uncertainty);
    }
    EXPECT_GT(flow.n, 0.8 * kExperiments) << beta;
    // Off by 1.5 of its standard uncertainties, beta may move b by as many of that part of its own.
    EXPECT_NEAR(flow.mean(), 0.0, 1.0) << beta;
    EXPECT_LT(flow.beyond / flow.n, 0.05 + 4.0 * std::sqrt(0.05 * 0.95 / kExperiments)) << beta;
  }
}

TEST(TubeLawAtRest, TakesAWallThatIsStifferNearItsEndsForOneUnderTension) {
  // What it cannot tell: this wall has b = 0 and ends of its own.
  const LocalWall wall;
  const Truth truth = local(wall, 20.0 * mL_per_min, 300.0);
  const auto curves = exact_curves(truth);
  const auto rest = tube_law_at_rest(curves, truth.channel.length, truth.channel.width);
  ASSERT_TRUE(rest.levels[2].has_value()) << rest.reason;
  // Nearly linear there: its taper solves zeta - L^2 zeta'' = c p with L its decay.
  EXPECT_NEAR(rest.levels[2]->healing_length() / wall.decay, 1.0, 0.15);
  const auto flow = under_flow(curves, truth.state, truth, rest.start);
  ASSERT_TRUE(flow.law.has_value()) << flow.reason;
  EXPECT_LT(std::abs(flow.law->b), 0.02 * -rest.levels[2]->b);
}

TEST(TubeLawAtRest, SaysWhyThereIsNone) {
  const Truth truth = lawful(LineWall{}, 20.0 * mL_per_min, 300.0);
  // Ends out of view.
  std::vector<calibration::Level> inner;
  for (std::size_t k = 0; k < truth.levels.size(); ++k) {
    Profile seen = truth.levels[k];
    for (Index i = 0; i < seen.x.size(); ++i) {
      if (std::abs(seen.x[i] - 4e-3) > 2.6e-3) seen.flags[i] = StationFlag::no_data;
    }
    inner.push_back(test::level("h" + std::to_string(k), truth.pressures[k], 0.0, seen));
  }
  const auto hidden = tube_law_at_rest(calibration::fit_curves(inner), 8.0 * mm, 1.0 * mm);
  EXPECT_NE(hidden.reason.find("end of the wall"), std::string::npos) << hidden.reason;
  EXPECT_FALSE(hidden.small.has_value());
  // Three widths long.
  const auto square = tube_law_at_rest(exact_curves(truth), 8.0 * mm, 3.0 * mm);
  EXPECT_NE(square.reason.find("too short"), std::string::npos) << square.reason;
  // No ends at all: the same deflection everywhere, with noise.
  RandomStream random(8, "flat");
  std::vector<Profile> flat;
  for (const double p : truth.pressures) {
    flat.push_back(test::exact_profile(truth.state.x, [&](double) { return p / 1e8; }));
  }
  const auto none = tube_law_at_rest(calibrate(truth.pressures, flat, random), 8.0 * mm, 1.0 * mm);
  EXPECT_NE(none.reason.find("not curved"), std::string::npos) << none.reason;
}

TEST(TubeLawUnderFlow, SaysWhyThereIsNone) {
  const Truth truth = lawful(LineWall{}, 20.0 * mL_per_min, 300.0);
  const auto curves = exact_curves(truth);
  const auto reason = [&](const Profile& state, const flow::Channel& channel, FlowRate flow_rate) {
    const auto found = tube_law_under_flow(curves, state, read_pressure(curves, state), channel,
                                           kWater, flow_rate, 0.0);
    EXPECT_FALSE(found.law.has_value());
    return found.reason;
  };
  Profile lost = truth.state;
  lost.flags.setConstant(StationFlag::no_data);
  EXPECT_EQ(reason(lost, truth.channel, truth.flow_rate),
            "too few stations near the ends have a reading");
  flow::Channel broad = truth.channel;
  broad.width = 2.1 * mm;  // less than four widths long
  EXPECT_NE(reason(truth.state, broad, truth.flow_rate).find("too short"), std::string::npos);
  flow::Channel closed = truth.channel;
  closed.height = -1.0 * mm;  // a gap that is none
  EXPECT_NE(reason(truth.state, closed, truth.flow_rate), "");
}

}  // namespace
}  // namespace manoscope::inversion

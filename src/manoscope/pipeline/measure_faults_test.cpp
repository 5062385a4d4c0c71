// What measure() cannot read: it flags, warns or refuses.
#include <gtest/gtest.h>

#include <cmath>

#include "manoscope/core/flags.hpp"
#include "manoscope/pipeline/measure.hpp"
#include "manoscope/pipeline/test_experiment.hpp"

namespace manoscope::pipeline {
namespace {

using results::Measurement;

TEST(Measure, FlagsARunThatExceedsTheHighestLevel) {
  twin::Scenario scenario = small_scenario();
  scenario.levels.resize(13);  // up to 8.2 kPa; 70 mL/min begins at about 12
  TestExperiment test(scenario);
  const Measurement m = test.measure();
  const auto& truth = test.twin.truth.runs[1].pressure;
  ASSERT_GT(truth.maxCoeff(), 9e3);
  for (Index ix = 30; ix < m.x.size() - 30; ++ix) {
    if (truth[ix] > 8.4e3) {
      EXPECT_NE(m.pressure_flags(1, ix) & ReadingFlag::out_of_calibration, 0) << m.x[ix];
      EXPECT_TRUE(std::isnan(m.pressure(1, ix)));
      EXPECT_TRUE(std::isnan(m.pressure_lower(1, ix)));
      EXPECT_TRUE(std::isnan(m.pressure_covariance[1](ix, m.x.size() / 2)));
    } else if (truth[ix] < 8.0e3) {
      EXPECT_EQ(m.pressure_flags(1, ix) & ReadingFlag::no_answer, 0) << m.x[ix];
    }
  }
  EXPECT_TRUE(warns_of(m, "Run Q70")) << all_warnings(m);
  EXPECT_TRUE(warns_of(m, "outside the calibrated levels")) << all_warnings(m);
  EXPECT_FALSE(warns_of(m, "Run Q20")) << all_warnings(m);
}

/// A wall that falls by a few micrometres as the pressure rises from 2.5 to 4 kPa.
double folding_wall(double p) {
  const double bump = (p - 2e3) / 700.0;
  return 20e-6 * p / (p + 8e3) + 3e-6 * std::exp(-bump * bump);
}

TEST(Measure, FlagsABuckledFoldInsteadOfPickingABranch) {
  twin::Scenario scenario = small_scenario();
  TestExperiment test(scenario);
  constexpr Index kNodes = 401;
  const Length length = scenario.channel.length;
  const auto curve = [&](auto&& pressure) {
    Array1 values(kNodes);
    for (Index i = 0; i < kNodes; ++i) {
      const double x = length.si() * static_cast<double>(i) / (kNodes - 1);
      const double taper =
          (1.0 - std::exp(-x / 0.4e-3)) * (1.0 - std::exp(-(length.si() - x) / 0.4e-3));
      values[i] = taper * folding_wall(pressure(x));
    }
    return twin::ChannelCurve(length, values);
  };
  test.twin.maps.clear();
  test.twin.hydrostatic_csv = "map,pressure [Pa],pressure_uncertainty [Pa]\n";
  const std::vector<double> levels{0,    500,  1000, 1500, 2000, 2500,
                                   3000, 3500, 4000, 5000, 6000, 8000};
  for (std::size_t k = 0; k < levels.size(); ++k) {
    const std::string name = "h" + std::to_string(k) + ".gsf";
    test.add_map(name, curve([&](double) { return levels[k]; }), k);
    test.twin.hydrostatic_csv +=
        name + "," + std::to_string(levels[k]) + (k == 0 ? ",0\n" : ",10\n");
  }
  const auto flowing = [&](double x) { return 7e3 - 6.5e3 * x / length.si(); };
  test.add_map("f.gsf", curve(flowing), 100);
  test.twin.flow_csv = "map,flow_rate [mL/min],run\nf.gsf,20,fold\n";
  const Measurement m = test.measure();
  // Where zeta lies between the minimum and the maximum of the curve, three pressures fit.
  double top = 0.0, bottom = 1.0;
  for (double p = 1500.0; p < 2500.0; p += 1.0) top = std::max(top, folding_wall(p));
  for (double p = 2500.0; p < 5000.0; p += 1.0) bottom = std::min(bottom, folding_wall(p));
  ASSERT_GT(top - bottom, 1e-6);
  Index n_folded = 0;
  for (Index ix = 30; ix < m.x.size() - 30; ++ix) {
    const double p = flowing(m.x[ix]), zeta = folding_wall(p);
    if (zeta > bottom + 0.3e-6 && zeta < top - 0.3e-6) {  // the spline bends a little otherwise
      ++n_folded;
      EXPECT_NE(m.pressure_flags(0, ix) & ReadingFlag::ambiguous, 0) << p;
      EXPECT_TRUE(std::isnan(m.pressure(0, ix))) << p;
    } else if (zeta > top + 0.5e-6 || zeta < bottom - 0.5e-6) {
      EXPECT_NEAR(m.pressure(0, ix), p, 80.0);  // levels 500 Pa and more apart on a bent curve
    }
  }
  EXPECT_GT(n_folded, 20);
  EXPECT_TRUE(warns_of(m, "Run fold")) << all_warnings(m);
  EXPECT_TRUE(warns_of(m, "more than one pressure fits")) << all_warnings(m);
}

TEST(Measure, RefusesAMapOfAnotherSizeByName) {
  TestExperiment test;
  twin::Scenario other = small_scenario();
  for (const auto& [along, across] : {std::pair{250, 64}, std::pair{256, 62}}) {
    other.camera.n_along = along;
    other.camera.n_across = across;
    TestExperiment odd(other);
    for (const char* name : {"h05.gsf", "h16.gsf", "f00.gsf", "f01.gsf"}) {
      const HeightMap own = test.map(name);
      test.map(name) = odd.map(name);
      try {
        test.measure();
        FAIL() << name << " of " << along << " x " << across << " pixels was taken";
      } catch (const InputError& error) {
        EXPECT_NE(error.where().find(name), std::string::npos) << error.what();
      }
      test.map(name) = own;
    }
  }
}

TEST(Measure, RefusesRepeatsOfARunOfAnotherSizeByName) {
  twin::Scenario other = small_scenario();
  other.camera.n_along = 250;
  TestExperiment test;
  test.map("f01.gsf") = TestExperiment(other).map("f01.gsf");
  test.twin.flow_csv = "map,flow_rate [mL/min],run\nf00.gsf,20,one\nf01.gsf,20,one\n";
  try {
    test.measure();
    FAIL();
  } catch (const InputError& error) {
    EXPECT_NE(error.where().find("f01.gsf"), std::string::npos) << error.what();
  }
}

}  // namespace
}  // namespace manoscope::pipeline

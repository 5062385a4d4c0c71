#include "manoscope/pipeline/tube_law_findings.hpp"

#include <gtest/gtest.h>

#include <cmath>
#include <string>

#include "manoscope/pipeline/test_experiment.hpp"

namespace manoscope::pipeline {
namespace {

using results::Measurement;

/// A short nitride wall under 10 N/m of prestress that stretches, at a low and a higher flow rate;
/// solved in two seconds.
twin::Scenario plate_scenario() {
  twin::Scenario scenario = small_scenario();
  scenario.name = "plate";
  scenario.channel = {9.0 * mm, 1.2 * mm, 150.0 * um};
  scenario.wall_law = twin::WallLaw::foppl_von_karman;
  scenario.wall = {9.0 * mm, 1.2 * mm, 0.5 * um, 250.0 * GPa, 0.23, 20.0 * MPa};
  scenario.wall_grid = {24, 4};
  scenario.levels.clear();
  for (const double p : {0.0, 150.0, 300.0, 500.0, 800.0, 1200.0, 1700.0, 2400.0, 3300.0, 4500.0,
                         6000.0, 8000.0, 11000.0, 15000.0}) {
    scenario.levels.push_back(Pressure::from_si(p));
  }
  scenario.flow_rates = {10.0 * mL_per_min, 25.0 * mL_per_min};
  scenario.inlet_passage.reset();
  scenario.outlet_passage.reset();
  scenario.camera.n_along = 768;
  scenario.camera.n_across = 128;
  scenario.camera.dropouts = scenario.camera.blobs = scenario.camera.spikes = 0.0;
  scenario.gauge.noise = 5.0 * Pa;
  return scenario;
}

TEST(TubeLawFindings, SeeTheTensionOfAPlateAndItsGrowth) {
  TestExperiment test(plate_scenario());
  const Measurement m = test.measure();
  for (Index r = 0; r < 2; ++r) {
    ASSERT_TRUE(std::isfinite(m.tube_law_b[r])) << m.tube_law;
    const double u = m.tube_law_b_uncertainty[r];
    EXPECT_GT(-m.tube_law_b[r], 3.0 * u) << m.tube_law;
    // 10 N/m and, by Poisson's ratio, a quarter of what stretching adds across: E t/(1 - nu^2) of
    // the strain 1.5 (zeta/(w/2))^2. A membrane's b is up to 12/pi^2 times its tension.
    const double zeta = m.tube_law_deflection[r];
    const double along = 10.0 + 0.23 * 132e3 * 1.5 * std::pow(zeta / 0.6e-3, 2);
    EXPECT_GT(-m.tube_law_b[r], 0.85 * along - 2.0 * u) << m.tube_law;
    EXPECT_LT(-m.tube_law_b[r], 1.22 * along + 2.0 * u) << m.tube_law;
    EXPECT_NEAR(m.healing_length[r], std::sqrt(-m.tube_law_b[r] / m.tube_law_a[r]), 1e-12);
  }
  EXPECT_NEAR(m.tube_law_at_rest_b_small, -10.0 * 1.1,
              2.0 * m.tube_law_at_rest_b_small_uncertainty + 1.5);
  EXPECT_LT(m.tube_law_at_rest_b[13], 3.0 * m.tube_law_at_rest_b_small);
  EXPECT_NE(m.tube_law.find("differs from 0 by"), std::string::npos) << m.tube_law;
  EXPECT_NE(m.tube_law.find("at rest, from the wall's ends"), std::string::npos) << m.tube_law;
  // Mid-channel stiffness: that of the law where the ends are far.
  const Index middle = m.x.size() / 2;
  EXPECT_NEAR(m.stiffness(9, middle) / m.tube_law_at_rest_a[9], 1.0, 0.03);
  EXPECT_GT(m.stiffness(9, 30), 1.1 * m.stiffness(9, middle));  // 0.35 mm from the edge
}

TEST(TubeLawFindings, SayWhatIsMissing) {
  twin::Scenario scenario = small_scenario();
  scenario.flow_rates.clear();
  TestExperiment test(scenario);
  const Measurement m = test.measure();
  EXPECT_EQ(m.tube_law_b.size(), 0);
  EXPECT_EQ(m.tube_law.find("under flow"), std::string::npos) << m.tube_law;
  Measurement none = m;
  none.tube_law_at_rest_deflection.setConstant(kMissing);
  EXPECT_EQ(tube_law_text(none, {"", "no end of the wall is in view"}),
            "at rest not determined: no end of the wall is in view");
  none.run = {"Q1"};
  none.tube_law_deflection = Array1::Constant(1, kMissing);
  EXPECT_EQ(
      tube_law_text(none, {"too few stations have a reading", "so"}),
      "not determined under flow: too few stations have a reading; at rest not determined: so");
}

TEST(TubeLawFindings, NameTheRunsOfLeastAndOfMostDeflection) {
  Measurement m;
  m.run = {"Q1", "Q2", "Q3"};
  m.channel_width = 1.7e-3;
  m.tube_law_deflection = Array1(3);
  m.tube_law_deflection << 9e-6, -2e-6, kMissing;
  m.tube_law_b = Array1(3);
  m.tube_law_b << -40.0, -6.25, kMissing;
  m.tube_law_b_uncertainty = Array1(3);
  m.tube_law_b_uncertainty << 5.0, 0.62, kMissing;
  m.healing_length = Array1::Constant(3, 0.25e-3);
  m.half_response_wavelength = Array1::Constant(3, 1.57e-3);
  m.tube_law_at_rest_deflection = Array1::Constant(2, 20e-6);
  m.tube_law_at_rest_b = Array1::Constant(2, -100.0);
  m.tube_law_at_rest_b_uncertainty = Array1::Constant(2, 8.0);
  m.tube_law_at_rest_b_small = -7.0;
  m.tube_law_at_rest_b_small_uncertainty = 0.4;
  EXPECT_EQ(tube_law_text(m, {}),
            "b = -6.2 ± 1.2 N/m at -2.0 um (Q2), differs from 0 by 10.1 sigma; -40 ± 10 N/m at 9.0 "
            "um (Q1), 8.0 sigma; healing length 0.25 mm, of the fitted wall 0.25 mm, width/pi 0.54 "
            "mm; at rest, from the wall's ends, -7.00 ± 0.80 N/m for small deflections, -100 ± 16 "
            "N/m at 20.0 um");
}

}  // namespace
}  // namespace manoscope::pipeline

// Flow models and constitutive curves against a wall whose answer is not local: the twin of S1 (a
// clamped membrane by the equations of Foeppl and von Karman, coupled to the flow by the twin's own
// solver), its deflections taken as exact.
#include <gtest/gtest.h>

#include <cmath>
#include <string>
#include <vector>

#include "manoscope/calibration/fit_curves.hpp"
#include "manoscope/inversion/test_section.hpp"
#include "manoscope/twin/scenario_file.hpp"
#include "manoscope/twin/solved_scenario.hpp"
#include "manoscope/validation/infer_flow.hpp"
#include "manoscope/validation/predict_flow.hpp"
#include "tests/support/local_wall.hpp"

namespace manoscope::validation {
namespace {

class TwinFlow : public ::testing::Test {
 protected:
  static const twin::SolvedScenario& solved() {
    static const twin::SolvedScenario once = twin::solve_scenario(scenario());
    return once;
  }
  static const twin::Scenario& scenario() {
    static const twin::Scenario demo = [] {
      twin::Scenario made = twin::demo_scenario();
      made.solver.flow_model = "rectangle";
      return made;
    }();
    return demo;
  }

  Array1 x_ = Array1::LinSpaced(200, 0.04e-3, 15.46e-3);

  static Profile exact(const Array1& x, const Array1& zeta) {
    Profile profile = test::exact_profile(x, [](double) { return 0.0; });
    profile.zeta = zeta;
    profile.uncertainty.independent.setConstant(2e-9);
    return profile;
  }
  calibration::ConstitutiveCurves curves() const {
    std::vector<calibration::Level> levels;
    for (std::size_t k = 0; k < solved().levels.size(); ++k) {
      const double p = scenario().levels[k].si();
      levels.push_back(test::level("h" + std::to_string(k), p, p == 0.0 ? 0.0 : 1.0,
                                   exact(x_, solved().levels[k].wall.deflection(x_))));
    }
    return calibration::fit_curves(levels);
  }
  /// The twin's flow is that of a rectangle of the mean gap.
  static FlowSetup setup() {
    FlowSetup result;
    result.channel = scenario().channel;
    result.fluid = scenario().fluid;
    result.shape = flow::WallShape::rigid();
    result.inlet_spread = 0.0;
    result.uncertainty = {0.5 * um};
    return result;
  }
};

TEST_F(TwinFlow, DropIsPredictedFromTheCurvesAlone) {
  const auto all = curves();
  for (const twin::SolvedScenario::Run& run : solved().runs) {
    const double truth = (run.flow.inlet() - run.flow.outlet()).si();
    const FlowPrediction found = predict_flow(all, setup(), flow::FlowModel::momentum,
                                              run.flow.flow_rate, {run.flow.outlet(), {}});
    // 0.2 % are the clamped ends and beta (1.2 in the twin, that of the section here).
    EXPECT_NEAR(found.drop.value / truth, 1.0, 5e-3) << run.flow.flow_rate.in(mL_per_min);
  }
}

TEST_F(TwinFlow, FlowRateIsReadOffTheDeflectionAlone) {
  const auto all = curves();
  for (const twin::SolvedScenario::Run& run : solved().runs) {
    const Profile state = exact(x_, run.flow.deflection(x_));
    const inversion::PressureReading reading = inversion::read_pressure(all, state);
    const auto section =
        inversion::find_test_section(reading, scenario().channel.length, scenario().channel.width);
    ASSERT_TRUE(section);
    const InferredFlow found =
        infer_flow_rate(setup(), flow::FlowModel::momentum, state, reading, *section);
    // 2 %: each station was read on its own, where this wall smooths p over 0.5 mm.
    EXPECT_NEAR(found.value.value / run.flow.flow_rate.si(), 1.0, 0.02)
        << run.flow.flow_rate.in(mL_per_min);
  }
}

}  // namespace
}  // namespace manoscope::validation

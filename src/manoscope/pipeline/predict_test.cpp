#include "manoscope/pipeline/predict.hpp"

#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>

#include "manoscope/pipeline/test_experiment.hpp"
#include "manoscope/twin/solved_scenario.hpp"

namespace manoscope::pipeline {
namespace {

MeasureOptions local() {
  MeasureOptions options = station_by_station();
  options.flow.flow_stations = 80;
  return options;
}

/// Calibrated, and run at two flow rates.
experiment::Experiment read_once() {
  static TestExperiment test(momentum_scenario({10.0 * mL_per_min, 40.0 * mL_per_min}));
  static const experiment::Experiment once = test.read();
  return once;
}

TEST(Predict, FlowRatesThatWereNotRun) {
  const std::vector<FlowRate> asked{20.0 * mL_per_min, 30.0 * mL_per_min};
  const twin::SolvedScenario truth = twin::solve_scenario(momentum_scenario(asked));
  PredictOptions options;
  options.coupling.healing_length = Length{};  // a wall that answers to p at its own place
  const Predictions found = predict(read_once(), asked, options, local());
  ASSERT_EQ(found.flows.size(), 2u);
  EXPECT_EQ(found.outlet, "as the runs have it");
  for (std::size_t i = 0; i < asked.size(); ++i) {
    const auto& flow = truth.runs[i].flow;
    const double drop = (flow.inlet() - flow.outlet()).si();
    const validation::FlowPrediction& one = found.flows[i];
    EXPECT_EQ(one.flow_rate.si(), asked[i].si());
    // 2 %, the goal; and where the outlet lies, a few pascals beyond the test section.
    EXPECT_NEAR(one.drop.value / drop, 1.0, 0.02);
    EXPECT_NEAR(one.pressure[one.pressure.size() - 1], flow.outlet().si(), 0.005 * drop);
    const Array1 zeta = flow.deflection(one.x);
    EXPECT_LT((one.zeta - zeta).abs().maxCoeff(), 0.03 * zeta.abs().maxCoeff());
  }
}

TEST(Predict, TellsWhichInputsCountAsExact) {
  experiment::Experiment experiment = read_once();
  PredictOptions options;
  options.model = "creeping";
  const auto exact = [&] {
    return predict(experiment, {20.0 * mL_per_min}, options, local()).taken_as_exact;
  };
  experiment.channel.height_uncertainty.reset();
  experiment.fluid.viscosity_uncertainty = experiment.fluid.viscosity * 0.01;
  experiment.instrument.flow_rate_uncertainty.reset();
  EXPECT_EQ(exact(), (std::vector<std::string>{"the gap (channel.height)", "the flow rate"}));
  experiment.channel.height_uncertainty = 0.5 * um;
  experiment.instrument.flow_rate_uncertainty = 0.005;
  EXPECT_EQ(exact(), std::vector<std::string>{});
}

TEST(Predict, TakesModelAndOutletAsGiven) {
  PredictOptions options;
  options.model = "creeping";
  options.outlet_pressure = 500.0 * Pa;
  options.outlet_uncertainty = 50.0 * Pa;
  const Predictions found = predict(read_once(), {20.0 * mL_per_min}, options, local());
  const validation::FlowPrediction& one = found.flows[0];
  EXPECT_EQ(one.model, flow::FlowModel::creeping);
  EXPECT_EQ(one.pressure[one.pressure.size() - 1], 500.0);
  EXPECT_NEAR(one.uncertainty.standard()[one.pressure.size() - 1], 50.0, 1e-6);
  EXPECT_EQ(found.outlet, "as given");
}

TEST(Predict, GoesAsFarBeyondTheCalibrationAsItIsTold) {
  double highest = 0.0;
  for (const auto& level : read_once().hydrostatic) {
    highest = std::max(highest, level.pressure.si());
  }
  PredictOptions options;
  options.model = "creeping";
  options.outlet_pressure = Pressure::from_si(1.2 * highest);
  options.coupling.healing_length = Length{};
  EXPECT_THROW(predict(read_once(), {1.0 * mL_per_min}, options, local()), InputError);
  options.coupling.largest_extrapolation = 0.3;
  const auto flow = predict(read_once(), {1.0 * mL_per_min}, options, local()).flows[0];
  const Index middle = flow.x.size() / 2;
  EXPECT_NE(flow.flags[middle] & validation::PredictionFlag::out_of_calibration, 0);
  EXPECT_GT(flow.pressure[middle], 1.2 * highest);
}

TEST(Predict, RefusesWhatIsNoFlowRate) {
  const auto refused = [](const std::vector<FlowRate>& asked, const PredictOptions& options = {}) {
    try {
      predict(read_once(), asked, options, local());
    } catch (const InputError& error) {
      return error.where() + " " + error.found();
    }
    return std::string();
  };
  EXPECT_EQ(refused({}), "--flow-rate is not given");
  EXPECT_EQ(refused({-3.0 * mL_per_min}), "--flow-rate is -3 mL/min");
  PredictOptions options;
  options.outlet_uncertainty = -1.0 * Pa;
  EXPECT_EQ(refused({3.0 * mL_per_min}, options), "--outlet-uncertainty is -1 Pa");
  options = {};
  options.model = "momentun";
  EXPECT_NE(refused({3.0 * mL_per_min}, options).find("momentun"), std::string::npos);
  // Far beyond the calibration.
  options = {};
  options.model = "momentum";
  options.outlet_pressure = 300.0 * Pa;
  EXPECT_NE(refused({400.0 * mL_per_min}, options).find("predicted flow"), std::string::npos);
}

}  // namespace
}  // namespace manoscope::pipeline

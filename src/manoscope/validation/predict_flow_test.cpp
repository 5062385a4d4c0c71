#include "manoscope/validation/predict_flow.hpp"

#include <gtest/gtest.h>

#include <cmath>
#include <cstdio>
#include <cstdlib>
#include <string>

#include "manoscope/core/error.hpp"
#include "manoscope/validation/test_coupled_trial.hpp"

namespace manoscope::validation {
namespace {

using flow::FlowModel;

FlowPrediction predict(const CoupledTrial& trial, const FlowSetup& setup, FlowModel model,
                       FlowRate flow_rate) {
  return predict_flow(trial.curves(), setup, model, flow_rate, {trial.outlet, {}},
                      {trial.gain, Pressure::from_si(trial.zero)});
}

/// The flow rate behind "at most" in the error of a prediction, mL/min; 0 without an error.
template <class Predict>
double hinted(const Predict& predict, double ml_per_min) {
  try {
    predict(ml_per_min);
  } catch (const InputError& error) {
    const std::string words = error.mend(), before = "at most ";
    const auto at = words.find(before);
    return at == std::string::npos ? std::nan("") : std::atof(words.c_str() + at + before.size());
  }
  return 0.0;
}

/// Every one of these flow rates is refused with the same hint, the hint is answered, and it is the
/// largest: 15 % more (10 % of it the rounding to two digits) are refused.
template <class Predict>
void expect_one_limit(const std::vector<double>& too_large, const Predict& predict) {
  const double hint = hinted(predict, too_large.front());
  ASSERT_GT(hint, 0.0);
  for (const double asked : too_large) {
    EXPECT_LT(hint, asked);
    EXPECT_NEAR(hinted(predict, asked) / hint, 1.0, 0.05) << asked;
  }
  EXPECT_NO_THROW(predict(hint)) << hint;
  EXPECT_GT(hinted(predict, 1.15 * hint), 0.0) << hint;
}

TEST(PredictFlow, MeetsTheCoupledTruthAtAFlowRateNeverRun) {
  CoupledTrial trial;  // no errors: seed 0
  trial.x = Array1::LinSpaced(125, 0.05e-3, trial.wall.length - 0.05e-3);
  const FlowSetup setup = observed(kChannel, kOil);
  for (const double share : {0.3, 1.0, 1.4}) {
    trial.flow_rate = share * kOilFlow;
    const Array1 truth = trial.fine_pressure();
    const FlowPrediction found = predict(trial, setup, FlowModel::creeping, trial.flow_rate);
    // Curves between 16 levels (0.1 %), zeta straight between stations 0.12 mm apart.
    for (Index i = 0; i < found.x.size(); ++i) {
      EXPECT_NEAR(found.pressure[i], trial.at(truth, found.x[i]), 1.5e-3 * truth[0]) << share;
    }
    EXPECT_EQ(found.flags.maxCoeff(), 0);
    EXPECT_NEAR(found.drop.value, found.pressure[0] - trial.outlet.si(), 1e-6);
    EXPECT_LE(found.steps, 8);  // Newton
  }
}

TEST(PredictFlow, MeetsTheTruthWithInertia) {
  CoupledTrial trial;
  trial.fluid = kWater;
  trial.inertia = true;
  trial.flow_rate = 45.0 * mL_per_min;
  const Array1 truth = trial.fine_pressure();
  const FlowSetup setup = observed(kChannel, kWater);
  const FlowPrediction found = predict(trial, setup, FlowModel::momentum, trial.flow_rate);
  for (Index i = 0; i < found.x.size(); ++i) {
    EXPECT_NEAR(found.pressure[i], trial.at(truth, found.x[i]),
                4e-3 * truth[0]);  // stations 0.6 mm apart
  }
  EXPECT_GT(found.speed_index.maxCoeff(), 0.0);
  EXPECT_LT(found.speed_index.maxCoeff(), 1.0);
  // A march is another model: within its stated error and that of `momentum` here.
  const FlowPrediction march = predict(trial, setup, FlowModel::plane_march, trial.flow_rate);
  EXPECT_NEAR(march.drop.value / found.drop.value, 1.0,
              march.error.half_width + found.error.half_width);
}

TEST(PredictFlow, IsConsistent) {
  CoupledTrial trial;
  const FlowSetup setup = observed(kChannel, kOil);
  const FlowPrediction found = predict(trial, setup, FlowModel::creeping, kOilFlow);
  // The pressure of the predicted deflection is the predicted pressure: what a settled fixed point
  // is, to the tolerance.
  flow::FlowCase flow = flow_case(setup, kOilFlow, {found.x, found.zeta, found.station});
  flow.outlet_pressure = trial.outlet;
  const Array1 again = flow::pressure_along(FlowModel::creeping, flow, *setup.tables).pressure;
  EXPECT_LT((again - found.pressure).abs().maxCoeff(), 1e-6 * found.pressure[0]);
}

TEST(PredictFlow, CoversTheTruthAsOftenAsItSays) {
  const FlowUncertainty stated{kHeightUncertainty, 0.005 * kOil.viscosity, 0.005};
  const FlowSetup setup = observed(kChannel, kOil, stated);
  constexpr int kSeeds = 150;
  int covered = 0, covered_inside = 0;
  double squares = 0.0, bar = 0.0;
  for (int seed = 1; seed <= kSeeds; ++seed) {
    CoupledTrial trial;
    trial.seed = static_cast<std::uint64_t>(seed) + 5000;
    trial.gain = 1e-3;
    trial.zero = 5.0;
    RandomStream draw(trial.seed, "truth");
    trial.channel.height = kChannel.height + draw.normal() * kHeightUncertainty;
    trial.fluid.viscosity = kOil.viscosity + draw.normal() * stated.viscosity;
    trial.flow_rate = (1.0 + 0.005 * draw.normal()) * kOilFlow;
    const Array1 truth = trial.fine_pressure();
    const FlowPrediction found = predict(trial, setup, FlowModel::creeping, kOilFlow);
    const double u = found.drop.standard_uncertainty();
    const double pull = (found.drop.value - (truth[0] - trial.outlet.si())) / u;
    covered += std::abs(pull) <= kExpansion;
    squares += pull * pull;
    bar = std::max(bar, u / found.drop.value);
    const Index middle = found.x.size() / 2;
    covered_inside += std::abs(found.pressure[middle] - trial.at(truth, found.x[middle])) <=
                      kExpansion * found.uncertainty.standard()[middle];
  }
  EXPECT_GE(covered, 0.90 * kSeeds);  // 95.4 +- 1.7 %: three sigma
  EXPECT_GE(covered_inside, 0.90 * kSeeds);
  EXPECT_NEAR(std::sqrt(squares / kSeeds), 1.0, 0.18);  // three sigma of 1/sqrt(300)
  std::printf("dp: covered %d and %d of %d, pulls rms %.2f, bar %.2f %%\n", covered, covered_inside,
              kSeeds, std::sqrt(squares / kSeeds), bar * 100.0);
}

TEST(PredictFlow, PropagatesThroughTheWall) {
  // A higher gap lowers p, which lowers zeta, which takes part of it back: by differences.
  CoupledTrial trial;
  const FlowSetup setup = observed(kChannel, kOil);
  const FlowPrediction found = predict(trial, setup, FlowModel::creeping, kOilFlow);
  flow::Channel higher = kChannel;
  higher.height = kChannel.height + kHeightUncertainty;
  const FlowPrediction moved =
      predict(trial, observed(higher, kOil), FlowModel::creeping, kOilFlow);
  double effect = 0.0;
  for (const Estimate::Term& term : found.drop.terms) {
    if (term.variable == "channel height") effect = term.effect;
  }
  // 0.3 % of 2 h0: second order leaves 1 % of the first.
  EXPECT_NEAR((moved.drop.value - found.drop.value) / effect, 1.0, 0.015);
}

TEST(PredictFlow, FlagsWhatLiesBeyondTheCalibrationAndRefusesWhatIsFarBeyond) {
  CoupledTrial trial;
  const FlowSetup setup = observed(kChannel, kOil);
  const auto curves = trial.curves();  // up to 20 kPa
  PredictFlowOptions options;
  options.largest_extrapolation = 0.25;
  FlowSetup wide = setup;
  wide.tables = nullptr;
  const FlowPrediction found = predict_flow(curves, wide, FlowModel::creeping, 2.0 * kOilFlow,
                                            {trial.outlet, {}}, {}, options);
  ASSERT_GT(found.pressure[0], 20e3);
  for (Index i = 1; i < found.x.size() - 1; ++i) {
    EXPECT_EQ((found.flags[i] & PredictionFlag::out_of_calibration) != 0, found.pressure[i] > 20e3);
  }
  EXPECT_NE(found.flags[0] & PredictionFlag::downstream_doubt, 0);
  EXPECT_EQ(found.flags[found.x.size() - 1], 0);
  EXPECT_THROW(predict(trial, wide, FlowModel::creeping, 4.0 * kOilFlow), InputError);
}

TEST(PredictFlow, SaysWhereTheFlowChokes) {
  // A wall as soft as foil, 3 Pa/um, and suction at the outlet: the wall bows in before it, and the
  // faster the flow the lower the pressure in that throat. A pulse runs there at
  // sqrt(h/(rho dzeta/dp)) = 0.6 m/s, 6 mL/min.
  CoupledTrial trial;
  trial.wall.stiffness = 3e6;
  trial.wall.stretching = 1e9;  // nothing
  std::vector<Level> levels;
  for (int k = -8; k <= 16; ++k) {
    const double p = 50.0 * k;
    levels.push_back(test::level(
        "h" + std::to_string(k), p, k == 0 ? 0.0 : 0.1,
        test::exact_profile(trial.x, [&](double at) { return trial.wall.zeta(at, p); })));
  }
  FlowSetup setup = observed(kChannel, {0.3 * mPa_s, 998.0 * kg_per_m3});
  setup.tables = nullptr;
  const FlowSetup ready = with_tables(setup, -160.0 * um, 300.0 * um);
  const auto curves = calibration::fit_curves(levels);
  const auto predicted = [&](double ml_per_min) {
    return predict_flow(curves, ready, FlowModel::momentum, ml_per_min * mL_per_min,
                        {-200.0 * Pa, {}});
  };
  EXPECT_LT(predicted(5.0).speed_index.maxCoeff(), 0.5);
  try {
    predicted(20.0);
    FAIL() << "no error";
  } catch (const InputError& error) {
    EXPECT_NE(std::string(error.what()).find("chokes"), std::string::npos) << error.what();
  }
  expect_one_limit({20.0, 10.0, 40.0, 1e4}, predicted);
}

TEST(PredictFlow, NamesTheLargestFlowRateThatHasAnAnswerWhateverIsAsked) {
  CoupledTrial trial;
  const auto curves = trial.curves();  // up to 20 kPa
  FlowSetup creeping = observed(kChannel, kOil), inertial = observed(kChannel, kWater);
  creeping.tables = inertial.tables = nullptr;
  const auto outlet = [](FlowRate flow_rate) {  // rises as behind a passage
    return Outlet{Pressure::from_si(100.0 + 20.0 * flow_rate.in(mL_per_min)), {}};
  };
  expect_one_limit({20.0, 60.0, 300.0, 1e6}, [&](double ml_per_min) {
    predict_flow(curves, creeping, FlowModel::creeping, ml_per_min * mL_per_min, outlet);
  });
  expect_one_limit({400.0, 500.0, 1e3, 1e4, 1e9}, [&](double ml_per_min) {
    predict_flow(curves, inertial, FlowModel::momentum, ml_per_min * mL_per_min, outlet);
  });
}

TEST(PredictFlow, SaysWhenNoFlowRateHasAnAnswer) {
  CoupledTrial trial;
  trial.outlet = 40.0 * kPa;  // twice the calibrated range
  try {
    predict(trial, observed(kChannel, kOil), FlowModel::creeping, kOilFlow);
    FAIL() << "no error";
  } catch (const InputError& error) {
    const std::string words = error.what();
    EXPECT_NE(words.find("nor at any lower flow rate"), std::string::npos) << words;
    EXPECT_NE(words.find("another outlet pressure"), std::string::npos) << words;
  }
}

TEST(PredictFlow, RefusesCurvesOfNoStation) {
  CoupledTrial trial;
  auto curves = trial.curves();
  for (auto& curve : curves.curves) curve.reset();
  EXPECT_THROW(predict_flow(curves, observed(kChannel, kOil), FlowModel::paper, kOilFlow),
               InputError);
}

}  // namespace
}  // namespace manoscope::validation

#include <gtest/gtest.h>

#include "manoscope/pipeline/predict.hpp"

namespace manoscope::pipeline {
namespace {

validation::FlowPrediction prediction(double inlet, double gap) {
  validation::FlowPrediction flow;
  flow.flow_rate = 80.0 * mL_per_min;
  flow.drop.value = 1000.0;
  flow.drop.terms = {{"inlet profile", "inlet profile", inlet},
                     {"channel height", "channel height", gap}};
  flow.flags = Flags1::Zero(3);
  return flow;
}

TEST(DoubtPrediction, NamesTheLargestSourceOfAWideBarAndWhatMendsIt) {
  // u = 150 Pa: U is 30 % of the drop; 120^2/150^2 = 64 %.
  EXPECT_EQ(
      doubt_prediction(prediction(120.0, 90.0)),
      "At 80 mL/min U is 30 % of the drop, 64 % of its variance from the inlet profile: state "
      "how far it is known, profile and spread under [inlet].");
  EXPECT_NE(doubt_prediction(prediction(90.0, 120.0)).find("channel.height_uncertainty"),
            std::string::npos);
  EXPECT_EQ(doubt_prediction(prediction(100.0, 70.0)), "");  // 24 %
}

TEST(DoubtPrediction, TellsOfAWallBeyondItsCalibration) {
  auto flow = prediction(120.0, 90.0);
  flow.flags[0] = validation::PredictionFlag::out_of_calibration;
  EXPECT_NE(doubt_prediction(flow).find("beyond its calibration"), std::string::npos);
}

}  // namespace
}  // namespace manoscope::pipeline

#include "manoscope/pipeline/judge_stations.hpp"

#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <limits>
#include <string>

#include "manoscope/pipeline/test_judged_run.hpp"

namespace manoscope::pipeline {
namespace {

constexpr double kNan = std::numeric_limits<double>::quiet_NaN();

/// Silent at 4 mm, under a name that CSV must quote.
struct Case : test_support::JudgedRunCase {
  Case() : JudgedRunCase("Q,5") {
    m.pressure(0, 4) = m.pressure_lower(0, 4) = m.pressure_upper(0, 4) = kNan;
  }
};

TEST(JudgeStations, WriteEveryStationAsARow) {
  const Case test;
  const std::string text = station_table(judge_stations(test.m, test.truth, {{}, "no levels"}));
  EXPECT_EQ(text.substr(0, text.find('\n')),
            "run,x_m,in_section,pressure_Pa,true_pressure_Pa,error_Pa,uncertainty_Pa,pull,covered,"
            "deflection_m,true_deflection_m,deflection_error_m,deflection_uncertainty_m,"
            "neighbourhood_Pa,label_error_Pa,map_error_Pa,curve_shape_error_Pa,locality_error_Pa,"
            "curve_shape_and_locality_error_Pa");
  EXPECT_EQ(std::count(text.begin(), text.end(), '\n'), 1 + 11);
  // At 2 mm: read 805, true 800, inside the section, 2.5 uncertainties off and not covered.
  EXPECT_NE(text.find("\n\"Q,5\",0.002,1,805,800,5,2,2.5,0,4e-09,0,4e-09,2e-09,,,,,,\n"),
            std::string::npos)
      << text;
  EXPECT_NE(text.find("\n\"Q,5\",0,0,1003,1000,3,2,1.5,1,"), std::string::npos) << text;
  EXPECT_NE(text.find("\n\"Q,5\",0.004,1,,600,,2,,,4e-09,"), std::string::npos) << text;
}

TEST(JudgeStations, ShowTheSplitWhereThereIsOne) {
  const Case test;
  SplitJudgement split;
  RunSplit run{"Q,5", {}, {}};
  run.stations.split = Flags1::Zero(11);
  run.stations.split[2] = 1;
  run.stations.neighbourhood = Array1::Constant(11, 0.5);
  run.stations.labels = Array1::Constant(11, 4.0);
  run.stations.maps = Array1::Constant(11, 3.0);
  run.stations.curve_shape_and_locality = Array1::Constant(11, -2.0);
  split.runs = {run};
  std::string text = station_table(judge_stations(test.m, test.truth, split));
  EXPECT_NE(text.find("2e-09,0.5,4,3,,,-2\n"), std::string::npos) << text;
  EXPECT_NE(text.find("\n\"Q,5\",0.003,1,703,700,3,2,1.5,1,4e-09,0,4e-09,2e-09,,,,,,\n"),
            std::string::npos);
  split.runs[0].stations.curve_shape = Array1::Constant(11, -3.0);
  split.runs[0].stations.locality = Array1::Constant(11, 1.0);
  text = station_table(judge_stations(test.m, test.truth, split));
  EXPECT_NE(text.find("2e-09,0.5,4,3,-3,1,-2\n"), std::string::npos) << text;
}

TEST(JudgeStations, OfNoRunsAreAHeadline) { EXPECT_EQ(station_table({}), "run\n"); }

}  // namespace
}  // namespace manoscope::pipeline

#include <gtest/gtest.h>

#include <limits>
#include <string>

#include "manoscope/core/flags.hpp"
#include "manoscope/pipeline/assemble.hpp"

namespace manoscope::pipeline {
namespace {

/// An experiment in which nothing is doubtful, put together by hand.
struct CleanCase {
  experiment::Experiment experiment;
  maps::FoundPlace place;
  ReducedExperiment reduced;
  calibration::ConstitutiveCurves curves;
  std::vector<LevelDoubt> levels;
  std::vector<FlowRun> runs;
  std::vector<RunFindings> findings;

  CleanCase() {
    experiment.channel.length = 15.5 * mm;
    experiment.channel.width = 1.7 * mm;
    experiment.channel.height_uncertainty = 0.5 * um;
    experiment.instrument.height_noise = 20.0 * nm;
    experiment.flow.resize(1);
    place.length_misfit = place.width_misfit = std::numeric_limits<double>::quiet_NaN();
    place.along_misfit = place.across_misfit = std::numeric_limits<double>::quiet_NaN();
    experiment.channel.height = 175.0 * um;
    reduced.frame.length = 15.5 * mm;
    reduced.frame.width = 1.7 * mm;
    for (int k = 0; k < 3; ++k) {
      maps::ReducedMap map;
      map.condition.noise.sigma = 20.0 * nm;
      map.condition.missing = 0.02;
      reduced.hydrostatic.push_back(map);
    }
    reduced.flow.push_back(reduced.hydrostatic[0]);
    curves.x = Array1::LinSpaced(4, 1e-3, 14e-3);
    for (int k = 0; k < 8; ++k) {
      calibration::Level level{"h" + std::to_string(k), 1.0 * k * kPa, 10.0 * Pa, {}};
      level.profile.x = curves.x;
      level.profile.zeta = Array1::Constant(4, 1e-6 * k);
      level.profile.flags = Flags1::Zero(4);
      curves.levels.push_back(level);
    }
    FlowRun run;
    run.name = "Q5";
    runs.push_back(run);
    RunFindings found;
    found.reading.x = Array1::LinSpaced(16, 0.0, 15e-3);
    found.reading.flags = Flags1::Zero(16);
    found.stretch = {2.0 * mm, 13.0 * mm};
    found.section = inversion::TestSection{2, 13};
    findings.push_back(found);
  }
  std::vector<std::string> doubts() const {
    return find_doubts(experiment, place, reduced, curves, levels, runs, findings);
  }
  /// The one doubt there should be.
  std::string only() const {
    const auto found = doubts();
    EXPECT_EQ(found.size(), 1u);
    return found.empty() ? "" : found.front();
  }
};

void expect_says(const std::string& text, const std::string& part) {
  EXPECT_NE(text.find(part), std::string::npos) << text;
}

TEST(FindDoubts, AreNoneInACleanExperiment) {
  CleanCase clean;
  EXPECT_TRUE(clean.doubts().empty());
  clean.place.length_misfit = 0.08e-3;  // found, and within 5 % of the width
  clean.place.width_misfit = -0.08e-3;
  clean.reduced.grid = {256, 64, 64.0 * um, 39.0 * um};
  clean.place.length_misfit = 0.12e-3;  // within two pixels
  clean.experiment.instrument.height_noise.reset();
  EXPECT_TRUE(clean.doubts().empty());
}

TEST(FindDoubts, OfTheStatedSizeNameItsKey) {
  CleanCase test;
  test.place.width_misfit = 0.01e-3;
  test.place.length_misfit = -1.0e-3;
  const std::string doubt = test.only();
  expect_says(doubt, "14.50 mm");
  expect_says(doubt, "channel.length");
  test.place.length_misfit = 0.0;
  test.place.width_misfit = 0.2e-3;
  expect_says(test.only(), "channel.width");
}

TEST(FindDoubts, OfAGivenOriginTellWhereTheWallLies) {
  CleanCase test;
  test.reduced.grid = {1024, 192, 16.0 * um, 16.0 * um};
  test.place.along_misfit = 0.08e-3;  // 5 % of the width are 0.085 mm
  test.place.across_misfit = -0.08e-3;
  EXPECT_TRUE(test.doubts().empty());
  test.place.along_misfit = -0.5e-3;
  expect_says(test.only(), "lies 0.50 mm further upstream of where");
  test.place.across_misfit = -2.0e-3;
  expect_says(test.only(), "0.50 mm further upstream and 2.00 mm to one side");
  test.place.along_misfit = 0.0;
  expect_says(test.only(), "lies 2.00 mm to one side");
  // Said once, though the ends of the wall tell it, too.
  test.reduced.offset = maps::MapShift{0.4 * mm, 1.0 * um};
  EXPECT_EQ(test.doubts().size(), 1u);
}

TEST(FindDoubts, OfTheWallsEndsTellAnOriginThatIsOffByLess) {
  CleanCase test;
  test.reduced.grid = {1024, 192, 16.0 * um, 16.0 * um};
  test.reduced.offset = maps::MapShift{15.0 * um, 1.0 * um};  // within 1 % of the width
  EXPECT_TRUE(test.doubts().empty());
  test.reduced.offset = maps::MapShift{100.0 * um, 1.0 * um};
  expect_says(test.only(), "0.100 mm further downstream");
  expect_says(test.only(), "channel.origin");
  test.reduced.offset = maps::MapShift{100.0 * um, 30.0 * um};  // may be nothing
  EXPECT_TRUE(test.doubts().empty());
}

TEST(FindDoubts, TellMarksOfTheInstrumentThatNeverMove) {
  CleanCase test;
  for (auto& map : test.reduced.hydrostatic) map.condition.texture_contradicts = true;
  expect_says(test.only(), "instrument.reference");
}

TEST(FindDoubts, OfTheWallsSidesTellOffsetAndRotationApart) {
  CleanCase test;
  test.reduced.grid = {1024, 192, 16.0 * um, 16.0 * um};
  test.reduced.centre = maps::CentreLine{30.0 * um, 0.003};
  EXPECT_TRUE(test.doubts().empty());  // within 2 % of the width, at the ends, too
  test.reduced.centre->offset = -100.0 * um;
  expect_says(test.only(), "0.100 mm to one side");
  test.reduced.centre = maps::CentreLine{Length{}, 0.01};
  const std::string doubt = test.only();
  expect_says(doubt, "askew by 0.57 deg");
  expect_says(doubt, "channel.rotation");
}

TEST(FindDoubts, OfARimThatBendsFromMapToMapTellHowFar) {
  CleanCase test;
  for (auto& map : test.reduced.hydrostatic) map.condition.bend.at_middle_uncertainty = 2.0 * nm;
  test.reduced.flow[0].condition.bend.at_middle_uncertainty = 2.0 * nm;
  test.reduced.hydrostatic[1].condition.bend.at_middle = 8.0 * nm;  // 6 nm off the mean: 3 sigma
  EXPECT_TRUE(test.doubts().empty());
  test.reduced.hydrostatic[1].condition.bend.at_middle = 100.0 * nm;
  const std::string doubt = test.only();
  expect_says(doubt, "bends from map to map: by up to 75.0 nm (u = 2.0 nm)");
  expect_says(doubt, "--level-order 2");
  test.reduced.level_order = 2;  // it was subtracted
  EXPECT_TRUE(test.doubts().empty());
}

TEST(FindDoubts, OfARimThatIsBentAlikeInAllMapsTellWhatItDoesToQr) {
  CleanCase test;
  const auto bend_all = [&](Length bend) {
    for (auto* maps : {&test.reduced.hydrostatic, &test.reduced.flow}) {
      for (auto& map : *maps) {
        map.condition.bend.at_middle = bend;
        map.condition.bend.at_middle_uncertainty = 2.0 * nm;
      }
    }
  };
  bend_all(400.0 * nm);  // the height itself is known to 500 nm
  EXPECT_TRUE(test.doubts().empty());
  bend_all(700.0 * nm);
  const std::string doubt = test.only();
  expect_says(doubt, "alike in all maps: by 700 nm");
  expect_says(doubt, "makes QR 1.2 % too small");  // 3 x 0.7 um of 175 um
  bend_all(-700.0 * nm);
  expect_says(test.only(), "too large");
  test.experiment.channel.height_uncertainty = 1.0 * um;
  EXPECT_TRUE(test.doubts().empty());
}

TEST(FindDoubts, OfFalseFringeOrdersThatStayTellHowMuchIsLeftOut) {
  CleanCase test;
  test.reduced.grid = {100, 50, 16.0 * um, 16.0 * um};
  test.reduced.hydrostatic[0].condition.fringe.flagged_pixels = 5;  // single noisy ones
  EXPECT_TRUE(test.doubts().empty());
  test.reduced.hydrostatic[1].condition.fringe.flagged_pixels = 60;
  test.reduced.flow[0].condition.fringe.flagged_pixels = 55;
  const std::string doubt = test.only();
  expect_says(doubt, "2 maps have patches of a false fringe order");
  expect_says(doubt, "up to 1.2 %");
}

TEST(FindDoubts, OfMapsTellHowManyAndHowBad) {
  CleanCase noisy;
  noisy.reduced.flow[0].condition.noise.sigma = 50.0 * nm;
  noisy.reduced.hydrostatic[1].condition.noise.sigma = 30.0 * nm;
  const std::string doubt = noisy.only();
  expect_says(doubt, "2 maps are noisier");
  expect_says(doubt, "2.5 times");
  CleanCase gappy;
  gappy.reduced.hydrostatic[2].condition.missing = 0.31;
  expect_says(gappy.only(), "31 %");
  CleanCase correlated;
  correlated.reduced.flow[0].condition.noise.length_z = 4.2;
  expect_says(correlated.only(), "4.2 pixels");
}

TEST(FindDoubts, OfTheGapUncertaintyNeedARun) {
  CleanCase test;
  test.experiment.channel.height_uncertainty.reset();
  expect_says(test.only(), "channel.height_uncertainty");
  test.experiment.flow.clear();
  test.runs.clear();
  test.findings.clear();
  EXPECT_TRUE(test.doubts().empty());
}

TEST(FindDoubts, CountSilentStationsClearOfTheEndsEvenBeyondTheSection) {
  CleanCase test;
  Flags1& flags = test.findings[0].reading.flags;
  flags[2] = flags[3] = ReadingFlag::out_of_calibration | ReadingFlag::outside_test_section;
  flags[0] = flags[15] = ReadingFlag::ambiguous;  // at the clamped ends: nobody expects an answer
  test.findings[0].section = inversion::TestSection{4, 13};
  const std::string doubt = test.only();
  expect_says(doubt, "Run Q5: 2 of 12 stations");
  expect_says(doubt, "outside the calibrated levels");
  flags[8] = ReadingFlag::ambiguous;
  flags[9] = ReadingFlag::insensitive;
  EXPECT_EQ(test.doubts().size(), 3u);
}

TEST(FindDoubts, OfARunWithoutATestSectionSayWhy) {
  CleanCase test;
  test.findings[0].section.reset();
  test.findings[0].reading.flags.setConstant(ReadingFlag::out_of_calibration);
  const std::string doubt = test.only();
  expect_says(doubt, "Run Q5: no test section");
  expect_says(doubt, "16 of 16 out of calibration, 0 ambiguous");
}

TEST(FindDoubts, OfTheCalibrationNameWhatToCheck) {
  CleanCase test;
  test.levels.push_back({"h3", 3000.0, 3330.0, 12.0});
  expect_says(test.only(), "Level h3: labelled 3000 Pa, but its map reads 3330 Pa");
  test.levels.clear();
  test.curves.levels.resize(5);
  expect_says(test.only(), "Only 5 levels");
}

TEST(FindDoubts, OfLabelsTakenAsExactAreOneCauseHoweverManyLevelsDisagree) {
  CleanCase test;
  test.experiment.hydrostatic.resize(3);  // neither list nor instrument gives an uncertainty
  expect_says(test.only(), "No pressure label has an uncertainty");
  EXPECT_EQ(test.only().find("differ"), std::string::npos);
  for (int k = 0; k < 17; ++k) {
    test.levels.push_back({"h" + std::to_string(k), 1000.0 * k, 1000.0 * k - 12.0 - k, -9.0});
  }
  const std::string doubt = test.only();
  expect_says(doubt, "the maps of 17 levels differ from their labels");
  expect_says(doubt, "most of all h16: labelled 16000 Pa, it reads 15972 Pa");
  for (auto& map : test.experiment.hydrostatic) map.pressure_uncertainty = Pressure{};
  expect_says(test.only(), "stated uncertainty of 0");
  // With an uncertainty the levels are told one by one again.
  for (auto& map : test.experiment.hydrostatic) map.pressure_uncertainty = 10.0 * Pa;
  EXPECT_EQ(test.doubts().size(), 17u);
}

TEST(FindDoubts, OfAWallThatMovesInwardNameTheSign) {
  CleanCase test;
  for (auto& level : test.curves.levels) level.profile.zeta = -level.profile.zeta;
  test.levels.push_back({"h3", 3000.0, 3330.0, 12.0});  // says nothing then
  expect_says(test.only(), "channel.outward");
}

TEST(FindDoubts, OfTheSameFileTwiceNameBoth) {
  CleanCase test;
  test.experiment.flow.resize(2);
  test.experiment.flow[0].name = "f0.gsf";
  test.experiment.flow[1].name = "f1.gsf";
  test.reduced.hash = {"abc", "abc"};
  expect_says(test.only(), "f0.gsf and f1.gsf are the same file");
}

TEST(FindDoubts, OfTheFlowAreLoud) {
  CleanCase test;
  test.runs[0].flow_rate = 5.0 * mL_per_min;
  test.findings[0].agreement = validation::DropAgreement{};
  test.findings[0].agreement->extracted.value = -900.0;
  test.findings[0].agreement->resistance.value = 1000.0;
  test.findings[0].agreement->en_number = 50.0;
  expect_says(test.only(), "channel.flow");
  test.findings[0].agreement->extracted.value = 900.0e3;
  expect_says(test.only(), "check the units");
  test.findings[0].agreement->en_number = 2.0;
  EXPECT_TRUE(test.doubts().empty());
  // 966 Pa of 13940 Pa are far beyond small error bars at 70 mL/min, but the fluid's gain of speed
  // from a gap of 175 + 35.5 um to 175 + 21.5 um takes 939 Pa, and QR leaves that out.
  test.findings[0].agreement->extracted.value = 13940.0;
  test.findings[0].agreement->resistance.value = 12974.0;
  test.findings[0].agreement->en_number = 11.0;
  expect_says(test.only(), "check the units");
  test.experiment.channel.height = 175.0 * um;
  test.experiment.fluid.density = 998.0 * kg_per_m3;
  test.runs[0].flow_rate = 70.0 * mL_per_min;
  test.runs[0].profile.zeta = Array1::LinSpaced(16, 38e-6, 19e-6);
  EXPECT_TRUE(test.doubts().empty());
  test.runs[0].flow_rate = 7.0 * mL_per_min;  // a hundredth of it
  expect_says(test.only(), "check the units");
  test.runs[0].flow_rate = 5.0 * mL_per_min;
  test.findings[0].agreement.reset();
  test.findings[0].no_comparison = "gap at station 3 is -1 um";
  expect_says(test.only(), "no hydraulic resistance, for the gap at station 3");
}

}  // namespace
}  // namespace manoscope::pipeline

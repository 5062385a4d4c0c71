#include "manoscope/experiment/file_name_guess.hpp"

#include <gtest/gtest.h>

#include <cmath>
#include <string>

namespace manoscope::experiment {
namespace {

using List = FileNameGuess::List;

TEST(FileNameGuess, ReadsPressures) {
  struct Case {
    const char* name;
    double pascals;
    const char* text;
  };
  for (const Case& c :
       {Case{"S1_2.3kPa.gsf", 2300, "2.3kPa"}, Case{"2p3kPa.gsf", 2300, "2p3kPa"},
        Case{"p=100Pa.txt", 100, "100Pa"}, Case{"h_0.5mbar", 50, "0.5mbar"},
        Case{"h_0,5mbar.txt", 50, "0,5mbar"}, Case{"cal 12 KPA rep2.gsf", 12000, "12 KPA"},
        Case{"S1-50Pa_03.gsf", 50, "50Pa"}, Case{"S1_-50Pa_03.gsf", -50, "-50Pa"},
        Case{"-50Pa.gsf", -50, "-50Pa"}, Case{"h1e3Pa.gsf", 1000, "1e3Pa"},
        Case{"0.1MPa.gsf", 1e5, "0.1MPa"}, Case{"x_10_mmH2O.gsf", 98.0665, "10_mmH2O"},
        Case{"x_0Pa.gsf", 0, "0Pa"}}) {
    const FileNameGuess guess = guess_from_file_name(c.name);
    ASSERT_TRUE(guess.pressure) << c.name;
    // Round-off of one product; udunits' mmH2O has 6 digits.
    EXPECT_NEAR(guess.pressure->si(), c.pascals, 1e-5 * std::abs(c.pascals)) << c.name;
    EXPECT_EQ(guess.pressure_text, c.text);
    EXPECT_EQ(guess.list, List::hydrostatic) << c.name;
    EXPECT_FALSE(guess.flow_rate) << c.name;
    EXPECT_FALSE(guess.ambiguous) << c.name;
  }
}

TEST(FileNameGuess, ReadsFlowRates) {
  struct Case {
    const char* name;
    double millilitres_per_minute;
  };
  for (const Case& c :
       {Case{"Q70mlmin_02.gsf", 70}, Case{"flow_70 mL-min.gsf", 70}, Case{"70_ml_min.gsf", 70},
        Case{"Q=0.5ml_per_min.gsf", 0.5}, Case{"S4_500uLmin.gsf", 0.5}, Case{"500µL.gsf", 0.5},
        Case{"500µL-min_1.gsf", 0.5}, Case{"30ul_h.gsf", 5e-4}, Case{"2p5mlps.gsf", 150},
        Case{"5mlpm.gsf", 5}, Case{"5ccm.gsf", 5}, Case{"1L per h.gsf", 1000.0 / 60},
        Case{"Q5ml.gsf", 5}}) {
    const FileNameGuess guess = guess_from_file_name(c.name);
    ASSERT_TRUE(guess.flow_rate) << c.name;
    EXPECT_NEAR(guess.flow_rate->in(mL_per_min), c.millilitres_per_minute,
                1e-14 * c.millilitres_per_minute)
        << c.name;  // round-off
    EXPECT_EQ(guess.list, List::flow) << c.name;
  }
}

TEST(FileNameGuess, AFlowRateOutweighsAPressure) {
  const FileNameGuess guess = guess_from_file_name("Q70mlmin_12kPa.gsf");
  EXPECT_EQ(guess.list, List::flow);
  EXPECT_TRUE(guess.pressure);
}

TEST(FileNameGuess, TakesNoWordForAUnit) {
  for (const char* name : {"100Parallel.gsf", "S1_02.gsf", "3mPa.gsf", "12pages.gsf", "5min.gsf",
                           "12lines.gsf", "kPa.gsf", "5Pa2.gsf", "1_2_3.gsf", "1e999Pa.gsf", ""}) {
    const FileNameGuess guess = guess_from_file_name(name);
    EXPECT_FALSE(guess.pressure) << name;
    EXPECT_FALSE(guess.flow_rate) << name;
  }
}

TEST(FileNameGuess, FallsBackOnTheFirstWord) {
  EXPECT_EQ(guess_from_file_name("h07.gsf").list, List::hydrostatic);
  EXPECT_EQ(guess_from_file_name("Calib_07.gsf").list, List::hydrostatic);
  EXPECT_EQ(guess_from_file_name("f07.gsf").list, List::flow);
  EXPECT_EQ(guess_from_file_name("Q70_02.gsf").list, List::flow);
  EXPECT_EQ(guess_from_file_name("map07.gsf").list, List::unknown);
}

TEST(FileNameGuess, SeesContradictions) {
  EXPECT_TRUE(guess_from_file_name("1kPa_2kPa.gsf").ambiguous);
  EXPECT_TRUE(guess_from_file_name("1mlmin_2mlmin.gsf").ambiguous);
  EXPECT_FALSE(guess_from_file_name("1kPa_1000Pa.gsf").ambiguous);
}

}  // namespace
}  // namespace manoscope::experiment

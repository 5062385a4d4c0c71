#include "manoscope/report/number_text.hpp"

#include <gtest/gtest.h>

#include <limits>

namespace manoscope::report {
namespace {

constexpr double kNan = std::numeric_limits<double>::quiet_NaN();

TEST(NumberText, GivesTheUncertaintyTwoDigitsAndTheValueTheSameDecimal) {
  EXPECT_EQ(number_text_with_uncertainty(14.2349, 0.1163), "14.23 ± 0.12");
  EXPECT_EQ(number_text_with_uncertainty(14.2349, 0.0996), "14.23 ± 0.10");
  EXPECT_EQ(number_text_with_uncertainty(14234.9, 116.3), "14230 ± 120");
  EXPECT_EQ(number_text_with_uncertainty(14234.9, 99.6), "14230 ± 100");
  EXPECT_EQ(number_text_with_uncertainty(-3.14159, 0.025), "−3.142 ± 0.025");
  EXPECT_EQ(number_text_with_uncertainty(1.0, 12.0), "1 ± 12");
  EXPECT_EQ(number_text_with_uncertainty(-0.001, 1.0), "0.0 ± 1.0");
}

TEST(NumberText, ShowsWhatDoesNotExistAsADash) {
  EXPECT_EQ(number_text(kNan, 3), "–");
  EXPECT_EQ(number_text_with_uncertainty(kNan, 0.1), "–");
  EXPECT_EQ(number_text_with_uncertainty(1.23456, kNan), "1.235");
  EXPECT_EQ(number_text_with_uncertainty(1.23456, 0.0), "1.235");
  EXPECT_EQ(percent_text(kNan), "–");
  EXPECT_EQ(fixed_text(kNan, 1), "–");
  EXPECT_EQ(signed_percent_text(kNan), "–");
}

TEST(NumberText, KeepsSignificantDigits) {
  EXPECT_EQ(number_text(1234.56, 3), "1230");
  EXPECT_EQ(number_text(0.0123456, 3), "0.0123");
  EXPECT_EQ(number_text(9.996, 3), "10.0");
  EXPECT_EQ(number_text(-2.5, 2), "−2.5");
  EXPECT_EQ(number_text(0.0, 3), "0");
  EXPECT_EQ(number_text(1.5e9, 2), "1.5e+09");
  EXPECT_EQ(percent_text(0.123), "12 %");
  EXPECT_EQ(percent_text(0.0123), "1.2 %");
  EXPECT_EQ(percent_text(1e-6), "< 0.01 %");
  EXPECT_EQ(percent_text(0.0), "0 %");
  EXPECT_EQ(fixed_text(-417.6, 0), "−418");
  EXPECT_EQ(fixed_text(-0.2, 0), "0");
  EXPECT_EQ(signed_percent_text(0.0021), "+0.2 %");
  EXPECT_EQ(signed_percent_text(-0.0003), "−0.03 %");
  EXPECT_EQ(signed_percent_text(1e-6), "0 %");
}

TEST(NumberText, DropsZerosThatSayNothingWhereNoUncertaintyIsMeant) {
  EXPECT_EQ(short_number_text(70.0), "70");
  EXPECT_EQ(short_number_text(5.5), "5.5");
  EXPECT_EQ(short_number_text(0.12344), "0.1234");
  EXPECT_EQ(short_number_text(49.9905), "49.99");
  EXPECT_EQ(short_number_text(49.9905, 3), "50");
  EXPECT_EQ(short_number_text(12000.0), "12000");
  EXPECT_EQ(short_number_text(-0.5), "−0.5");
  EXPECT_EQ(short_number_text(kNan), "–");
}

TEST(NumberText, ChoosesAUnitThatKeepsNumbersShort) {
  EXPECT_EQ(pressure_unit(50e3).name, "kPa");
  EXPECT_EQ(pressure_unit(800.0).name, "Pa");
  EXPECT_EQ(pressure_unit(kNan).name, "Pa");
  EXPECT_EQ(length_unit(47e-6).name, "µm");
  EXPECT_EQ(length_unit(15.5e-3).name, "mm");
  EXPECT_EQ(flow_rate_unit(70e-6 / 60.0).name, "mL/min");
  EXPECT_EQ(flow_rate_unit(1e-6 / 60.0).name, "mL/min");
  EXPECT_EQ(flow_rate_unit(50e-9 / 60.0).name, "µL/min");
}

}  // namespace
}  // namespace manoscope::report

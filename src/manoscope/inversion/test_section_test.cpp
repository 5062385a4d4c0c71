#include "manoscope/inversion/test_section.hpp"

#include <gtest/gtest.h>

#include <limits>
#include <numbers>

#include "manoscope/core/error.hpp"
#include "manoscope/core/flags.hpp"
#include "tests/support/quiet_traps.hpp"

namespace manoscope::inversion {
namespace {

constexpr Length kLength = 15.5 * mm, kWidth = 1.7 * mm;

/// A reading at every 0.05 mm that has an answer and slope 1 nm/Pa everywhere.
PressureReading plain_reading() {
  PressureReading reading;
  const Index n = 311;
  reading.x = Array1::LinSpaced(n, 0.0, kLength.si());
  reading.pressure = Array1::LinSpaced(n, 9e3, 1e3);
  reading.slope = Array1::Constant(n, 1e-9);
  reading.flags = Flags1::Zero(n);
  return reading;
}

double start_of(const PressureReading& reading, const TestSection& section) {
  return reading.x[section.first];
}
double end_of(const PressureReading& reading, const TestSection& section) {
  return reading.x[section.last];
}

constexpr double kPitch = 0.05e-3;

TEST(TestSection, KeepsClearOfBothClampedEnds) {
  const auto reading = plain_reading();
  for (const double clearance : {0.0, 1.0, 3.0, 5.5}) {
    TestSectionOptions options;
    options.clearance = clearance;
    const auto section = find_test_section(reading, kLength, kWidth, options);
    ASSERT_TRUE(section);
    const double distance = clearance * kWidth.si() / std::numbers::pi;
    EXPECT_GE(start_of(reading, *section), distance - 1e-12);  // round-off of x
    EXPECT_LT(start_of(reading, *section), distance + kPitch);
    EXPECT_LE(end_of(reading, *section), kLength.si() - distance + 1e-12);
    EXPECT_GT(end_of(reading, *section), kLength.si() - distance - kPitch);
  }
}

TEST(TestSection, IsThePapersForItsChannelByDefault) {
  // Fig. 3: x = 1.6 mm to 13 mm of 15.5 mm; three decay lengths of a 1.7 mm channel are 1.62 mm.
  const auto reading = plain_reading();
  const auto section = find_test_section(reading, kLength, kWidth);
  ASSERT_TRUE(section);
  EXPECT_NEAR(start_of(reading, *section), 1.62e-3, kPitch);
}

TEST(TestSection, BeginsAndEndsWhereTheWallIsSensitiveEnough) {
  auto reading = plain_reading();
  for (Index ix = 0; ix < reading.x.size(); ++ix) {
    if (reading.x[ix] < 4e-3) reading.slope[ix] = 0.49e-9;
    if (reading.x[ix] > 12e-3) reading.slope[ix] = 0.51e-9;
  }
  const auto section = find_test_section(reading, kLength, kWidth);
  ASSERT_TRUE(section);
  EXPECT_NEAR(start_of(reading, *section), 4e-3, kPitch);
  EXPECT_GT(end_of(reading, *section), 13e-3);
}

TEST(TestSection, KeepsGapsInsideAndDoesNotEndOnOne) {
  auto reading = plain_reading();
  for (Index ix = 0; ix < reading.x.size(); ++ix) {
    const double x = reading.x[ix];
    if (x < 2e-3) reading.flags[ix] = ReadingFlag::no_data;
    if (x > 6e-3 && x < 8e-3) reading.flags[ix] = ReadingFlag::ambiguous;
    if (x > 12e-3) reading.flags[ix] = ReadingFlag::out_of_calibration;
  }
  const auto section = find_test_section(reading, kLength, kWidth);
  ASSERT_TRUE(section);
  EXPECT_NEAR(start_of(reading, *section), 2e-3, kPitch);
  EXPECT_NEAR(end_of(reading, *section), 12e-3, kPitch);

  flag_outside(reading, section);
  for (Index ix = 0; ix < reading.x.size(); ++ix) {
    const bool outside = (reading.flags[ix] & ReadingFlag::outside_test_section) != 0;
    EXPECT_EQ(outside, ix < section->first || ix > section->last);
  }
  EXPECT_EQ(reading.flags[140], ReadingFlag::ambiguous);  // 7 mm: inside, and still flagged
  EXPECT_TRUE(reading.answered(section->first) && reading.answered(section->last));
}

TEST(TestSection, TakesTheGivenEndsInPlaceOfItsOwn) {
  const auto reading = plain_reading();
  TestSectionOptions options;
  options.start = 0.3 * mm;
  auto section = find_test_section(reading, kLength, kWidth, options);
  ASSERT_TRUE(section);
  EXPECT_NEAR(start_of(reading, *section), 0.3e-3, kPitch);
  EXPECT_NEAR(end_of(reading, *section), 15.5e-3 - 1.62e-3, kPitch);
  options.end = 13.0 * mm;
  section = find_test_section(reading, kLength, kWidth, options);
  ASSERT_TRUE(section);
  EXPECT_NEAR(end_of(reading, *section), 13e-3, kPitch);
}

TEST(TestSection, DoesNotExistWhereNothingQualifies) {
  auto reading = plain_reading();
  TestSectionOptions options;
  options.clearance = 20.0;  // more than half of the channel from each end
  EXPECT_FALSE(find_test_section(reading, kLength, kWidth, options));
  options = {};
  options.start = 14.5 * mm;  // beyond the automatic end
  EXPECT_FALSE(find_test_section(reading, kLength, kWidth, options));
  options.start = 7.0 * mm;
  options.end = 7.01 * mm;  // one station
  EXPECT_FALSE(find_test_section(reading, kLength, kWidth, options));
  reading.flags.setConstant(ReadingFlag::ambiguous);
  EXPECT_FALSE(find_test_section(reading, kLength, kWidth));
  flag_outside(reading, std::nullopt);
  EXPECT_TRUE(
      (reading.flags == (ReadingFlag::ambiguous | ReadingFlag::outside_test_section)).all());
}

TEST(TestSectionOptions, RefuseValuesOutOfRangeByName) {
  const test::QuietTraps quiet;
  const auto where = [](const TestSectionOptions& options) {
    try {
      options.validate();
    } catch (const InputError& error) {
      return error.where();
    }
    return std::string();
  };
  const double nan = std::numeric_limits<double>::quiet_NaN();
  for (const double bad : {-1.0, nan}) {
    TestSectionOptions options;
    options.clearance = bad;
    EXPECT_EQ(where(options), "--clearance");
  }
  for (const double bad : {-0.1, 1.0, nan}) {
    TestSectionOptions options;
    options.least_sensitivity = bad;
    EXPECT_EQ(where(options), "--least-sensitivity");
  }
  TestSectionOptions options;
  options.start = 5.0 * mm;
  options.end = 5.0 * mm;
  EXPECT_EQ(where(options), "--section-end");
  options.end = 5.1 * mm;
  EXPECT_EQ(where(options), "");
}

}  // namespace
}  // namespace manoscope::inversion

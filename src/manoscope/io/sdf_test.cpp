// Surface data files laid out by hand from ISO 25178-71.
#include <gtest/gtest.h>

#include <cmath>

#include "manoscope/io/reader.hpp"
#include "manoscope/io/test_files.hpp"
#include "manoscope/io/test_sdf.hpp"

namespace manoscope::io {
namespace {

using testing::binary_sdf;
using testing::contains;
using testing::little;
using testing::refusal;
using testing::TestFolder;
using testing::text_sdf;

TEST(Sdf, ReadsTextProfileByProfile) {
  const TestFolder folder;
  for (const char* version : {"aISO-1.0", "aISO-2.0", "aBCR-1.0"}) {
    const auto path = folder.write("a.sdf", text_sdf(version, "1 2.5 BAD\r\n-4\r\n5 6e0\r\n*\r\n"));
    const Channel channel = read_channels(path).front();
    EXPECT_EQ(channel.unit, "m");
    EXPECT_DOUBLE_EQ(channel.grid.pitch_x.si(), 1.5e-6);
    EXPECT_DOUBLE_EQ(channel.grid.pitch_y.si(), 2e-6);
    EXPECT_DOUBLE_EQ(channel.values(0, 1), 2.5e-9);
    EXPECT_TRUE(std::isnan(channel.values(0, 2)));
    EXPECT_DOUBLE_EQ(channel.values(1, 0), -4e-9);
    EXPECT_DOUBLE_EQ(channel.values(1, 2), 6e-9);
    EXPECT_EQ(channel.settings.front().second, "Maker");
  }
}

TEST(Sdf, ReadsEveryTypeOfBinaryNumber) {
  const TestFolder folder;
  const auto numbers = [](int bytes, std::uint64_t missing) {
    std::string data;
    for (const int value : {1, 2, 3, 4, 5})
      data += little(static_cast<std::uint64_t>(value), bytes);
    return data + little(missing, bytes);
  };
  std::string floats, doubles;
  for (const int value : {1, 2, 3, 4, 5}) {
    floats += little(static_cast<float>(value));
    doubles += little(static_cast<double>(value));
  }
  floats += little(0xff7fffffU, 4);             // -FLT_MAX
  doubles += little(0xffefffffffffffffULL, 8);  // -DBL_MAX
  struct Case {
    int type;
    std::string data;
    bool last_missing;
  };
  for (const Case& test : {Case{0, numbers(1, 255), false}, Case{1, numbers(2, 0xffff), true},
                           Case{2, numbers(4, 0xffffffff), true}, Case{3, floats, true},
                           Case{4, numbers(1, 0x80), true}, Case{5, numbers(2, 0x8000), true},
                           Case{6, numbers(4, 0x80000000), true}, Case{7, doubles, true}}) {
    for (const char* version : {"bISO-1.0", "bISO-2.0"}) {
      const Channel channel =
          read_channels(folder.write("a.sdf", binary_sdf(version, test.type, test.data))).front();
      ASSERT_EQ(channel.grid.nx, 3) << test.type;
      for (Index i = 0; i < 5; ++i) {
        EXPECT_DOUBLE_EQ(channel.values.data()[i], 1e-9 * static_cast<double>(i + 1)) << test.type;
      }
      EXPECT_EQ(std::isnan(channel.values(1, 2)), test.last_missing) << test.type;
    }
  }
}

TEST(Sdf, TwoNumbersOfOlympusBeforeTheHeightsArePassedOver) {
  const TestFolder folder;
  std::string data = little(5, 4) + little(1, 4);
  for (int i = 1; i <= 6; ++i) data += little(static_cast<std::uint64_t>(i), 2);
  const Channel channel =
      read_channels(folder.write("a.sdf", binary_sdf("bISO-1.0", 5, data))).front();
  EXPECT_DOUBLE_EQ(channel.values(0, 0), 1e-9);
}

TEST(Sdf, WhatDoesNotFitIsRefused) {
  const TestFolder folder;
  const auto fault = [&](const std::string& bytes) { return refusal(folder, "a.sdf", bytes); };
  EXPECT_TRUE(contains(fault(text_sdf("aISO-1.0", "1 2 3 4 5\n*")), "has 5 heights where 3 x 2"));
  EXPECT_TRUE(contains(fault(text_sdf("aISO-1.0", "1 2 3 4 5 x\n*")), "height 6 is \"x\""));
  EXPECT_TRUE(contains(fault(text_sdf("aISO-1.0", "1")), "announces 3 x 2 points, but"));
  EXPECT_TRUE(contains(fault("aISO-1.0\nNumPoints = 3\n"), "no * ends its header"));
  EXPECT_TRUE(contains(fault("aISO-1.0\nNumPoints = 3\n*\n1 2 3"), "has no NumProfiles"));
  EXPECT_TRUE(contains(fault(binary_sdf("bISO-1.0", 8, "")), "DataType is 8"));
  EXPECT_TRUE(contains(fault(binary_sdf("bISO-1.0", 5, "12345678901")), "heights"));
  EXPECT_TRUE(contains(fault(binary_sdf("bISO-1.0", 5, "123456789012", 1)), "compression 1"));
}

}  // namespace
}  // namespace manoscope::io

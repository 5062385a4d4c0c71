#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>

#include "manoscope/io/formats.hpp"
#include "manoscope/io/test_files.hpp"
#include "manoscope/io/test_instrument_files.hpp"

namespace manoscope::io {
namespace {

using testing::contains;
using testing::refusal;
using testing::TestFolder;
using testing::WykoOpd;

TEST(WykoOpd, ReadsColumnsFromBelowScaledByWavelengthAndMult) {
  const TestFolder folder;
  const auto channels = read_channels(folder.write("a.opd", WykoOpd().bytes()));
  ASSERT_EQ(channels.size(), 2U);
  const Channel& height = channels.front();
  EXPECT_EQ(height.name, "RAW_DATA");
  EXPECT_EQ(height.unit, "m");
  ASSERT_EQ(height.grid.nx, 3);
  ASSERT_EQ(height.grid.ny, 2);
  // Elements 0 ... 5 run up the columns; 80 nm / 16 each.
  Array2 expected(2, 3);
  expected << 1, 3, 5, 0, 2, 4;
  for (Index i = 0; i < 6; ++i) {
    EXPECT_DOUBLE_EQ(height.values.data()[i], 5e-9 * expected.data()[i]);
  }
  EXPECT_EQ(channels[1].name, "Image");
  EXPECT_EQ(channels[1].unit, "1");
  EXPECT_EQ(channels[1].values(0, 2), 15.0);
}

TEST(WykoOpd, PixelsAreAsTallAsTheAspectSays) {
  const TestFolder folder;
  const auto channels = read_channels(folder.write("a.opd", WykoOpd().bytes()));
  EXPECT_DOUBLE_EQ(channels[0].grid.pitch_x.si(), static_cast<double>(0.0016F) * 1e-3);
  EXPECT_DOUBLE_EQ(channels[0].grid.pitch_y.si(), channels[0].grid.pitch_x.si() * 1.25);
}

TEST(WykoOpd, BadElementsOfEachTypeAreMissing) {
  const TestFolder folder;
  WykoOpd file;
  file.elements = {0, 32766, 32765, 32767, -32768, 5};
  const bool missing[6] = {true, true, false, false, false, false};  // the top row first
  const auto of_i16 = read_channels(folder.write("a.opd", file.bytes()));
  for (Index i = 0; i < 6; ++i) {
    EXPECT_EQ(std::isnan(of_i16[0].values.data()[i]), missing[i]) << i;
  }
  file.element_bytes = 4;
  file.bad_float = true;  // the last element
  const auto of_f32 = read_channels(folder.write("a.opd", file.bytes()));
  EXPECT_TRUE(std::isnan(of_f32[0].values(0, 2)));
  EXPECT_FALSE(std::isnan(of_f32[0].values(1, 1)));
}

TEST(WykoOpd, HeightsOfOneByteAreUnsignedAndNoneIsMissing) {
  const TestFolder folder;
  WykoOpd file;
  file.element_bytes = 1;
  file.elements = {0, 1, 127, 128, 254, 255};
  const auto channels = read_channels(folder.write("a.opd", file.bytes()));
  Array2 expected(2, 3);
  expected << 1, 128, 255, 0, 127, 254;  // up the columns; 80 nm / 16 each
  for (Index i = 0; i < 6; ++i) {
    EXPECT_DOUBLE_EQ(channels[0].values.data()[i], 5e-9 * expected.data()[i]);
  }
}

TEST(WykoOpd, KeepsTheInstrumentsSettings) {
  const TestFolder folder;
  const auto channels = read_channels(folder.write("a.opd", WykoOpd().bytes()));
  const std::pair<std::string, std::string> mode{"MeasMode", "VSI"}, mult{"Mult", "16"};
  const auto& settings = channels[0].settings;
  EXPECT_NE(std::find(settings.begin(), settings.end(), mode), settings.end());
  EXPECT_NE(std::find(settings.begin(), settings.end(), mult), settings.end());
}

TEST(WykoOpd, FaultyFilesAreNamed) {
  const TestFolder folder;
  const auto fault = [&](auto&& spoil) {
    WykoOpd file;
    spoil(file);
    return refusal(folder, "a.opd", file.bytes());
  };
  EXPECT_TRUE(contains(fault([](WykoOpd& file) { file.mult = 0; }), "its Mult is 0"));
  EXPECT_TRUE(contains(fault([](WykoOpd& file) { file.pixel_size_name = "Pixels"; }),
                       "has no number named Pixel_size"));
  EXPECT_TRUE(
      contains(fault([](WykoOpd& file) { file.nx = 30; }), "30 x 2 elements of 2 bytes need 126"));
  const std::string whole = WykoOpd().bytes();
  EXPECT_TRUE(contains(refusal(folder, "a.opd", whole.substr(0, whole.size() - 1)),
                       "but the file ends at byte"));
}

}  // namespace
}  // namespace manoscope::io

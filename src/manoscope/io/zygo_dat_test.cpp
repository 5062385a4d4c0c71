#include <gtest/gtest.h>

#include <cmath>

#include "manoscope/io/formats.hpp"
#include "manoscope/io/test_files.hpp"
#include "manoscope/io/test_instrument_files.hpp"

namespace manoscope::io {
namespace {

using testing::complaint;
using testing::contains;
using testing::refusal;
using testing::TestFolder;
using testing::ZygoDat;

TEST(ZygoDat, ReadsHeightsByTheFormulaOfTheReferenceGuide) {
  const TestFolder folder;
  ZygoDat file;
  file.scale_factor = 0.5F;
  file.obliquity = 1.25F;
  file.wavelength = 600e-9F;
  for (const auto& [resolution, counts] :
       {std::pair{0, 4096.0}, std::pair{1, 32768.0}, std::pair{2, 131072.0}}) {
    file.phase_resolution = resolution;
    for (const int sign : {0, 1}) {
      file.sign = sign;
      const auto channels = read_channels(folder.write("a.dat", file.bytes()));
      ASSERT_EQ(channels.size(), 2U);
      const Channel& height = channels.front();
      EXPECT_EQ(height.unit, "m");
      const double scale =
          (sign == 0 ? 1.0 : -1.0) * 0.5 * 1.25 * static_cast<double>(600e-9F) / counts;
      for (Index i = 0; i < 6; ++i) {
        // One multiplication more or less: a few units of round-off.
        EXPECT_NEAR(height.values(i / 3, i % 3), scale * (1000.0 * static_cast<double>(i) - 2000.0),
                    1e-15 * std::abs(scale) * 3000.0);
      }
    }
  }
}

TEST(ZygoDat, KeepsTheWindowsPlaceInTheCameraFrame) {
  const TestFolder folder;
  const auto channels = read_channels(folder.write("a.dat", ZygoDat().bytes()));
  EXPECT_EQ(channels[0].offset_x, 139);
  EXPECT_EQ(channels[0].offset_y, 38);
  EXPECT_DOUBLE_EQ(channels[0].grid.pitch_x.in(um), static_cast<double>(1.5e-6F) * 1e6);
  EXPECT_EQ(channels[0].grid.pitch_x, channels[0].grid.pitch_y);
  EXPECT_EQ(channels[1].name, "intensity");
  EXPECT_EQ(channels[1].unit, "1");
  EXPECT_EQ(channels[1].offset_x, 0);
  EXPECT_EQ(channels[1].grid.nx, 4);
  EXPECT_EQ(channels[1].values(1, 3), 107.0);
}

TEST(ZygoDat, MarkedPhasesAndIntensitiesAreMissing) {
  const TestFolder folder;
  ZygoDat file;
  file.phases = {0, 2147483639, 2147483640, 2147483647, -2147483647, 5};
  file.intensities[0] = 65412;
  file.intensities[1] = 65411;
  const auto channels = read_channels(folder.write("a.dat", file.bytes()));
  const bool missing[6] = {false, false, true, true, false, false};
  for (Index i = 0; i < 6; ++i) {
    EXPECT_EQ(std::isnan(channels[0].values.data()[i]), missing[i]) << i;
  }
  EXPECT_TRUE(std::isnan(channels[1].values(0, 0)));
  EXPECT_EQ(channels[1].values(0, 1), 65411.0);
}

TEST(ZygoDat, TheLongHeaderOfFormat3IsSkippedWhole) {
  const TestFolder folder;
  ZygoDat file;
  file.magic = 0x881b0371;
  file.header_size = 4096;
  const auto channels = read_channels(folder.write("a.dat", file.bytes()));
  EXPECT_EQ(channels[1].values(1, 3), 107.0);
}

TEST(ZygoDat, WithoutAnIntensityImageOrAScaleItIsStillAMap) {
  const TestFolder folder;
  ZygoDat file;
  file.n_buckets = 0;
  file.lateral_resolution = 0.0F;
  const auto path = folder.write("a.dat", file.bytes());
  EXPECT_EQ(read_channels(path).size(), 1U);
  EXPECT_TRUE(
      contains(complaint([&] { read_height_map(path); }), "has no lateral scale | Add the size"));
}

TEST(ZygoDat, FaultyHeadersAreNamed) {
  const TestFolder folder;
  const auto fault = [&](auto&& spoil) {
    ZygoDat file;
    spoil(file);
    return refusal(folder, "a.dat", file.bytes());
  };
  EXPECT_TRUE(contains(fault([](ZygoDat& file) { file.phase_resolution = 3; }),
                       "phase resolution is 3; known are 0, 1 and 2"));
  EXPECT_TRUE(
      contains(fault([](ZygoDat& file) { file.header_size = 100; }), "header of 100 bytes"));
  EXPECT_TRUE(contains(fault([](ZygoDat& file) { file.extra_intensity_bytes = 2; }),
                       "announces 18 bytes of intensities, but 1 images of 4 x 2 pixels take 16"));
  EXPECT_TRUE(contains(fault([](ZygoDat& file) { file.phases.pop_back(); }), "phases"));
  EXPECT_TRUE(contains(fault([](ZygoDat& file) { file.lateral_resolution = -1.0F; }),
                       "gives a pixel of -1 m"));
  EXPECT_TRUE(contains(fault([](ZygoDat& file) { file.wavelength = std::nanf(""); }),
                       "not a finite number"));
}

}  // namespace
}  // namespace manoscope::io

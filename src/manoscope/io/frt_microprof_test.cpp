#include <gtest/gtest.h>

#include <cmath>

#include "manoscope/io/formats.hpp"
#include "manoscope/io/test_confocal_files.hpp"
#include "manoscope/io/test_files.hpp"

namespace manoscope::io {
namespace {

using testing::contains;
using testing::FrtMicroprof;
using testing::refusal;
using testing::TestFolder;

TEST(FrtMicroprof, ReadsBothVersionsFromTheBottomRow) {
  const TestFolder folder;
  for (const std::string version : {"1.00", "1.01"}) {
    for (const int bits : {16, 32}) {
      FrtMicroprof file;
      file.version = version;
      file.bits = bits;
      const auto channels = read_channels(folder.write("a.frt", file.bytes()));
      ASSERT_EQ(channels.size(), 2U);
      const Channel& height = channels.front();
      EXPECT_DOUBLE_EQ(height.grid.pitch_x.si(), 2e-3);
      EXPECT_DOUBLE_EQ(height.grid.pitch_y.si(), 4e-3);
      EXPECT_DOUBLE_EQ(height.values(0, 0), 100e-8);
      EXPECT_DOUBLE_EQ(height.values(1, 2), 5e-8);
      EXPECT_EQ(channels[1].name, "intensity");
      EXPECT_EQ(channels[1].values(0, 1), 100.0);
    }
  }
}

TEST(FrtMicroprof, NumbersOutsideTheValidOnesAreMissing) {
  const TestFolder folder;
  FrtMicroprof file;
  const auto bounded = read_channels(folder.write("a.frt", file.bytes()));
  EXPECT_TRUE(std::isnan(bounded[0].values(1, 0)));  // 0, never measured
  EXPECT_TRUE(std::isnan(bounded[0].values(1, 1)));  // 1, the mark
  EXPECT_TRUE(std::isnan(bounded[0].values(0, 2)));  // 65530, beyond the last
  EXPECT_EQ(bounded[0].values.isNaN().count(), 3);
  file.with_valid_range = false;
  const auto unbounded = read_channels(folder.write("a.frt", file.bytes()));
  EXPECT_EQ(unbounded[0].values.isNaN().count(), 1);
}

TEST(FrtMicroprof, FaultyFilesAreNamed) {
  const TestFolder folder;
  const auto fault = [&](auto&& spoil) {
    FrtMicroprof file;
    spoil(file);
    return refusal(folder, "a.frt", file.bytes());
  };
  EXPECT_TRUE(contains(fault([](FrtMicroprof& f) { f.bits = 8; }), "pixels of 8 bits"));
  EXPECT_TRUE(contains(fault([](FrtMicroprof& f) { f.version = "2.00"; }), "version"));
  EXPECT_TRUE(contains(fault([](FrtMicroprof& f) { f.numbers.pop_back(); }), "no block 0x0b"));
}

TEST(FrtMicroprof, WhatARealScanNeverMeasuredIsNoHeight) {
  const auto path = testing::shared_data("maps/st_frt-1.frt");
  if (path.empty()) GTEST_SKIP() << "no real instrument files here";
  const Channel height = read_channels(path).front();
  // Two other readers take the 500 zeros of the row where the scan was broken off for heights.
  double sum = 0.0, n = 500.0;
  for (Index i = 0; i < height.values.size(); ++i) {
    if (std::isnan(height.values.data()[i])) continue;
    sum += height.values.data()[i];
    n += 1.0;
  }
  const auto squares_about = [&](double mean) {
    double squares = 500.0 * mean * mean;
    for (Index i = 0; i < height.values.size(); ++i) {
      const double deviation = height.values.data()[i] - mean;
      if (!std::isnan(deviation)) squares += deviation * deviation;
    }
    return squares;
  };
  // Gwyddion prints 4.92e-6 m.
  EXPECT_NEAR(std::sqrt(squares_about(sum / n) / n), 4.92e-6, 5e-9);
  // SurfaceTopography asserts 2.047476e-5 m: mean and rms divided by all pixels, missing or not.
  const auto n_all = static_cast<double>(height.values.size());
  EXPECT_NEAR(std::sqrt(squares_about(sum / n_all) / n_all), 2.047476e-5, 5e-12);
  EXPECT_TRUE(height.values.row(0).isNaN().all());
}

}  // namespace
}  // namespace manoscope::io

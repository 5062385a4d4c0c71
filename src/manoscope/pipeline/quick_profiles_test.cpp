#include "manoscope/pipeline/quick_profiles.hpp"

#include <gtest/gtest.h>

#include <cstring>
#include <fstream>
#include <limits>

#include "manoscope/core/error.hpp"
#include "manoscope/io/reader.hpp"
#include "manoscope/io/writer.hpp"
#include "manoscope/maps/reduce.hpp"
#include "tests/support/synthetic_map.hpp"

namespace manoscope::pipeline {
namespace {

using test_support::Bulge;
using test_support::frame_at;
using test_support::MapErrors;

/// Five maps of a rising wall in a folder of their own.
class QuickProfiles : public ::testing::Test {
 protected:
  QuickProfiles() {
    std::string name = (std::filesystem::temp_directory_path() / "manoscope-quick-XXXXXX").string();
    if (::mkdtemp(name.data()) == nullptr) throw std::runtime_error("no temporary folder");
    folder = name;
  }
  ~QuickProfiles() override { std::filesystem::remove_all(folder); }

  static constexpr int kMaps = 5;

  std::vector<std::filesystem::path> write(const std::string& extension,
                                           const ChannelFrame& frame) const {
    std::vector<std::filesystem::path> files;
    for (int i = 0; i < kMaps; ++i) {
      RandomStream stream(8, "quick", static_cast<std::uint64_t>(i));
      MapErrors errors;
      errors.noise = 20e-9;
      errors.tilt_columns = 1e-4;
      errors.dropouts = share_missing;
      const Bulge wall{15.5e-3, 1.7e-3, 2e-6 * (i + 1), 0.54e-3, 0.6};
      const HeightMap map = test_support::synthetic_map(grid, frame, wall, errors, stream);
      files.push_back(folder / ("map" + std::to_string(i) + extension));
      if (extension == ".f32") {
        std::ofstream file(files.back(), std::ios::binary);
        for (Index k = 0; k < map.height().size(); ++k) {
          const float pixel = map.flags().data()[k] == 0
                                  ? static_cast<float>(map.height().data()[k])
                                  : std::numeric_limits<float>::quiet_NaN();
          file.write(reinterpret_cast<const char*>(&pixel), 4);
        }
      } else {
        io::write_map(files.back(), map, "test");
      }
    }
    return files;
  }
  static ChannelFrame along(FlowDirection flow) {
    return frame_at(15.5 * mm, 1.7 * mm, flow, false, 0.4 * mm, 0.4 * mm);
  }

  std::filesystem::path folder;
  double share_missing = 0.01;
  CameraGrid grid{512, 96, 16.3 * mm / 512.0, 2.5 * mm / 96.0};
};

void expect_same_bytes(const std::vector<maps::LinearReduction>& a,
                       const std::vector<maps::LinearReduction>& b) {
  ASSERT_EQ(a.size(), b.size());
  for (std::size_t i = 0; i < a.size(); ++i) {
    const Array1 &one = a[i].profile.zeta, &other = b[i].profile.zeta;
    ASSERT_EQ(one.size(), other.size());
    EXPECT_EQ(std::memcmp(one.data(), other.data(), 8 * one.size()), 0) << i;
    const Array1 sigma = a[i].profile.uncertainty.standard();
    EXPECT_EQ(std::memcmp(sigma.data(), b[i].profile.uncertainty.standard().eval().data(),
                          8 * sigma.size()),
              0);
  }
}

TEST_F(QuickProfiles, HaveTheSameBytesOnAnyNumberOfThreads) {
  const ChannelFrame frame = along(FlowDirection::plus_columns);
  for (const double dropouts : {0.0, 0.01}) {
    share_missing = dropouts;
    const auto gsf = write(".gsf", frame), raw = write(".f32", frame);
    QuickProfilesOptions as_floats;
    as_floats.raw = io::RawFloats{io::read_height_map(gsf.front()).grid(), 1.0};
    const auto one = quick_profiles(gsf, frame, {}, 1);
    for (const int n_threads : {1, 2, 0}) {
      expect_same_bytes(one, quick_profiles(gsf, frame, {}, n_threads));
      expect_same_bytes(one, quick_profiles(raw, frame, as_floats, n_threads));
    }
  }
}

TEST_F(QuickProfiles, NameTheFirstMapAtFaultOnAnyNumberOfThreads) {
  const ChannelFrame frame = along(FlowDirection::plus_columns);
  const auto files = write(".gsf", frame);
  for (const int at : {2, 3, 4}) std::filesystem::resize_file(files[at], 1000);
  for (const int n_threads : {1, 2}) {
    try {
      quick_profiles(files, frame, {}, n_threads);
      FAIL() << "three maps are cut short";
    } catch (const InputError& error) {
      EXPECT_EQ(error.where(), files[2].string()) << n_threads;
    }
  }
}

TEST_F(QuickProfiles, OfRawFloatsAreThoseOfTheSameMapsInAFormat) {
  const ChannelFrame frame = along(FlowDirection::minus_columns);
  const auto in_format = quick_profiles(write(".gsf", frame), frame);
  QuickProfilesOptions options;
  options.raw = io::RawFloats{io::read_height_map(folder / "map0.gsf").grid(), 1.0};
  const auto raw = quick_profiles(write(".f32", frame), frame, options);
  ASSERT_EQ(raw.size(), in_format.size());
  for (std::size_t i = 0; i < raw.size(); ++i) {
    EXPECT_TRUE((raw[i].profile.zeta == in_format[i].profile.zeta).all());
  }
}

TEST_F(QuickProfiles, AgreeWithTheFullReductionWhereTheMapMustBeTurnedFirst) {
  CameraGrid upright{96, 512, 2.5 * mm / 96.0, 16.3 * mm / 512.0};
  std::swap(grid, upright);
  for (const FlowDirection flow : {FlowDirection::plus_rows, FlowDirection::minus_rows}) {
    const ChannelFrame frame = along(flow);
    const auto files = write(".gsf", frame);
    const auto quick = quick_profiles(files, frame);
    for (std::size_t i = 0; i < files.size(); ++i) {
      const auto full = maps::reduce_map(io::read_height_map(files[i]), frame, {}, "map").profile;
      const Array1 sigma = full.uncertainty.standard();
      EXPECT_LT((quick[i].profile.x - full.x).abs().maxCoeff(), 1e-12);
      EXPECT_LT(((quick[i].profile.zeta - full.zeta) / sigma).abs().maxCoeff(), 1.0);
    }
  }
}

TEST_F(QuickProfiles, AreThoseOfStreamedMapsWhereAFormatIsReadAsAWhole) {
  const ChannelFrame frame = along(FlowDirection::plus_columns);
  const auto streamed = quick_profiles(write(".gsf", frame), frame);
  const auto whole = quick_profiles(write(".nc", frame), frame);
  for (std::size_t i = 0; i < whole.size(); ++i) {
    // The same floats; stations from positions computed in another order.
    EXPECT_LT((whole[i].profile.zeta - streamed[i].profile.zeta).abs().maxCoeff(), 1e-16);
  }
}

TEST_F(QuickProfiles, NameTheMapOfAnotherCamera) {
  const ChannelFrame frame = along(FlowDirection::plus_columns);
  auto files = write(".gsf", frame);
  const HeightMap small({256, 96, 16.3 * mm / 256.0, 2.5 * mm / 96.0}, Array2::Zero(96, 256));
  io::write_map(files[3], small, "small");
  try {
    quick_profiles(files, frame, {}, 2);
    FAIL() << "maps of two cameras have no common stations";
  } catch (const InputError& error) {
    EXPECT_EQ(error.where(), files[3].string());
  }
  EXPECT_TRUE(quick_profiles({}, frame).empty());
}

}  // namespace
}  // namespace manoscope::pipeline

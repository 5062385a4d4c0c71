#include "manoscope/maps/linear_reduction.hpp"

#include <gtest/gtest.h>

#include <Eigen/LU>
#include <cmath>
#include <cstring>
#include <limits>

#include "manoscope/core/error.hpp"
#include "manoscope/core/flags.hpp"
#include "manoscope/maps/channel_map.hpp"
#include "manoscope/maps/reduce.hpp"
#include "tests/support/synthetic_map.hpp"

namespace manoscope::maps {
namespace {

using numerics::Instructions;
using test_support::Bulge;
using test_support::frame_at;
using test_support::MapErrors;
using test_support::Pulls;

constexpr double kNoise = 20e-9;
const Bulge kBulge{15.5e-3, 1.7e-3, 20e-6, 0.54e-3, 0.6};

ChannelFrame frame_along(FlowDirection flow, bool across_reversed, Outward outward) {
  ChannelFrame frame = frame_at(15.5 * mm, 1.7 * mm, flow, across_reversed, 0.4 * mm, 0.4 * mm);
  frame.outward = outward;
  return frame;
}
ChannelFrame plain_frame() {
  return frame_along(FlowDirection::plus_columns, false, Outward::plus_height);
}

/// 16.3 x 2.5 mm; the rows are no multiple of the lanes.
CameraGrid camera() { return {515, 97, 16.3 * mm / 515.0, 2.5 * mm / 97.0}; }

MapErrors tilted(double noise, double dropouts) {
  MapErrors errors;
  errors.noise = noise;
  errors.tilt_columns = 1.3e-4;
  errors.tilt_rows = -2e-4;
  errors.piston = 3e-6;
  errors.dropouts = dropouts;
  return errors;
}

/// The pixels as a file of 32-bit floats holds them, in micrometres.
std::vector<float> floats(const HeightMap& map) {
  std::vector<float> pixels(static_cast<std::size_t>(map.height().size()));
  for (std::size_t i = 0; i < pixels.size(); ++i) {
    pixels[i] = map.flags().data()[i] == 0 ? static_cast<float>(1e6 * map.height().data()[i])
                                           : std::numeric_limits<float>::quiet_NaN();
  }
  return pixels;
}

/// The map that those floats describe.
HeightMap rounded(const HeightMap& map) {
  const std::vector<float> pixels = floats(map);
  Array2 height(map.grid().ny, map.grid().nx);
  for (Index i = 0; i < height.size(); ++i) {
    const float pixel = pixels[static_cast<std::size_t>(i)];
    height.data()[i] = std::isnan(pixel) ? std::numeric_limits<double>::quiet_NaN() : 1e-6 * pixel;
  }
  return HeightMap(map.grid(), height);
}

std::span<const char> bytes(const std::vector<float>& pixels, Index nx, Index first, Index n) {
  return {reinterpret_cast<const char*>(pixels.data() + first * nx),
          static_cast<std::size_t>(4 * n * nx)};
}

LinearReduction reduced(const HeightMap& map, const ChannelFrame& frame,
                        const LinearReductionOptions& options = {}) {
  const LinearReducer reducer(map.grid(), frame, "map", options);
  LinearPass pass(reducer);
  pass.add_rows(bytes(floats(map), map.grid().nx, 0, map.grid().ny));
  return pass.finish(1e-6, "map");
}

/// The same by the modules of the full reduction, on the plane that the pass found.
Profile stepwise(const HeightMap& map, const ChannelFrame& frame, const RimPlane& plane) {
  ChannelMap work = to_channel_frame(rounded(map), frame);
  subtract_plane(work, plane);
  const DeflectionMap deflection(work.grid, work.height, work.flags, plane.sigma);
  return width_average(deflection, plane, frame.length, frame.width, "map");
}

void expect_same(const Profile& found, const Profile& expected) {
  ASSERT_EQ(found.x.size(), expected.x.size());
  // Sums of 100 heights of 20 um in another order.
  EXPECT_LT((found.x - expected.x).abs().maxCoeff(), 1e-15);
  EXPECT_LT((found.zeta - expected.zeta).abs().maxCoeff(), 1e-17);
  EXPECT_TRUE((found.flags == expected.flags).all());
  EXPECT_LT((found.uncertainty.independent - expected.uncertainty.independent).abs().maxCoeff(),
            1e-10 * expected.uncertainty.independent.maxCoeff());
  ASSERT_EQ(found.uncertainty.modes.size(), expected.uncertainty.modes.size());
  for (std::size_t k = 0; k < found.uncertainty.modes.size(); ++k) {
    const ErrorMode &mode = found.uncertainty.modes[k], &same = expected.uncertainty.modes[k];
    EXPECT_EQ(mode.variable, same.variable);
    EXPECT_LT((mode.effect - same.effect).abs().maxCoeff(),
              1e-10 * expected.uncertainty.independent.maxCoeff());
  }
}

TEST(LinearReduction, FindsAnExactPlaneUnderAFlatWall) {
  RandomStream stream(1, "plane");
  const auto flat = [](double, double) { return 0.0; };
  const HeightMap map =
      test_support::synthetic_map(camera(), plain_frame(), flat, tilted(0.0, 0.0), stream);
  const LinearReduction result = reduced(map, plain_frame());
  EXPECT_EQ(result.plane.n_samples,
            rim_mask(channel_grid(camera(), plain_frame()), 15.5 * mm, 1.7 * mm,
                     auto_rim_margin(channel_grid(camera(), plain_frame()), plain_frame()))
                .cast<Index>()
                .sum());
  // The floats of 6 um are rounded by up to 2.4e-13 m; 15 000 of them average that out.
  EXPECT_NEAR(result.plane.tilt_x, 1.3e-4, 1e-11);
  EXPECT_NEAR(result.plane.tilt_z, -2e-4, 1e-10);
  EXPECT_LT(result.profile.zeta.abs().maxCoeff(), 2.4e-13);
  EXPECT_LT(result.plane.sigma.si(), 2.4e-13);
}

TEST(LinearReduction, IsTheWidthAverageInEveryOrientation) {
  for (const FlowDirection flow : {FlowDirection::plus_columns, FlowDirection::minus_columns}) {
    for (const bool across_reversed : {false, true}) {
      for (const Outward outward : {Outward::plus_height, Outward::minus_height}) {
        for (const double dropouts : {0.0, 0.01, 0.15, 0.6}) {
          RandomStream stream(2, "orientation");
          const ChannelFrame frame = frame_along(flow, across_reversed, outward);
          MapErrors errors = tilted(kNoise, dropouts);
          if (dropouts > 0.1) errors.blobs = 4, errors.blob_radius = 80e-6;
          const HeightMap map =
              test_support::synthetic_map(camera(), frame, kBulge, errors, stream);
          const LinearReduction result = reduced(map, frame);
          expect_same(result.profile, stepwise(map, frame, result.plane));
          EXPECT_NEAR(result.missing, dropouts, 0.02 + 0.1 * dropouts);
        }
      }
    }
  }
}

TEST(LinearReduction, FitsThePlaneOfTheGoodPixelsByLeastSquares) {
  RandomStream stream(3, "least squares");
  const HeightMap map =
      test_support::synthetic_map(camera(), plain_frame(), kBulge, tilted(kNoise, 0.1), stream);
  const LinearReduction result = reduced(map, plain_frame());
  // The same by a dense solve over the listed pixels.
  const ChannelMap work = to_channel_frame(rounded(map), plain_frame());
  const Flags2 rim =
      rim_mask(work.grid, 15.5 * mm, 1.7 * mm, auto_rim_margin(work.grid, plain_frame()));
  std::vector<Eigen::Vector3d> rows;
  std::vector<double> heights;
  for (Index iz = 0; iz < work.grid.nz; ++iz) {
    for (Index ix = 0; ix < work.grid.nx; ++ix) {
      if (rim(iz, ix) == 0 || work.flags(iz, ix) != 0) continue;
      rows.emplace_back(1.0, work.grid.x(ix) - result.plane.x_centre, work.grid.z(iz));
      heights.push_back(work.height(iz, ix));
    }
  }
  const auto n = static_cast<Index>(rows.size());
  Eigen::Matrix<double, Eigen::Dynamic, 3> design(n, 3);
  Eigen::VectorXd right(n);
  for (Index i = 0; i < n; ++i) {
    design.row(i) = rows[static_cast<std::size_t>(i)];
    right[i] = heights[static_cast<std::size_t>(i)];
  }
  const Eigen::Matrix3d normal = design.transpose() * design;
  const Eigen::Vector3d c = normal.inverse() * (design.transpose() * right);
  const double sigma =
      std::sqrt((right - design * c).squaredNorm() / (static_cast<double>(n) - 3.0));
  EXPECT_EQ(result.plane.n_samples, n);
  EXPECT_NEAR(result.plane.offset, c[0], 1e-16);  // round-off of 5 um
  EXPECT_NEAR(result.plane.tilt_x, c[1], 1e-14);
  EXPECT_NEAR(result.plane.tilt_z, c[2], 1e-13);
  EXPECT_NEAR(result.plane.sigma.si(), sigma, 1e-9 * sigma);
  const Eigen::Matrix3d covariance = sigma * sigma * normal.inverse();
  EXPECT_LT((result.plane.covariance - covariance).norm(), 1e-8 * covariance.norm());
}

TEST(LinearReduction, AgreesWithTheFullReductionWithinItsUncertainty) {
  Pulls pulls;
  for (std::uint64_t trial = 0; trial < 6; ++trial) {
    RandomStream stream(4, "clean", trial);
    const HeightMap map =
        test_support::synthetic_map(camera(), plain_frame(), kBulge, tilted(kNoise, 0.01), stream);
    const LinearReduction result = reduced(map, plain_frame());
    const ReducedMap full = reduce_map(rounded(map), plain_frame(), {}, "map");
    EXPECT_NEAR(result.plane.sigma / full.condition.noise.sigma, 1.0, 0.05);
    const Array1 sigma = result.profile.uncertainty.standard();
    // Robust and least-squares planes differ by less than either's own uncertainty, of which the
    // stations' own noise is the larger part.
    EXPECT_LT(((result.profile.zeta - full.profile.zeta) / sigma).abs().maxCoeff(), 1.0);
    for (Index i = 0; i < sigma.size(); ++i) {
      const double x = result.profile.x[i];
      if (x < 3e-3 || x > 12.5e-3) continue;
      pulls.add((result.profile.zeta[i] - kBulge.width_average(x)) / sigma[i]);
    }
  }
  // 1800 stations of 6 maps share the errors of 6 planes.
  EXPECT_NEAR(pulls.width(), 1.0, 0.15);
}

void expect_same_bytes(const LinearReduction& one, const LinearReduction& other) {
  const auto expect_bytes = [](const Array1& a, const Array1& b) {
    ASSERT_EQ(a.size(), b.size());
    EXPECT_EQ(std::memcmp(a.data(), b.data(), 8 * a.size()), 0);
  };
  expect_bytes(one.profile.zeta, other.profile.zeta);
  expect_bytes(one.profile.uncertainty.independent, other.profile.uncertainty.independent);
  expect_bytes(one.profile.uncertainty.standard(), other.profile.uncertainty.standard());
  EXPECT_TRUE((one.profile.flags == other.profile.flags).all());
  EXPECT_EQ(one.plane.sigma, other.plane.sigma);
  EXPECT_EQ(one.missing, other.missing);
}

TEST(LinearReduction, HasTheSameBytesHoweverItIsDone) {
  for (const double dropouts : {0.0, 0.01, 0.03, 0.3}) {
    RandomStream stream(5, "bytes");
    MapErrors errors = tilted(kNoise, dropouts);
    if (dropouts > 0.0) errors.blobs = 3, errors.blob_radius = 40e-6;
    const HeightMap map =
        test_support::synthetic_map(camera(), plain_frame(), kBulge, errors, stream);
    const std::vector<float> pixels = floats(map);
    const LinearReducer reducer(camera(), plain_frame(), "map");
    const LinearReduction first = reduced(map, plain_frame());
    for (const Instructions instructions :
         {Instructions::baseline, Instructions::avx2, Instructions::avx512}) {
      if (instructions > numerics::best_instructions()) continue;
      LinearPass pass(reducer, instructions);
      for (const Index step : {1, 2, 5, 7, 8, 11, 96, 97}) {  // the pass starts anew each time
        for (Index row = 0; row < camera().ny; row += step) {
          pass.add_rows(bytes(pixels, camera().nx, row, std::min(step, camera().ny - row)));
        }
        expect_same_bytes(first, pass.finish(1e-6, "map"));
      }
    }
  }
}

TEST(LinearReduction, BridgesGapsThatShareAPixel) {
  // Every pattern of good and missing in five rows of a column, at the edge and inside.
  const HeightMap whole = [] {
    RandomStream stream(7, "patterns");
    return test_support::synthetic_map(camera(), plain_frame(), kBulge, tilted(kNoise, 0.0),
                                       stream);
  }();
  for (const Index top : {13, 14, 15, 16, 40, 41, 42, 43, 44, 45, 46, 47, 76, 77, 78, 79}) {
    Array2 height = whole.height();
    for (Index ix = 20; ix < 500; ++ix) {
      for (Index r = 0; r < 5; ++r) {
        if (((ix % 32) >> r & 1) != 0) {
          height(top + r, ix) = std::numeric_limits<double>::quiet_NaN();
        }
      }
    }
    const HeightMap map(camera(), height);
    const LinearReduction result = reduced(map, plain_frame());
    expect_same(result.profile, stepwise(map, plain_frame(), result.plane));
  }
}

TEST(LinearReduction, TakesSignallingNanAndInfinitiesForMissing) {
  RandomStream stream(6, "signalling");
  const HeightMap map =
      test_support::synthetic_map(camera(), plain_frame(), kBulge, tilted(kNoise, 0.02), stream);
  std::vector<float> pixels = floats(map);
  Index k = 0;
  for (float& pixel : pixels) {
    if (!std::isnan(pixel)) continue;
    const std::uint32_t patterns[] = {0x7fa00000U, 0xff800000U, 0x7f800000U, 0xffc00001U};
    std::memcpy(&pixel, &patterns[++k % 4], 4);  // signalling NaN, -inf, inf, NaN
  }
  const LinearReducer reducer(camera(), plain_frame(), "map");
  LinearPass pass(reducer);
  pass.add_rows(bytes(pixels, camera().nx, 0, camera().ny));
  const Profile found = pass.finish(1e-6, "map").profile,
                expected = reduced(map, plain_frame()).profile;
  EXPECT_TRUE((found.zeta == expected.zeta).all());
}

TEST(LinearReduction, SaysWhatItCannotDo) {
  const auto complaint = [](const CameraGrid& grid, const ChannelFrame& frame) -> std::string {
    try {
      const LinearReducer reducer(grid, frame, "a.gsf");
    } catch (const InputError& error) {
      return error.what();
    }
    return "";
  };
  EXPECT_EQ(complaint(camera(), plain_frame()), "");
  ChannelFrame frame = plain_frame();
  frame.rotation = 1e-3 * rad;
  EXPECT_NE(complaint(camera(), frame).find("rows of pixels"), std::string::npos);
  EXPECT_FALSE(LinearReducer::reduces(frame));
  frame = plain_frame();
  frame.flow = FlowDirection::plus_rows;
  EXPECT_NE(complaint(camera(), frame).find("rows of pixels"), std::string::npos);
  frame = plain_frame();
  frame.origin_y = -0.2 * mm;
  EXPECT_NE(complaint(camera(), frame).find("both edges"), std::string::npos);
  frame = plain_frame();
  frame.origin_x = 20.0 * mm;
  EXPECT_NE(complaint(camera(), frame).find("columns of the map"), std::string::npos);
}

TEST(LinearReduction, NamesAMapWithoutARim) {
  const std::vector<float> nothing(515 * 97, std::numeric_limits<float>::quiet_NaN());
  const LinearReducer reducer(camera(), plain_frame(), "a.gsf");
  LinearPass pass(reducer);
  pass.add_rows(bytes(nothing, 515, 0, 97));
  try {
    pass.finish(1.0, "b.gsf");
    FAIL() << "a map without a height has no plane";
  } catch (const InputError& error) {
    EXPECT_EQ(error.where(), "b.gsf");
  }
}

}  // namespace
}  // namespace manoscope::maps

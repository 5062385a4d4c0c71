#include "manoscope/maps/level.hpp"

#include <gtest/gtest.h>

#include <cmath>
#include <limits>
#include <string>

#include "manoscope/core/error.hpp"
#include "manoscope/core/flags.hpp"
#include "tests/support/synthetic_map.hpp"

namespace manoscope::maps {
namespace {

using test_support::Bulge;
using test_support::MapErrors;
using test_support::Pulls;

constexpr Length kLength = 4.0 * mm, kWidth = 1.0 * mm;
constexpr double kTiltX = 3e-4, kTiltZ = -7e-4, kPiston = 2e-6;

ChannelFrame plain_frame() {
  return test_support::frame_at(kLength, kWidth, FlowDirection::plus_columns, false, 0.4 * mm,
                                0.4 * mm);
}

/// 96 x 36 pixels of 50 um with a bulge of 20 um in the middle and a tilted frame.
ChannelMap tilted_map(MapErrors errors, std::uint64_t trial) {
  const CameraGrid camera{96, 36, 50.0 * um, 50.0 * um};
  const Bulge bulge{kLength.si(), kWidth.si(), 20e-6, 0.3e-3, 0.2};
  errors.tilt_columns = kTiltX;
  errors.tilt_rows = kTiltZ;
  errors.piston = kPiston;
  RandomStream stream(7, "tilted", trial);
  return to_channel_frame(test_support::synthetic_map(camera, plain_frame(), bulge, errors, stream),
                          plain_frame());
}

Flags2 rim_of(const ChannelMap& map) { return rim_mask(map.grid, kLength, kWidth, 0.1 * mm); }

/// Height of the frame at a channel point: the corner (x = 0, z = -w/2) lies at 0.4, 0.4 mm.
double true_plane(double x, double z) {
  return kPiston + kTiltX * (x + 0.4e-3) + kTiltZ * (z + 0.5e-3 + 0.4e-3);
}

TEST(FitRimPlane, FindsTheTiltOfANoiseFreeMapExactly) {
  ChannelMap map = tilted_map({}, 0);
  const RimPlane plane = fit_rim_plane(map, rim_of(map), "exact");
  EXPECT_NEAR(plane.tilt_x, kTiltX, 1e-14);  // round-off of 2 um over 2 mm
  EXPECT_NEAR(plane.tilt_z, kTiltZ, 1e-14);
  for (const double x : {-0.4e-3, 2e-3, 4.4e-3}) {
    for (const double z : {-0.9e-3, 0.0, 0.9e-3}) {
      EXPECT_NEAR(plane.height(x, z), true_plane(x, z), 1e-17);
    }
  }
  subtract_plane(map, plane);
  const Bulge bulge{kLength.si(), kWidth.si(), 20e-6, 0.3e-3, 0.2};
  for (Index iz = 0; iz < map.grid.nz; ++iz) {
    for (Index ix = 0; ix < map.grid.nx; ++ix) {
      EXPECT_NEAR(map.height(iz, ix), bulge(map.grid.x(ix), map.grid.z(iz)), 1e-16);
    }
  }
}

TEST(FitRimPlane, LevelsAPerfectlyFlatMap) {
  ChannelMap map = tilted_map({}, 0);
  map.height.setConstant(3e-6);
  const RimPlane plane = fit_rim_plane(map, rim_of(map), "flat");
  EXPECT_NEAR(plane.height(1e-3, 0.0), 3e-6, 1e-19);
  map.height.setZero();
  EXPECT_EQ(fit_rim_plane(map, rim_of(map), "zero").height(1e-3, 0.0), 0.0);
}

TEST(FitRimPlane, KeepsItsPlaneUnderSpikesAndDust) {
  MapErrors errors;
  errors.noise = 20e-9;
  ChannelMap clean = tilted_map(errors, 1);
  errors.spikes = 0.02;
  errors.spike_size = 300e-9;
  ChannelMap dirty = tilted_map(errors, 1);
  // Dust: two patches of 8 x 5 pixels, 1 um high, both on the same side of the rim.
  dirty.height.block(1, 20, 5, 8) += 1e-6;
  dirty.height.block(2, 60, 5, 8) += 1e-6;
  const RimPlane a = fit_rim_plane(clean, rim_of(clean), "clean");
  const RimPlane b = fit_rim_plane(dirty, rim_of(dirty), "dirty");
  // 7 % of the rim is off by 15 or 50 sigma: rejected altogether, so each plane stays within 4 of
  // its own standard uncertainties of the truth.
  for (const RimPlane& plane : {a, b}) {
    EXPECT_NEAR(plane.tilt_x, kTiltX, 4.0 * std::sqrt(plane.covariance(1, 1)));
    EXPECT_NEAR(plane.tilt_z, kTiltZ, 4.0 * std::sqrt(plane.covariance(2, 2)));
    EXPECT_NEAR(plane.height(plane.x_centre, 0.0), true_plane(plane.x_centre, 0.0),
                4.0 * std::sqrt(plane.covariance(0, 0)));
  }
  const double n = static_cast<double>(b.n_samples);
  // 2 % spikes and 80 dust pixels; of normal errors 1 in 300 000 lies beyond 4.685 sigma.
  EXPECT_NEAR(1.0 - b.inlier_fraction, 0.02 + 80.0 / n, 4.0 * std::sqrt(0.02 / n));
  EXPECT_GT(a.inlier_fraction, 0.999);
  // Median-based: 7 % of outliers enlarge it by 1.4826 * 0.07/2 / (2 phi(0.674)) = 9 %.
  EXPECT_NEAR(b.sigma.in(nm), 20.0, 0.12 * 20.0);
}

TEST(FitRimPlane, StatesItsCovarianceTruly) {
  constexpr int kTrials = 400;
  MapErrors errors;
  errors.noise = 20e-9;
  errors.spikes = 0.005;
  errors.spike_size = 1e-6;
  errors.dropouts = 0.02;
  Pulls offset, tilt_x, tilt_z, far_corner;
  for (int trial = 0; trial < kTrials; ++trial) {
    const ChannelMap map = tilted_map(errors, static_cast<std::uint64_t>(trial));
    const RimPlane plane = fit_rim_plane(map, rim_of(map), "pulls");
    const Eigen::Matrix3d& c = plane.covariance;
    const double x_centre = plane.x_centre;
    offset.add((plane.offset - true_plane(x_centre, 0.0)) / std::sqrt(c(0, 0)));
    tilt_x.add((plane.tilt_x - kTiltX) / std::sqrt(c(1, 1)));
    tilt_z.add((plane.tilt_z - kTiltZ) / std::sqrt(c(2, 2)));
    const Eigen::Vector3d corner(1.0, 4.4e-3 - x_centre, 0.9e-3);
    far_corner.add((plane.height(4.4e-3, 0.9e-3) - true_plane(4.4e-3, 0.9e-3)) /
                   std::sqrt(corner.dot(c * corner)));
  }
  // Mean 0 within 4/sqrt(n) = 0.2; width within 4/sqrt(2n) = 0.14 of 1, and 2 % for the stated
  // covariance, which is 4 % above the variance that a biweight fit has on normal errors.
  for (const Pulls& pulls : {offset, tilt_x, tilt_z, far_corner}) {
    EXPECT_NEAR(pulls.mean(), 0.0, 4.0 / std::sqrt(kTrials));
    EXPECT_NEAR(pulls.width(), 0.99, 4.0 / std::sqrt(2.0 * kTrials) + 0.02);
  }
}

std::string refusal(const ChannelMap& map, const Flags2& rim) {
  try {
    fit_rim_plane(map, rim, "h03.gsf");
  } catch (const InputError& error) {
    return error.what();
  }
  return "";
}

TEST(FitRimPlane, RefusesAMapWithoutRim) {
  const ChannelMap map = tilted_map({}, 0);
  const std::string text = refusal(map, rim_mask(map.grid, 90.0 * mm, 90.0 * mm, 90.0 * mm));
  EXPECT_NE(text.find("h03.gsf: 0 good pixels"), std::string::npos) << text;
}

TEST(FitRimPlane, RefusesARimWithoutData) {
  ChannelMap map = tilted_map({}, 0);
  map.flags.setConstant(PixelFlag::no_data);
  EXPECT_NE(refusal(map, rim_of(map)), "");
  // 99 good pixels are one too few.
  const Flags2 rim = rim_of(map);
  Index freed = 0;
  for (Index i = 0; i < rim.size() && freed < 99; i += 7) {
    if (rim.data()[i] == 0) continue;
    map.flags.data()[i] = 0;
    ++freed;
  }
  EXPECT_NE(refusal(map, rim).find("99 good pixels"), std::string::npos);
}

TEST(FitRimPlane, RefusesARimOnOneLine) {
  // A map of one row, on the centre line and off it.
  for (const double z0 : {0.0, 0.3e-3}) {
    ChannelMap line;
    line.grid = {500, 1, 10.0 * um, 10.0 * um, -1.0 * mm, Length::from_si(z0)};
    line.height = Array2::Zero(1, 500);
    line.flags = Flags2::Zero(1, 500);
    EXPECT_NE(refusal(line, Flags2::Ones(1, 500)).find("500 good pixels"), std::string::npos);
  }
}

}  // namespace
}  // namespace manoscope::maps

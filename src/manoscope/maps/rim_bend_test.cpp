#include "manoscope/maps/rim_bend.hpp"

#include <gtest/gtest.h>

#include <cmath>

#include "manoscope/core/flags.hpp"
#include "manoscope/maps/reduce.hpp"
#include "tests/support/synthetic_map.hpp"

namespace manoscope::maps {
namespace {

using test_support::Bulge;
using test_support::MapErrors;
using test_support::Pulls;

constexpr Length kLength = 15.5 * mm, kWidth = 1.0 * mm;
const CameraGrid kCamera{512, 96, 31.2 * um, 15.6 * um};

ChannelFrame plain_frame() {
  return test_support::frame_at(kLength, kWidth, FlowDirection::plus_columns, false, 0.25 * mm,
                                0.25 * mm);
}

/// Bend of a frame, m, u and v from -1 to 1 over the map.
struct Form {
  double xx, zz, xz;
  double operator()(double u, double v) const { return xx * u * u + zz * v * v + xz * u * v; }
};

HeightMap wall_map(const Form& form, double crest, double noise, std::uint64_t trial) {
  MapErrors errors;
  errors.noise = noise;
  errors.tilt_columns = 1e-5;
  RandomStream stream(37, "rim bend", trial);
  const Bulge bulge{kLength.si(), kWidth.si(), crest, 0.4e-3, 0.3};
  const HeightMap flat = test_support::synthetic_map(kCamera, plain_frame(), bulge, errors, stream);
  Array2 height = flat.height();
  for (Index iy = 0; iy < kCamera.ny; ++iy) {
    for (Index ix = 0; ix < kCamera.nx; ++ix) {
      const double u = (2.0 * static_cast<double>(ix) + 1.0) / 512.0 - 1.0;
      const double v = (2.0 * static_cast<double>(iy) + 1.0) / 96.0 - 1.0;
      height(iy, ix) += form(u, v);
    }
  }
  return {kCamera, std::move(height)};
}

TEST(RimBend, OrderTwoTakesACurvedFrameOffTheDeflection) {
  const Form form{150e-9, -80e-9, 40e-9};
  ReduceOptions second;
  second.level_order = 2;
  const auto zeta = [&](const HeightMap& map, const ReduceOptions& options) -> Array1 {
    return reduce_map(map, plain_frame(), {}, "map", options).profile.zeta;
  };
  const Array1 flat = zeta(wall_map({}, 10e-6, 0.0, 1), {});
  const HeightMap bent = wall_map(form, 10e-6, 0.0, 1);
  EXPECT_GT((zeta(bent, {}) - flat).abs().maxCoeff(), 30e-9);  // it would have mattered
  // A noise-free surface of second order is fitted to round-off of the heights.
  EXPECT_LT((zeta(bent, second) - flat).abs().maxCoeff(), 1e-12);
}

TEST(RimBend, ItsErrorModesCoverWhatNoiseDoesToIt) {
  ReduceOptions second;
  second.level_order = 2;
  const Array1 truth =
      reduce_map(wall_map({}, 5e-6, 0.0, 1), plain_frame(), {}, "map", second).profile.zeta;
  Pulls pulls;
  for (std::uint64_t trial = 0; trial < 60; ++trial) {
    const Profile profile = reduce_map(wall_map({80e-9, 0.0, 0.0}, 5e-6, 20e-9, 100 + trial),
                                       plain_frame(), {}, "map", second)
                                .profile;
    // Without the position error, which this map does not have.
    Uncertainty uncertainty = profile.uncertainty;
    std::erase_if(uncertainty.modes, [](const ErrorMode& m) { return m.source == "registration"; });
    const Array1 sigma = uncertainty.standard();
    // One station in 40: half a noise length of the leveling modes and more.
    for (Index i = 60; i < 440; i += 40) pulls.add((profile.zeta[i] - truth[i]) / sigma[i]);
  }
  EXPECT_NEAR(pulls.width(), 1.0, 0.15);  // 600 pulls, a tenth as many independent
  EXPECT_NEAR(pulls.mean(), 0.0, 0.3);
}

TEST(RimBend, IsReportedWithAnUncertaintyThatHolds) {
  Pulls flat, bent;
  for (std::uint64_t trial = 0; trial < 60; ++trial) {
    for (const bool is_bent : {false, true}) {
      const Form form{is_bent ? 60e-9 : 0.0, 0.0, 0.0};
      const LeveledMap map =
          level_map(wall_map(form, 5e-6, 20e-9, trial), plain_frame(), {}, "map");
      const RimBend& bend = map.condition.bend;
      // What the plane takes of u^2 on this rim is the same with and without noise.
      const RimBend exact =
          level_map(wall_map(form, 5e-6, 0.0, trial), plain_frame(), {}, "map").condition.bend;
      (is_bent ? bent : flat).add((bend.at_middle - exact.at_middle) / bend.at_middle_uncertainty);
      if (is_bent) {
        EXPECT_GT(std::abs(bend.at_middle / bend.at_middle_uncertainty), 3.0);
      }
    }
  }
  EXPECT_NEAR(flat.width(), 1.0, 0.3);  // 60 pulls: 0.09, three times
  EXPECT_NEAR(bent.width(), 1.0, 0.3);
}

TEST(RimBend, IsZeroWhereTheRimDoesNotDetermineIt) {
  ChannelMap map = to_channel_frame(wall_map({}, 0.0, 20e-9, 1), plain_frame());
  Flags2 rim = Flags2::Zero(map.grid.nz, map.grid.nx);
  rim.topRows(2).setOnes();
  rim.bottomRows(2).setOnes();  // v^2 is not told from a constant
  rim.topRows(1).setZero();
  rim.bottomRows(1).setZero();
  const RimBend bend = fit_rim_bend(map, rim, 20.0 * nm, kLength);
  EXPECT_EQ(bend.coefficient.norm(), 0.0);
}

}  // namespace
}  // namespace manoscope::maps

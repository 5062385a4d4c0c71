#include "manoscope/maps/rim_bend.hpp"

#include <gtest/gtest.h>

#include <Eigen/LU>
#include <algorithm>
#include <cmath>
#include <vector>

#include "manoscope/core/flags.hpp"
#include "manoscope/maps/reduce.hpp"
#include "manoscope/numerics/robust.hpp"
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

/// The same fit, point by point.
RimBend slow_fit(const ChannelMap& map, const Flags2& rim, Length sigma) {
  RimBend bend = fit_rim_bend(map, rim, sigma, kLength);  // for the scales of x and z alone
  std::vector<RimBend::Terms> terms;
  std::vector<double> heights;
  Index n_rim = 0, passed = 0;
  for (const FlagBits on_rim : rim.reshaped()) n_rim += on_rim;
  const Index every = std::max<Index>(1, n_rim / 20000);
  for (Index iz = 0; iz < map.grid.nz; ++iz) {
    for (Index ix = 0; ix < map.grid.nx; ++ix) {
      if (rim(iz, ix) == 0 || map.flags(iz, ix) != 0 || passed++ % every != 0) continue;
      terms.push_back(bend.terms(map.grid.x(ix), map.grid.z(iz)));
      heights.push_back(map.height(iz, ix));
    }
  }
  bend.coefficient.setZero();
  double spread = sigma.si();
  for (int pass = 0; pass < 3; ++pass) {
    Eigen::Matrix<double, 6, 6> normal = Eigen::Matrix<double, 6, 6>::Zero();
    RimBend::Terms right = RimBend::Terms::Zero();
    for (std::size_t i = 0; i < terms.size(); ++i) {
      const double off = (heights[i] - bend.coefficient.dot(terms[i])) / (4.685 * spread);
      const double weight = std::abs(off) < 1.0 ? std::pow(1.0 - off * off, 2) : 0.0;
      normal += weight * terms[i] * terms[i].transpose();
      right += weight * heights[i] * terms[i];
    }
    bend.coefficient = normal.fullPivLu().solve(right);
    std::vector<double> residuals;
    for (std::size_t i = 0; i < terms.size(); ++i) {
      residuals.push_back(heights[i] - bend.coefficient.dot(terms[i]));
    }
    spread = numerics::mad_sigma(residuals, 0.0);
    bend.covariance = spread * spread * normal.inverse();
  }
  bend.sigma = Length::from_si(spread);
  return bend;
}

TEST(RimBend, IsThatOfAFitPointByPoint) {
  for (const Length margin :
       {50.0 * um, -400.0 * um}) {  // all of the good pixels, and every second
    ChannelMap map =
        to_channel_frame(wall_map({60e-9, -30e-9, 20e-9}, 0.0, 20e-9, 3), plain_frame());
    RandomStream stream(37, "damage");
    for (Index i = 0; i < map.height.size(); ++i) {
      if (stream.uniform() < 0.02) map.height.data()[i] += 2e-6 * stream.uniform();
      if (stream.uniform() < 0.02) map.flags.data()[i] = PixelFlag::no_data;
    }
    const Flags2 rim = rim_mask(map.grid, kLength, kWidth, margin);
    const RimBend fast = fit_rim_bend(map, rim, 25.0 * nm, kLength);
    const RimBend slow = slow_fit(map, rim, 25.0 * nm);
    // Round-off of sums over 20 000 pixels.
    EXPECT_LT((fast.coefficient - slow.coefficient).norm(), 1e-10 * slow.coefficient.norm());
    EXPECT_LT((fast.covariance - slow.covariance).norm(), 1e-10 * slow.covariance.norm());
    EXPECT_NEAR(fast.sigma / slow.sigma, 1.0, 1e-12);
    EXPECT_NEAR(fast.sigma.in(nm), 20.0, 1.0);  // 2 % of outliers, noise of a robust deviation
  }
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

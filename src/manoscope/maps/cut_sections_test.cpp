#include "manoscope/maps/cut_sections.hpp"

#include <gtest/gtest.h>

#include <cmath>
#include <functional>

#include "manoscope/core/flags.hpp"
#include "manoscope/core/random.hpp"
#include "tests/support/synthetic_map.hpp"

namespace manoscope::maps {
namespace {

using test_support::Pulls;
using Shape = std::function<double(double, double)>;  // zeta(x, z)

constexpr double kWidth = 1.7e-3, kLength = 8e-3, kCrest = 50e-6;
constexpr Length kPitchX = 32.0 * um;

/// `across` pixels on the width and six beyond it on either side, the wall's middle `middle` off
/// z = 0.
DeflectionMap sampled(const Shape& zeta, double across, double middle = 0.0, Length noise = {}) {
  const double pitch = kWidth / across;
  const auto nz = static_cast<Index>(across) + 12;
  const auto nx = static_cast<Index>(kLength / kPitchX.si()) + 8;
  const ChannelGrid grid{nx,
                         nz,
                         kPitchX,
                         Length::from_si(pitch),
                         -4.0 * kPitchX,
                         Length::from_si(-0.5 * static_cast<double>(nz - 1) * pitch)};
  Array2 heights(nz, nx);
  for (Index iz = 0; iz < nz; ++iz) {
    for (Index ix = 0; ix < nx; ++ix) heights(iz, ix) = zeta(grid.x(ix), grid.z(iz) - middle);
  }
  return {grid, heights, Flags2::Zero(nz, nx), noise};
}

DeflectionMap with_flags(const DeflectionMap& map,
                         const std::function<bool(Index, Index)>& is_bad) {
  Flags2 flags = map.flags();
  for (Index iz = 0; iz < flags.rows(); ++iz) {
    for (Index ix = 0; ix < flags.cols(); ++ix) {
      if (is_bad(iz, ix)) flags(iz, ix) = PixelFlag::no_data;
    }
  }
  return {map.grid(), map.zeta(), flags, map.noise()};
}

CrossSections cut(const DeflectionMap& map, double middle = 0.0) {
  CentreLine centre;
  centre.offset = Length::from_si(middle);
  return cut_sections(map, Length::from_si(kLength), Length::from_si(kWidth), map.noise(), centre);
}

double parabola(double, double z) {
  const double u = 2.0 * z / kWidth;
  return kCrest * (1.0 - u * u);
}

TEST(CutSections, IsExactForPlanesWhereverPixelsLieAndWhicheverAreMissing) {
  const Shape plane = [](double x, double z) { return 5e-6 + 1e-3 * x + 2e-2 * z; };
  for (const double across : {30.0, 65.3, 131.0}) {
    for (const double middle : {0.0, 3e-6, 11e-6}) {
      const DeflectionMap map = with_flags(sampled(plane, across, middle), [](Index iz, Index ix) {
        return (3 * iz + ix) % 11 == 0;
      });
      const CrossSections cells = cut(map, middle);
      ASSERT_EQ(cells.z.size(), across < 48.0 ? 9 : 16);
      ASSERT_EQ(cells.x.size(), 38);                    // 8 mm in eighths of the width
      for (Index j = 1; j + 1 < cells.x.size(); ++j) {  // a gap at the ends has one side only
        for (Index b = 0; b < cells.z.size(); ++b) {
          EXPECT_EQ(cells.flags(b, j), 0);
          EXPECT_NEAR(cells.zeta(b, j), plane(cells.x[j], cells.z[b]), 1e-18);  // round-off
        }
      }
    }
  }
}

TEST(CutSections, HardlyNoticesWherePixelsLieInTheBins) {
  for (const double across : {40.0, 65.3, 131.0}) {
    const double pitch = kWidth / across;
    const CrossSections reference = cut(sampled(parabola, across));
    const double bin = reference.z[1] - reference.z[0];
    for (const double phase : {0.1, 0.3, 0.5, 0.8}) {
      const double middle = phase * pitch;
      const CrossSections moved = cut(sampled(parabola, across, middle), middle);
      // The straight lines lose curvature pitch^2 / 12 in every whole step between pixels, alike
      // wherever they lie, and in the two steps that a bin's ends cut at most 0.008 pitch^3 more or
      // less each.
      const double bound =
          2.0 * 0.008 * (8.0 * kCrest / (kWidth * kWidth)) * std::pow(pitch, 3) / bin;
      EXPECT_LT((moved.zeta - reference.zeta).abs().maxCoeff(), 1.05 * bound)
          << across << ' ' << phase;
    }
  }
}

TEST(CutSections, StatesTheNoiseOfItsCells) {
  RandomStream random(7, "cells");
  const Length noise = 20.0 * nm;
  // Bends along the flow as much as a wall does 1 mm behind its end.
  const Shape wall = [](double x, double z) {
    return parabola(0.0, z) * (1.0 - std::exp(-(x + 1e-3) / 0.5e-3));
  };
  const CrossSections expected = cut(sampled(wall, 65.3));
  Pulls pulls;
  for (int trial = 0; trial < 20; ++trial) {
    const DeflectionMap seen =
        sampled([&](double x, double z) { return wall(x, z) + noise.si() * random.normal(); }, 65.3,
                0.0, noise);
    // One pixel in fifty is missing.
    const CrossSections cells =
        cut(with_flags(seen, [&](Index, Index) { return random.below(50) == 0; }));
    for (Index i = 0; i < cells.zeta.size(); ++i) {
      if (cells.flags.data()[i] != 0) continue;
      pulls.add((cells.zeta.data()[i] - expected.zeta.data()[i]) / cells.sigma.data()[i]);
    }
  }
  ASSERT_GT(pulls.n, 10000);
  // Neighbouring cells share pixels at their border, a sixth of their weight: 4 sigma of 10000.
  EXPECT_NEAR(pulls.mean(), 0.0, 0.05);
  EXPECT_NEAR(pulls.width(), 1.0, 0.03);
}

TEST(CutSections, LeavesOutSinglePixelsThatStandOff) {
  const Length noise = 20.0 * nm;
  const Shape wall = [](double x, double z) {
    return parabola(0.0, z) * (1.0 - std::exp(-(x + 0.2e-3) / 0.5e-3));
  };
  const DeflectionMap clean = sampled(wall, 65.3, 0.0, noise);
  Array2 heights = clean.zeta();
  for (Index ix = 10; ix + 10 < heights.cols(); ix += 7) heights(5 + ix % 60, ix) += 0.5e-6;
  const DeflectionMap spiky(clean.grid(), heights, clean.flags(), noise);
  const CrossSections expected = cut(clean), found = cut(spiky);
  // Bridging along the flow instead: the wall's bend over two pixels of 32 um, at most 50 um /
  // (0.5 mm)^2, in one of 16 pixels or more. A spike would be 30 nm.
  const double bound = 75e-6 / 0.25e-6 * std::pow(32e-6, 2) / 2.0 / 16.0;
  EXPECT_LT((found.zeta - expected.zeta).abs().maxCoeff(), bound);
  EXPECT_EQ((found.flags != 0).count(), 0);
}

TEST(CutSections, FlagsACellWithAHoleTooWideToBridge) {
  const CrossSections cells = cut(with_flags(sampled(parabola, 65.3), [](Index iz, Index ix) {
    return iz == 30 && ix >= 100 && ix < 110;  // 0.35 mm of a row
  }));
  Index n_flagged = 0;
  for (Index i = 0; i < cells.flags.size(); ++i) n_flagged += cells.flags.data()[i] != 0;
  EXPECT_GE(n_flagged, 2);  // 0.35 mm touch two stretches or three
  EXPECT_LE(n_flagged, 6);  // in one bin, or two that share the row
}

TEST(CutSections, LeavesWallsOfFewPixelsUncut) {
  EXPECT_TRUE(cut(sampled(parabola, 20.0)).empty());
}

}  // namespace
}  // namespace manoscope::maps

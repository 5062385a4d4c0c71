#include "manoscope/maps/width_average.hpp"

#include <gtest/gtest.h>

#include <cmath>
#include <functional>
#include <limits>

#include "manoscope/core/error.hpp"
#include "manoscope/core/flags.hpp"
#include "tests/support/synthetic_map.hpp"

namespace manoscope::maps {
namespace {

using test_support::Pulls;
using Shape = std::function<double(double, double)>;  // zeta(x, z)

constexpr double kWidth = 1.7e-3, kLength = 4e-3, kCrest = 50e-6;
constexpr double kNan = std::numeric_limits<double>::quiet_NaN();

/// `across` pixels on the width, a rim of 5 % and two pixels beyond it; the first pixel's centre
/// sits `phase` of a pitch further on. Heights that are not finite are dropouts.
DeflectionMap sampled(const Shape& zeta, double across, double phase, Length noise = {},
                      Index nx = 3) {
  const double pitch = kWidth / across;
  const auto rim = static_cast<Index>(0.05 * across) + 3;
  const Index nz = static_cast<Index>(across) + 2 * rim;
  const ChannelGrid grid{
      nx,
      nz,
      Length::from_si(1e-4),
      Length::from_si(pitch),
      Length::from_si(1e-3),
      Length::from_si(-0.5 * kWidth + (phase - static_cast<double>(rim)) * pitch)};
  Array2 heights(nz, nx);
  Flags2 flags = Flags2::Zero(nz, nx);
  for (Index iz = 0; iz < nz; ++iz) {
    for (Index ix = 0; ix < nx; ++ix) {
      heights(iz, ix) = zeta(grid.x(ix), grid.z(iz));
      if (std::isfinite(heights(iz, ix))) continue;
      heights(iz, ix) = 0.0;
      flags(iz, ix) = PixelFlag::no_data;
    }
  }
  return {grid, heights, flags, noise};
}

Profile average(const DeflectionMap& map, const WidthAverageOptions& options = {}) {
  return width_average(map, RimPlane{}, Length::from_si(kLength), Length::from_si(kWidth), "map",
                       options);
}

double one_average(const Shape& zeta, double across, double phase) {
  const Profile profile = average(sampled(zeta, across, phase));
  EXPECT_EQ(profile.flags[1], 0);
  return profile.zeta[1];
}

double parabola(double, double z) {
  const double u = 2.0 * z / kWidth;
  return std::abs(u) < 1.0 ? kCrest * (1.0 - u * u) : 0.0;
}
double clamped_plate(double, double z) {
  const double u = 2.0 * z / kWidth;
  return std::abs(u) < 1.0 ? kCrest * (1.0 - u * u) * (1.0 - u * u) : 0.0;
}
constexpr double kPhases[] = {0.0, 0.1, 0.25, 0.4, 0.5, 2.0 / 3.0, 0.8, 0.99};

TEST(WidthAverage, IsExactForConstantAndLinearShapesWhereverThePixelsFall) {
  for (const double across : {16.0, 65.3, 130.77}) {
    for (const double phase : kPhases) {
      // Round-off of 5 um.
      EXPECT_NEAR(one_average([](double, double) { return 5e-6; }, across, phase), 5e-6, 1e-19);
      EXPECT_NEAR(one_average([](double, double z) { return 5e-6 + 1e-3 * z; }, across, phase),
                  5e-6, 1e-19);
    }
  }
}

TEST(WidthAverage, ErrsNoMoreThanStatedForAParabola) {
  constexpr double kExact = 2.0 / 3.0 * kCrest;
  const double edge_slopes = 2.0 * 4.0 * kCrest / kWidth;  // their difference
  for (const double across : {16.0, 65.3, 130.0}) {
    const double pitch = kWidth / across;
    double worst = 0.0;
    for (const double phase : kPhases) {
      worst = std::max(worst, std::abs(one_average(parabola, across, phase) - kExact));
    }
    // The documented bound, with the next order in d/w, 1/across, on top.
    const double stated = pitch * pitch / 12.0 * edge_slopes / kWidth;
    EXPECT_LT(worst, stated * (1.0 + 2.0 / across)) << across;
    EXPECT_GT(worst, 0.8 * stated) << "the bound is met where pixels fall on the edges";
    if (across == 130.0) {
      EXPECT_LT(worst, 2e-9);
    }
  }
}

TEST(WidthAverage, ConvergesAtSecondOrderForAMembraneAndFasterForAPlate) {
  const auto worst = [](const Shape& shape, double exact, double across) {
    double error = 0.0;
    for (const double phase : kPhases) {
      error = std::max(error, std::abs(one_average(shape, across, phase) - exact));
    }
    return error;
  };
  const double membrane =
      worst(parabola, 2.0 / 3.0 * kCrest, 32.0) / worst(parabola, 2.0 / 3.0 * kCrest, 128.0);
  EXPECT_NEAR(std::log2(membrane) / 2.0, 2.0, 0.05);  // order 2; the next order adds 2/32
  const double plate = worst(clamped_plate, 8.0 / 15.0 * kCrest, 32.0) /
                       worst(clamped_plate, 8.0 / 15.0 * kCrest, 128.0);
  EXPECT_GT(std::log2(plate) / 2.0, 2.8);  // no slope at the edges: order 3 at least
}

TEST(WidthAverage, LosesTheSquareOfWhatItsMiddleIsOffBy) {
  // Of a parabola 3 (d / w)^2 (1 - 2 d / 3 w), of a plate less: so that 0.3 pixels of 40 across
  // need no line in the budget. The grid is fine enough for its own error, below 2 (1 / 400)^2, to
  // be a tenth of that.
  constexpr double kPixels = 400.0, kFine = 2.0 / (kPixels * kPixels);
  for (const double share : {0.3 / 40.0, 0.02}) {
    CentreLine off;
    off.offset = Length::from_si(share * kWidth);
    const auto relative_loss = [&](const Shape& shape) {
      const DeflectionMap map = sampled(shape, kPixels, 0.3);
      const auto averaged = [&](const CentreLine& centre) {
        return width_average(map, RimPlane{}, Length::from_si(kLength), Length::from_si(kWidth),
                             "map", {}, centre)
            .zeta[1];
      };
      return 1.0 - averaged(off) / averaged({});
    };
    EXPECT_NEAR(relative_loss(parabola), 3.0 * share * share * (1.0 - share / 1.5), kFine);
    EXPECT_LT(relative_loss(clamped_plate), 0.3 * 3.0 * share * share + kFine);
  }
}

TEST(WidthAverage, GivesAStationForEveryColumnInsideTheChannelAndNoOther) {
  const ChannelGrid grid{57, 30, 100.0 * um, 100.0 * um, -0.77 * mm, -1.45 * mm};
  const Profile profile = average({grid, Array2::Zero(30, 57), Flags2::Zero(30, 57), Length{}});
  ASSERT_EQ(profile.x.size(), 40);  // 4 mm in steps of 0.1 mm
  EXPECT_NEAR(profile.x[0], 0.03e-3, 1e-12);
  EXPECT_NEAR(profile.x[39], 3.93e-3, 1e-12);
  EXPECT_GE(profile.x.minCoeff(), 0.0);
  EXPECT_LE(profile.x.maxCoeff(), kLength);
  EXPECT_TRUE((profile.flags == 0).all());
}

TEST(WidthAverage, RefusesAMapBesideTheChannel) {
  const ChannelGrid grid{10, 30, 100.0 * um, 100.0 * um, 9.0 * mm, -1.45 * mm};
  EXPECT_THROW(average({grid, Array2::Zero(30, 10), Flags2::Zero(30, 10), Length{}}), InputError);
}

TEST(WidthAverage, TakesTheClampedEdgeWhereTheMapIsCutAtTheChannel) {
  // No rim at all: pixels beyond the edges hold no data.
  for (const double phase : kPhases) {
    const double zeta = one_average(
        [](double x, double z) { return std::abs(z) < 0.5 * kWidth ? parabola(x, z) : kNan; }, 65.0,
        phase);
    // Exact chord rule with a last cell shorter than a pitch: within the stated bound.
    EXPECT_NEAR(zeta, 2.0 / 3.0 * kCrest, 2.0 / 3.0 * kCrest / (65.0 * 65.0) * 1.1);
  }
}

TEST(WidthAverage, FlagsAGapThatIsTooWideAndKeepsOneThatIsNot) {
  const auto with_gap = [](double share) {
    return Shape([share](double x, double z) {
      return std::abs(z - 0.2 * kWidth) < 0.5 * share * kWidth ? kNan : parabola(x, z);
    });
  };
  EXPECT_EQ(average(sampled(with_gap(0.085), 130.0, 0.3)).flags[1], 0);
  EXPECT_EQ(average(sampled(with_gap(0.11), 130.0, 0.3)).flags[1], StationFlag::no_data);
  WidthAverageOptions options;
  options.largest_gap = 0.25;
  EXPECT_EQ(average(sampled(with_gap(0.11), 130.0, 0.3), options).flags[1], 0);
  // A coarse camera forgives one missing pixel, whatever its share of the width, but not two.
  EXPECT_EQ(average(sampled(with_gap(0.06), 16.0, 0.5)).flags[1], 0);
  EXPECT_EQ(average(sampled(with_gap(0.12), 16.0, 0.5)).flags[1], StationFlag::no_data);
}

TEST(WidthAverage, FlagsAColumnWithTooFewPixels) {
  // Every second of 131 pixels is missing: no wide gap, but half of them.
  const double pitch = kWidth / 130.0;
  const Shape half = [pitch](double x, double z) {
    const auto k = static_cast<Index>(std::lround(z / pitch + 1000.0));
    return k % 2 == 0 ? kNan : parabola(x, z);
  };
  WidthAverageOptions options;
  options.smallest_coverage = 0.55;
  const Profile flagged = average(sampled(half, 130.0, 0.0), options);
  EXPECT_EQ(flagged.flags[1], StationFlag::no_data);
  EXPECT_EQ(flagged.zeta[1], 0.0);
  EXPECT_EQ(flagged.uncertainty.independent[1], 0.0);
  options.smallest_coverage = 0.45;
  EXPECT_EQ(average(sampled(half, 130.0, 0.0), options).flags[1], 0);
  EXPECT_EQ(average(sampled([](double, double) { return kNan; }, 130.0, 0.0)).flags[1],
            StationFlag::no_data);
}

TEST(WidthAverage, NamesAnOptionOutOfRange) {
  for (const double bad : {0.0, -1.0, 1.5}) {
    WidthAverageOptions gap, coverage;
    gap.largest_gap = coverage.smallest_coverage = bad;
    EXPECT_THROW(gap.validate(), InputError) << bad;
    EXPECT_THROW(coverage.validate(), InputError) << bad;
  }
}

/// Pulls of independent stations over 400 columns and several seeds; `gap` is the dropout share.
Pulls noise_pulls(double across, double dropouts, double noise) {
  RandomStream stream(31, "width pulls");
  Pulls pulls;
  for (int trial = 0; trial < 5; ++trial) {
    const Shape shape = [&](double x, double z) {
      return stream.uniform() < dropouts ? kNan : clamped_plate(x, z) + noise * stream.normal();
    };
    const DeflectionMap map = sampled(shape, across, stream.uniform(), Length::from_si(noise), 400);
    const Profile profile =
        width_average(map, RimPlane{}, 1.0 * metre, Length::from_si(kWidth), "map");
    for (Index i = 0; i < profile.x.size(); ++i) {
      if (profile.flags[i] != 0) continue;
      pulls.add((profile.zeta[i] - 8.0 / 15.0 * kCrest) / profile.uncertainty.independent[i]);
    }
  }
  return pulls;
}

TEST(WidthAverage, StatesThePixelNoiseTruly) {
  const Pulls pulls = noise_pulls(130.0, 0.0, 20e-9);
  ASSERT_GT(pulls.n, 1900.0);
  EXPECT_NEAR(pulls.mean(), 0.0, 4.0 / std::sqrt(pulls.n));
  EXPECT_NEAR(pulls.width(), 1.0, 4.0 / std::sqrt(2.0 * pulls.n));
  // 20 nm over the root of 130 pixels.
  const Profile profile = average(sampled(parabola, 130.0, 0.5, 20.0 * nm));
  EXPECT_NEAR(profile.uncertainty.independent[1], 20e-9 / std::sqrt(130.0), 0.01 * 1.75e-9);
}

TEST(WidthAverage, StaysTrueWithThreePercentOfPixelsMissing) {
  const Pulls pulls = noise_pulls(130.0, 0.03, 20e-9);
  ASSERT_GT(pulls.n, 1900.0);
  // The chord across a missing pixel lies below a bulge by (2/130)^3 - (1/130)^3 of its mean over
  // four such gaps: 0.35 nm, 0.2 of the noise.
  EXPECT_NEAR(pulls.mean(), 0.0, 0.2 + 4.0 / std::sqrt(pulls.n));
  EXPECT_NEAR(pulls.width(), 1.0, 0.1);
}

TEST(WidthAverage, CoversTheErrorOfAGapWhereverItLies) {
  // No noise: what is stated is the sag across the gap, and what is wrong must not exceed it. A
  // factor 1.5 leaves room for a quadrature error of a few per cent of a gap's.
  for (const double share : {0.03, 0.06, 0.09}) {
    for (double at = -0.5; at <= 0.5; at += 0.01) {
      const Shape shape = [share, at](double x, double z) {
        return std::abs(z - at * kWidth) < 0.5 * share * kWidth ? kNan : parabola(x, z);
      };
      const Profile profile = average(sampled(shape, 130.0, 0.37));
      if (profile.flags[1] != 0) continue;
      const double quadrature = 2e-9;  // as stated for 130 pixels
      EXPECT_LT(std::abs(profile.zeta[1] - 2.0 / 3.0 * kCrest),
                1.5 * profile.uncertainty.independent[1] + quadrature)
          << share << " at " << at;
    }
  }
}

TEST(WidthAverage, CarriesThePlaneCovarianceAsSharedModes) {
  RimPlane plane;
  plane.x_centre = 2e-3;
  Eigen::Matrix3d root;
  root << 1e-9, 0, 0, 2e-7, 5e-7, 0, -3e-7, 1e-7, 9e-7;
  plane.covariance = root * root.transpose();
  const DeflectionMap map = sampled(parabola, 65.0, 0.3, Length{}, 20);
  Profile profile =
      width_average(map, plane, Length::from_si(kLength), Length::from_si(kWidth), "h03.gsf");
  // Beside the plane only the quadrature, whose variable belongs to no map.
  EXPECT_EQ(std::erase_if(profile.uncertainty.modes,
                          [](const ErrorMode& mode) { return mode.source == "quadrature"; }),
            1U);
  ASSERT_EQ(profile.uncertainty.modes.size(), 3U);
  for (const ErrorMode& mode : profile.uncertainty.modes) {
    EXPECT_EQ(mode.source, "leveling");
    EXPECT_NE(mode.variable.find("h03.gsf"), std::string::npos);
  }
  const Matrix covariance = profile.uncertainty.covariance();
  for (const Index i : {Index{0}, Index{7}, Index{19}}) {
    for (const Index j : {Index{0}, Index{12}}) {
      // The mean over z of a plane is its height at z = 0, on the channel's centre line.
      const Eigen::Vector3d a(1.0, profile.x[i] - 2e-3, 0.0), b(1.0, profile.x[j] - 2e-3, 0.0);
      EXPECT_NEAR(covariance(i, j), a.dot(plane.covariance * b), 1e-9 * plane.covariance(0, 0));
    }
  }
}

}  // namespace
}  // namespace manoscope::maps

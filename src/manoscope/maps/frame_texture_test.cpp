#include "manoscope/maps/frame_texture.hpp"

#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <numbers>
#include <tuple>

#include "manoscope/core/flags.hpp"
#include "manoscope/core/random.hpp"
#include "tests/support/synthetic_map.hpp"

namespace manoscope::maps {
namespace {

using test_support::Pulls;

constexpr Length kMargin = 48.0 * um;
constexpr double kDegree = std::numbers::pi / 180.0;

/// A camera about a channel: 25 pixels of rim on every side, or of another number of pixels.
struct Setting {
  ChannelGrid grid;
  Length length{}, width{};

  explicit Setting(Index nx = 512, Index nz = 128, Length pitch_x = 16.0 * um,
                   Length pitch_z = 16.0 * um, Index border = 25) {
    grid.nx = nx;
    grid.nz = nz;
    grid.pitch_x = pitch_x;
    grid.pitch_z = pitch_z;
    length = static_cast<double>(nx - 2 * border) * pitch_x;
    width = static_cast<double>(nz - 2 * border) * pitch_z;
    grid.x0 = -(static_cast<double>(border) - 0.5) * pitch_x;
    grid.z0 = -0.5 * width - (static_cast<double>(border) - 0.5) * pitch_z;
  }
  bool in_channel(Index iz, Index ix) const {
    return grid.x(ix) > 0.0 && grid.x(ix) < length.si() && std::abs(grid.z(iz)) < 0.5 * width.si();
  }
};

/// A smooth random field that can be looked at anywhere: white nodes one pixel apart under the
/// kernel exp(-r^2 / l^2), whose correlation is exp(-r^2 / (2 l^2)).
class RandomField {
 public:
  /// @param reach  correlation length l, pixels; 0 is white and stands on pixels alone.
  RandomField(const Setting& setting, double rms, double reach, RandomStream& random)
      : rms_(rms),
        reach_(reach),
        nodes_(setting.grid.nz + 2 * kBorder, setting.grid.nx + 2 * kBorder) {
    for (Index i = 0; i < nodes_.size(); ++i) nodes_.data()[i] = random.normal();
  }
  /// @param a, b  column and row, pixels.
  double at(double a, double b) const {
    a += kBorder;
    b += kBorder;
    if (reach_ == 0.0) {
      return rms_ * nodes_(static_cast<Index>(std::lround(b)), static_cast<Index>(std::lround(a)));
    }
    const auto half = static_cast<Index>(std::ceil(2.6 * reach_));
    const auto first_a = static_cast<Index>(std::lround(a)) - half;
    const auto first_b = static_cast<Index>(std::lround(b)) - half;
    const Index n = 2 * half + 1;
    Eigen::VectorXd ka(n), kb(n);
    for (Index i = 0; i < n; ++i) {
      ka[i] = std::exp(-std::pow((a - static_cast<double>(first_a + i)) / reach_, 2));
      kb[i] = std::exp(-std::pow((b - static_cast<double>(first_b + i)) / reach_, 2));
    }
    const double sum = kb.dot(nodes_.matrix().block(first_b, first_a, n, n) * ka);
    return rms_ * sum / std::sqrt(ka.squaredNorm() * kb.squaredNorm());
  }

 private:
  static constexpr Index kBorder = 48;
  double rms_, reach_;
  Array2 nodes_;
};

/// How a map shows the frame: shifts in pixels, angle in rad.
struct View {
  double dx = 0.0, dz = 0.0, angle = 0.0, noise = 20e-9, noise_reach = 0.0, dropouts = 0.0;
};

/// Every pixel of the channel is 10 um high and rough: none of it may count.
DeflectionMap seen(const Setting& setting, const RandomField& frame, const View& view,
                   RandomStream& random) {
  const ChannelGrid& grid = setting.grid;
  const RandomField noise(setting, view.noise, view.noise_reach, random);
  Array2 height(grid.nz, grid.nx);
  Flags2 flags = Flags2::Zero(grid.nz, grid.nx);
  const double c = std::cos(view.angle), s = std::sin(view.angle);
  const double px = grid.pitch_x.si(), pz = grid.pitch_z.si(), middle = 0.5 * setting.length.si();
  for (Index iz = 0; iz < grid.nz; ++iz) {
    for (Index ix = 0; ix < grid.nx; ++ix) {
      if (setting.in_channel(iz, ix)) {
        height(iz, ix) = 10e-6 + 1e-6 * random.normal();
        continue;
      }
      const double x = grid.x(ix) - middle - view.dx * px, z = grid.z(iz) - view.dz * pz;
      const double a = (c * x + s * z + middle - grid.x0.si()) / px;
      const double b = (-s * x + c * z - grid.z0.si()) / pz;
      height(iz, ix) = frame.at(a, b) + noise.at(static_cast<double>(ix), static_cast<double>(iz));
      if (view.dropouts > 0.0 && random.uniform() < view.dropouts) {
        flags(iz, ix) = PixelFlag::no_data;
        height(iz, ix) = 0.0;
      }
    }
  }
  return {grid, std::move(height), std::move(flags), Length::from_si(view.noise)};
}

FrameTexture texture_of(const Setting& setting, const DeflectionMap& map) {
  return {map, setting.length, setting.width, kMargin};
}

TEST(FrameTexture, TellsShiftsToATwentiethOfAPixelWithErrorBarsThatHold) {
  const Setting setting;
  Pulls along, across, turn;
  for (std::uint64_t trial = 0; trial < 40; ++trial) {
    RandomStream random(5, "shifted frame", trial);
    const RandomField frame(setting, 50e-9, 3.0, random);
    const DeflectionMap reference = seen(setting, frame, {}, random);
    View view;
    view.dx = random.uniform(-3.0, 3.0);
    view.dz = random.uniform(-3.0, 3.0);
    const auto shift =
        find_texture_shift(texture_of(setting, reference), seen(setting, frame, view, random));
    ASSERT_TRUE(shift) << trial;
    const double pitch = setting.grid.pitch_x.si();
    const double dx = shift->x.si() - view.dx * pitch, dz = shift->z.si() - view.dz * pitch;
    EXPECT_LT(std::abs(dx), 0.05 * pitch) << trial;  // three times the uncertainty
    EXPECT_LT(std::abs(dz), 0.05 * pitch) << trial;
    along.add(dx / shift->x_uncertainty.si());
    across.add(dz / shift->z_uncertainty.si());
    turn.add(shift->angle / shift->angle_uncertainty);
  }
  const double three_sigma = 3.0 / std::sqrt(2.0 * 40.0);
  EXPECT_NEAR(along.width(), 1.0, three_sigma);
  EXPECT_NEAR(across.width(), 1.0, three_sigma);
  EXPECT_NEAR(turn.width(), 1.0, three_sigma);
  for (const Pulls& pulls : {along, across, turn}) {
    EXPECT_NEAR(pulls.mean(), 0.0, 3.0 / std::sqrt(40.0));
  }
}

TEST(FrameTexture, ErrorBarsHoldUnderCorrelatedNoiseAndOnFainterTexture) {
  const Setting setting;
  // Noise that neighbours share, as long as the texture itself; then texture as faint as noise.
  for (const auto& [rms, reach, noise_reach] :
       {std::tuple{50e-9, 2.0, 2.0}, std::tuple{20e-9, 2.0, 0.0}}) {
    Pulls pulls;
    for (std::uint64_t trial = 0; trial < 30; ++trial) {
      RandomStream random(6, "faint frame", trial);
      const RandomField frame(setting, rms, reach, random);
      View view;
      view.noise_reach = noise_reach;
      const DeflectionMap reference = seen(setting, frame, view, random);
      view.dx = random.uniform(-3.0, 3.0);
      view.dz = random.uniform(-3.0, 3.0);
      const auto shift =
          find_texture_shift(texture_of(setting, reference), seen(setting, frame, view, random));
      ASSERT_TRUE(shift) << rms << ' ' << trial;
      pulls.add((shift->x.si() - view.dx * setting.grid.pitch_x.si()) / shift->x_uncertainty.si());
      pulls.add((shift->z.si() - view.dz * setting.grid.pitch_z.si()) / shift->z_uncertainty.si());
    }
    EXPECT_NEAR(pulls.width(), 1.0, 3.0 / std::sqrt(2.0 * 60.0)) << rms;
  }
}

TEST(FrameTexture, TellsTheRotationOfAFrameThatSurroundsTheChannel) {
  // Pixels that are not square, too: an angle is one of lengths.
  for (const Length pitch_z : {16.0 * um, 8.0 * um}) {
    const Setting setting(1024, 192, 16.0 * um, pitch_z);
    for (const double degrees : {-0.3, 0.1, 0.3}) {
      RandomStream random(7, "turned frame");
      const RandomField frame(setting, 50e-9, 3.0, random);
      const DeflectionMap reference = seen(setting, frame, {}, random);
      View view;
      view.angle = degrees * kDegree * pitch_z / setting.grid.pitch_x;  // 2.6 pixels at the ends
      view.dx = 2.3;
      view.dz = -1.7;
      view.dropouts = 0.05;
      const auto shift =
          find_texture_shift(texture_of(setting, reference), seen(setting, frame, view, random));
      ASSERT_TRUE(shift) << degrees;
      EXPECT_LT(shift->angle_uncertainty, 0.01 * 0.3 * kDegree);
      EXPECT_NEAR(shift->angle, view.angle, 4.0 * shift->angle_uncertainty);
      EXPECT_NEAR(shift->x.si(), view.dx * setting.grid.pitch_x.si(),
                  0.05 * setting.grid.pitch_x.si());
      EXPECT_NEAR(shift->z.si(), view.dz * pitch_z.si(), 0.05 * pitch_z.si());
    }
  }
}

/// Dust: 40 discs of 3 pixels, 1 um high, anywhere.
void add_dust(DeflectionMap& map, RandomStream& random) {
  Array2 height = map.zeta();
  for (int k = 0; k < 40; ++k) {
    const auto cx = random.below(height.cols()), cz = random.below(height.rows());
    for (Index iz = std::max<Index>(0, cz - 3); iz < std::min(height.rows(), cz + 4); ++iz) {
      for (Index ix = std::max<Index>(0, cx - 3); ix < std::min(height.cols(), cx + 4); ++ix) {
        if ((ix - cx) * (ix - cx) + (iz - cz) * (iz - cz) <= 9) height(iz, ix) += 1e-6;
      }
    }
  }
  map = DeflectionMap(map.grid(), std::move(height), Flags2(map.flags()), map.noise());
}

/// A bend of the frame of one map alone: 300 nm at its ends.
void bend(DeflectionMap& map) {
  Array2 height = map.zeta();
  for (Index ix = 0; ix < height.cols(); ++ix) {
    const double u = 2.0 * static_cast<double>(ix) / static_cast<double>(height.cols() - 1) - 1.0;
    height.col(ix) += 300e-9 * u * u;
  }
  map = DeflectionMap(map.grid(), std::move(height), Flags2(map.flags()), map.noise());
}

TEST(FrameTexture, IsNotMovedByDropoutsDustThatMovedAndABentFrame) {
  const Setting setting;
  for (std::uint64_t trial = 0; trial < 8; ++trial) {
    RandomStream random(9, "dusty frame", trial);
    const RandomField frame(setting, 50e-9, 3.0, random);
    View view;
    view.dropouts = 0.05;
    DeflectionMap reference = seen(setting, frame, view, random);
    view.dx = random.uniform(-3.0, 3.0);
    view.dz = random.uniform(-3.0, 3.0);
    DeflectionMap map = seen(setting, frame, view, random);
    add_dust(reference, random);
    add_dust(map, random);
    bend(map);
    const auto shift = find_texture_shift(texture_of(setting, reference), map);
    ASSERT_TRUE(shift) << trial;
    // Fewer pixels than without: four of the uncertainties, which are below 0.03 pixel.
    EXPECT_LT(shift->x_uncertainty.si(), 0.03 * setting.grid.pitch_x.si());
    EXPECT_NEAR(shift->x.si(), view.dx * setting.grid.pitch_x.si(),
                4.0 * shift->x_uncertainty.si());
    EXPECT_NEAR(shift->z.si(), view.dz * setting.grid.pitch_z.si(),
                4.0 * shift->z_uncertainty.si());
  }
}

TEST(FrameTexture, IsFoundOnWholePixelsWithGapsToo) {
  // Where other pixels come into reach on either side of the answer.
  const Setting setting;
  for (std::uint64_t trial = 0; trial < 12; ++trial) {
    RandomStream random(12, "whole pixels", trial);
    const RandomField frame(setting, 50e-9, 2.0, random);
    View view;
    view.dropouts = 0.03;
    const DeflectionMap reference = seen(setting, frame, view, random);
    view.dx = static_cast<double>(random.below(7)) - 3.0;
    const auto shift =
        find_texture_shift(texture_of(setting, reference), seen(setting, frame, view, random));
    ASSERT_TRUE(shift) << trial;
    EXPECT_NEAR(shift->x.si(), view.dx * setting.grid.pitch_x.si(),
                4.0 * shift->x_uncertainty.si());
  }
}

TEST(FrameTexture, IsNeverFoundOnAPolishedFrame) {
  const Setting setting(384, 96);
  for (const double reach : {0.0, 1.0, 2.0, 4.0, 8.0, 16.0}) {
    const std::uint64_t trials = reach > 3.0 ? 25 : 100;
    for (std::uint64_t trial = 0; trial < trials; ++trial) {
      RandomStream random(10, "polished frame", trial);
      const RandomField polished(setting, 0.0, 0.0, random);
      View view;
      view.noise_reach = reach;
      const DeflectionMap reference = seen(setting, polished, view, random);
      EXPECT_FALSE(
          find_texture_shift(texture_of(setting, reference), seen(setting, polished, view, random)))
          << reach << ' ' << trial;
    }
  }
}

TEST(FrameTexture, IsNotFoundWhereTheRimIsTooNarrowOrFlat) {
  const Setting narrow(512, 128, 16.0 * um, 16.0 * um, 8);
  RandomStream random(11, "narrow rim");
  const RandomField frame(narrow, 50e-9, 3.0, random);
  const DeflectionMap map = seen(narrow, frame, {}, random);
  EXPECT_FALSE(find_texture_shift(texture_of(narrow, map), map));

  const Setting setting(384, 96);
  const DeflectionMap flat(setting.grid, Array2::Zero(96, 384), Flags2::Zero(96, 384), Length{});
  EXPECT_FALSE(find_texture_shift(texture_of(setting, flat), flat));
  const DeflectionMap none(setting.grid, Array2::Zero(96, 384), Flags2::Ones(96, 384), Length{});
  EXPECT_FALSE(find_texture_shift(texture_of(setting, none), none));
}

}  // namespace
}  // namespace manoscope::maps

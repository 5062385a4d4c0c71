#include "manoscope/maps/combine_shifts.hpp"

#include <gtest/gtest.h>

#include <Eigen/Cholesky>
#include <cmath>

#include "manoscope/core/random.hpp"
#include "tests/support/synthetic_map.hpp"

namespace manoscope::maps {
namespace {

using Shifts = std::vector<std::optional<OneShift>>;

constexpr double kCommon = 3e-6;  ///< m, of the map of reference

/// Eight maps; the first shows no edges, the second no texture.
struct Maps {
  std::vector<double> truth;
  Shifts edges, texture;

  explicit Maps(std::uint64_t trial) {
    RandomStream random(3, "combine", trial);
    for (int i = 0; i < 8; ++i) {
      truth.push_back(random.uniform(-8e-6, 8e-6));
      const double e = random.uniform(0.1e-6, 0.6e-6), t = random.uniform(0.2e-6, 0.4e-6);
      edges.emplace_back(OneShift{truth.back() + e * random.normal(), e});
      texture.emplace_back(OneShift{truth.back() + kCommon + t * random.normal(), t});
    }
    edges[0].reset();
    texture[1].reset();
  }
};

TEST(CombineShifts, AreThoseOfLeastSquaresForAllMapsAtOnce) {
  const Maps maps(1);
  const auto combined = combine_shifts(maps.edges, maps.texture);
  ASSERT_TRUE(combined.agree);
  // Unknowns: eight shifts and the place of the reference.
  Eigen::MatrixXd normal = Eigen::MatrixXd::Zero(9, 9);
  Eigen::VectorXd right = Eigen::VectorXd::Zero(9);
  const auto add = [&](const std::optional<OneShift>& shift, Eigen::Index map, double common) {
    if (!shift) return;
    Eigen::VectorXd row = Eigen::VectorXd::Zero(9);
    row[map] = 1.0;
    row[8] = common;
    const double weight = 1.0 / (shift->uncertainty * shift->uncertainty);
    normal += weight * row * row.transpose();
    right += weight * shift->value * row;
  };
  for (std::size_t i = 0; i < 8; ++i) {
    add(maps.edges[i], static_cast<Eigen::Index>(i), 0.0);
    add(maps.texture[i], static_cast<Eigen::Index>(i), 1.0);
  }
  const Eigen::MatrixXd covariance = normal.ldlt().solve(Eigen::MatrixXd::Identity(9, 9));
  const Eigen::VectorXd solved = covariance * right;
  for (std::size_t i = 0; i < 8; ++i) {
    const auto k = static_cast<Eigen::Index>(i);
    ASSERT_TRUE(combined.shifts[i]);
    EXPECT_NEAR(combined.shifts[i]->value, solved[k], 1e-15);  // round-off of micrometres
    EXPECT_NEAR(combined.shifts[i]->uncertainty, std::sqrt(covariance(k, k)), 1e-15);
  }
}

TEST(CombineShifts, HaveErrorBarsThatHold) {
  test_support::Pulls pulls;
  for (std::uint64_t trial = 0; trial < 200; ++trial) {
    const Maps maps(trial);
    const auto combined = combine_shifts(maps.edges, maps.texture);
    for (std::size_t i = 0; i < 8; ++i) {
      pulls.add((combined.shifts[i]->value - maps.truth[i]) / combined.shifts[i]->uncertainty);
    }
  }
  // 1600 of them, of one trial correlated by the common place: three sigma of 400.
  EXPECT_NEAR(pulls.width(), 1.0, 3.0 / std::sqrt(2.0 * 400.0));
}

TEST(CombineShifts, KeepTheEdgeOfAMapWhoseTextureSaysOtherwise) {
  Maps maps(2);
  maps.texture[4]->value += 5e-6;
  const auto combined = combine_shifts(maps.edges, maps.texture);
  EXPECT_TRUE(combined.agree);
  EXPECT_EQ(combined.shifts[4]->value, maps.edges[4]->value);
  EXPECT_NEAR(combined.shifts[0]->value, maps.truth[0], 1e-6);  // three of its uncertainty
}

TEST(CombineShifts, LeaveOutATextureThatNeverMoves) {
  Maps maps(3);
  for (auto& shift : maps.texture) {
    if (shift) shift->value = 0.0;
  }
  const auto combined = combine_shifts(maps.edges, maps.texture);
  EXPECT_FALSE(combined.agree);
  EXPECT_FALSE(combined.shifts[0]);
  for (std::size_t i = 1; i < 8; ++i) {
    EXPECT_EQ(combined.shifts[i]->value, maps.edges[i]->value);
  }
}

TEST(CombineShifts, HeedNoTextureThatTooFewEdgesVouchFor) {
  Maps maps(4);
  for (std::size_t i = 4; i < 8; ++i) maps.edges[i].reset();  // 2 and 3 remain to compare
  const auto combined = combine_shifts(maps.edges, maps.texture);
  EXPECT_TRUE(combined.agree);
  EXPECT_FALSE(combined.shifts[0]);
  EXPECT_EQ(combined.shifts[2]->value, maps.edges[2]->value);
}

}  // namespace
}  // namespace manoscope::maps

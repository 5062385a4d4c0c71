#include "manoscope/calibration/shape_nodes.hpp"

#include <gtest/gtest.h>

#include <cmath>

namespace manoscope::calibration {
namespace {

std::vector<ShapeLevel> numbered(const std::vector<double>& averages) {
  std::vector<ShapeLevel> levels;
  for (const double average : averages) {
    levels.push_back({static_cast<Index>(levels.size()), average});
  }
  return levels;
}

double sum(const std::vector<double>& weights, const std::vector<double>& values) {
  double total = 0.0;
  for (std::size_t i = 0; i < weights.size(); ++i) total += weights[i] * values[i];
  return total;
}

using Nodes = std::vector<Index>;

TEST(ShapeNodes, StandOnBothSides) {
  const auto levels = numbered({0.0, 1.0, 2.0, 3.0, 4.0, 5.0});
  EXPECT_EQ(shape_nodes(levels, 2.4), (Nodes{1, 2, 3, 4}));
  EXPECT_EQ(shape_nodes(levels, 2.0), (Nodes{1, 2, 3, 4}));
  EXPECT_EQ(shape_nodes(levels, 0.4), (Nodes{0, 1, 2, 3}));
  EXPECT_EQ(shape_nodes(levels, 5.0), (Nodes{2, 3, 4, 5}));
  EXPECT_EQ(shape_nodes(numbered({0.0, 1.0, 2.0}), 0.4), (Nodes{0, 1, 2}));
}

TEST(ShapeNodes, AreNotThereOutsideTheLevelsOrAmongTooFew) {
  EXPECT_TRUE(shape_nodes(numbered({0.0, 1.0, 2.0, 3.0}), 3.1).empty());
  EXPECT_TRUE(shape_nodes(numbered({0.0, 1.0, 2.0, 3.0}), -0.1).empty());
  EXPECT_TRUE(shape_nodes(numbered({0.0, 1.0}), 0.5).empty());
  EXPECT_TRUE(shape_nodes({}, 0.5).empty());
  EXPECT_TRUE(shape_nodes(numbered({1.0, 1.0, 1.0}), 1.0).empty());
}

TEST(ShapeNodes, KeepTheirDistance) {
  // The repeat of the level at 1 would blow noise up.
  EXPECT_EQ(shape_nodes(numbered({0.0, 0.99, 1.0, 2.0, 2.01, 3.0}), 1.5), (Nodes{0, 2, 3, 5}));
  // Between the two repeats there is nothing to interpolate over.
  EXPECT_EQ(shape_nodes(numbered({0.0, 0.99, 1.0, 2.0}), 0.995), (Nodes{0, 1, 2, 3}));
}

TEST(ShapeNodes, LetLevelsThatCannotBeToldApartChangePlaces) {
  EXPECT_EQ(shape_nodes(numbered({0.0, 1.05, 1.0, 2.0, 3.0, 4.0}), 2.5), (Nodes{1, 3, 4, 5}));
}

TEST(ShapeNodes, HaveNoAnswerWhereAWallHasSeveralShapes) {
  const auto snapping = numbered({0.0, 1.0, 3.0, 2.0, 4.0, 5.0, 6.0, 7.0, 8.0});
  EXPECT_TRUE(shape_nodes(snapping, 2.5).empty());
  EXPECT_TRUE(shape_nodes(snapping, 3.5).empty());  // a node lies across
  EXPECT_EQ(shape_nodes(snapping, 5.5), (Nodes{4, 5, 6, 7}));
}

TEST(NodeWeights, ReproduceCubicsAndTheirGrowth) {
  const std::vector<double> places{-1.0, 0.3, 1.1, 2.0};
  const auto cubic = [](double t) { return 1.0 - 2.0 * t + 0.5 * t * t + 3.0 * t * t * t; };
  std::vector<double> values, squares;
  for (const double place : places) {
    values.push_back(cubic(place));
    squares.push_back(place * place);
  }
  for (const double at : {-1.2, 0.0, 0.3, 0.7, 1.9}) {
    const NodeWeights weights = node_weights(places, at);
    EXPECT_NEAR(sum(weights.weight, values), cubic(at), 1e-13);  // round-off
    EXPECT_NEAR(sum(weights.growth, values), -2.0 + at + 9.0 * at * at, 1e-12);
    // Parabolas are the same with one node fewer; of a cubic the difference is the last term of
    // Newton's form.
    EXPECT_NEAR(sum(weights.other_low, squares), 0.0, 1e-13);
    EXPECT_NEAR(sum(weights.other_high, squares), 0.0, 1e-13);
    EXPECT_NEAR(sum(weights.other_low, values), 3.0 * (at + 1.0) * (at - 0.3) * (at - 1.1), 1e-12);
    EXPECT_NEAR(sum(weights.other_high, values), 3.0 * (at - 0.3) * (at - 1.1) * (at - 2.0), 1e-12);
  }
}

}  // namespace
}  // namespace manoscope::calibration

#include "manoscope/calibration/shape_nodes.hpp"

#include <algorithm>
#include <utility>

namespace manoscope::calibration {
namespace {

using Values = std::vector<double>;

constexpr double kUnrealFall = 0.02;  // of the range of the averages
constexpr double kApart = 0.5;        // of the distance of the inner two

/// Lagrange's weights at `at`.
Values lagrange(const Values& nodes, double at) {
  Values weights(nodes.size(), 1.0);
  for (std::size_t i = 0; i < nodes.size(); ++i) {
    for (std::size_t k = 0; k < nodes.size(); ++k) {
      if (k != i) weights[i] *= (at - nodes[k]) / (nodes[i] - nodes[k]);
    }
  }
  return weights;
}

/// Their derivatives.
Values lagrange_growth(const Values& nodes, double at) {
  Values growth(nodes.size(), 0.0);
  for (std::size_t i = 0; i < nodes.size(); ++i) {
    for (std::size_t without = 0; without < nodes.size(); ++without) {
      if (without == i) continue;
      double term = 1.0 / (nodes[i] - nodes[without]);
      for (std::size_t k = 0; k < nodes.size(); ++k) {
        if (k != i && k != without) term *= (at - nodes[k]) / (nodes[i] - nodes[k]);
      }
      growth[i] += term;
    }
  }
  return growth;
}

/// Weights of all nodes minus those without the node `out`.
Values difference_without(const Values& nodes, double at, std::size_t out) {
  Values difference = lagrange(nodes, at);
  Values fewer = nodes;
  fewer.erase(fewer.begin() + static_cast<Index>(out));
  const Values other = lagrange(fewer, at);
  for (std::size_t i = 0, k = 0; i < nodes.size(); ++i) {
    if (i != out) difference[i] -= other[k++];
  }
  return difference;
}

/// Ranges of averages that the wall passes more than once.
std::vector<std::pair<double, double>> folds(const std::vector<ShapeLevel>& levels, double range) {
  std::vector<std::pair<double, double>> found;
  double highest = levels.front().average;
  for (const ShapeLevel& level : levels) {
    highest = std::max(highest, level.average);
    if (highest - level.average > kUnrealFall * range) found.emplace_back(level.average, highest);
  }
  return found;
}

/// The next level beyond `from`, going by `step`, at least `apart` away; -1: none.
Index next_level(const std::vector<ShapeLevel>& levels, Index from, Index step, double apart) {
  const auto n = static_cast<Index>(levels.size());
  const auto average = [&](Index i) { return levels[static_cast<std::size_t>(i)].average; };
  for (Index i = from + step; i >= 0 && i < n; i += step) {
    if (static_cast<double>(step) * (average(i) - average(from)) >= apart) return i;
  }
  return -1;
}

/// Indices of the nodes around the interval that begins at `k`, ascending.
std::vector<Index> choose(const std::vector<ShapeLevel>& levels, Index k) {
  const auto at = [&](Index i) { return levels[static_cast<std::size_t>(i)].average; };
  const double apart = kApart * (at(k + 1) - at(k));
  const Index low = next_level(levels, k, -1, apart);
  const Index high = next_level(levels, k + 1, 1, apart);
  std::vector<Index> chosen{k, k + 1};
  if (low >= 0) chosen.insert(chosen.begin(), low);
  if (high >= 0) chosen.push_back(high);
  if (low < 0 && high >= 0) {
    if (const Index more = next_level(levels, high, 1, apart); more >= 0) chosen.push_back(more);
  }
  if (high < 0 && low >= 0) {
    const Index more = next_level(levels, low, -1, apart);
    if (more >= 0) chosen.insert(chosen.begin(), more);
  }
  return chosen;
}

}  // namespace

std::vector<Index> shape_nodes(const std::vector<ShapeLevel>& levels, double average) {
  constexpr std::size_t kFewest = 3;
  if (levels.size() < kFewest) return {};
  std::vector<ShapeLevel> sorted = levels;
  std::stable_sort(sorted.begin(), sorted.end(),
                   [](const auto& a, const auto& b) { return a.average < b.average; });
  const double lowest = sorted.front().average, highest = sorted.back().average;
  if (!(average >= lowest && average <= highest)) return {};
  Index k = 0;
  while (k + 2 < static_cast<Index>(sorted.size()) &&
         sorted[static_cast<std::size_t>(k + 1)].average <= average) {
    ++k;
  }
  const auto at = [&](Index i) { return sorted[static_cast<std::size_t>(i)]; };
  const std::vector<Index> chosen = choose(sorted, k);
  if (chosen.size() < kFewest || !(at(k + 1).average > at(k).average)) return {};
  for (const auto& [from, to] : folds(levels, highest - lowest)) {
    if (from < at(chosen.back()).average && to > at(chosen.front()).average) return {};
  }
  std::vector<Index> nodes;
  for (const Index i : chosen) nodes.push_back(at(i).level);
  return nodes;
}

NodeWeights node_weights(const std::vector<double>& places, double at) {
  return {lagrange(places, at), lagrange_growth(places, at),
          difference_without(places, at, places.size() - 1), difference_without(places, at, 0)};
}

}  // namespace manoscope::calibration

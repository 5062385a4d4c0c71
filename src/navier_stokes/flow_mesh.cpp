#include "flow_mesh.hpp"

#include <algorithm>
#include <cmath>
#include <numbers>

namespace manoscope::navier_stokes {
namespace {

/// n cells over [0, 1], those at both ends 1 - strength times the mean.
std::vector<double> finer_at_both_ends(int n, double strength) {
  constexpr double kTurn = 2.0 * std::numbers::pi;
  std::vector<double> edges;
  for (int i = 0; i <= n; ++i) {
    const double s = static_cast<double>(i) / n;
    edges.push_back(s - strength * std::sin(kTurn * s) / kTurn);
  }
  edges.front() = 0.0;
  edges.back() = 1.0;
  return edges;
}

/// Distances from 0 to `length` of cells that grow from about `first`.
std::vector<double> growing(double length, double first, int n_channel) {
  std::vector<double> distances;
  if (length <= 0.0) return distances;
  const double growth = 1.0 + 24.0 / std::max(n_channel, 24);  // less on finer meshes
  double step = first, distance = 0.0;
  while (distance < length) {
    distance += step;
    distances.push_back(distance);
    step *= growth;
  }
  for (double& d : distances) d *= length / distance;
  distances.back() = length;
  return distances;
}

}  // namespace

std::vector<double> edges_along(double length, double lead_in, double lead_out, int n) {
  constexpr double kStrength = 0.85;
  std::vector<double> channel = finer_at_both_ends(n, kStrength);
  for (double& x : channel) x *= length;
  const double first = channel[1];
  std::vector<double> before = growing(lead_in, first, n);
  std::reverse(before.begin(), before.end());
  std::vector<double> edges;
  for (const double distance : before) edges.push_back(-distance);
  edges.insert(edges.end(), channel.begin(), channel.end());
  for (const double distance : growing(lead_out, first, n)) edges.push_back(length + distance);
  return edges;
}

std::vector<double> edges_up(int n) {
  constexpr double kStrength = 0.5;
  return finer_at_both_ends(n, kStrength);
}

std::vector<double> edges_across(double half_width, int n) {
  constexpr double kStrength = 0.6;
  std::vector<double> edges;
  for (int i = 0; i <= n; ++i) {
    const double s = static_cast<double>(i) / n;
    edges.push_back(half_width *
                    ((1.0 - kStrength) * s + kStrength * std::sin(0.5 * std::numbers::pi * s)));
  }
  edges.back() = half_width;
  return edges;
}

}  // namespace manoscope::navier_stokes

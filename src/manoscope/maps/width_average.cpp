#include "manoscope/maps/width_average.hpp"

#include <fmt/format.h>

#include <Eigen/Cholesky>
#include <cmath>
#include <optional>
#include <vector>

#include "manoscope/core/error.hpp"
#include "manoscope/core/flags.hpp"

namespace manoscope::maps {
namespace {

struct Node {
  double z, zeta, weight;
  bool measured;  ///< false for the clamped edge itself
};

struct ColumnAverage {
  double zeta = 0.0;      ///< m
  double measured = 0.0;  ///< share of the weights that pixels carry, not the clamped edge
  double mean_z = 0.0;    ///< m, where the weights of the pixels balance, times `measured`
  double variance = 0.0;  ///< m2
};

/// Adds to both nodes what the line between them contributes to the integral over [low, high].
void integrate_between(Node& a, Node& b, double low, double high) {
  if (a.z >= low && b.z <= high) {
    const double half = 0.5 * (b.z - a.z);
    a.weight += half;
    b.weight += half;
    return;
  }
  const double from = std::max(a.z, low), to = std::min(b.z, high), length = b.z - a.z;
  if (to <= from) return;
  const double middle = (0.5 * (from + to) - a.z) / length;  // the line's value at the centre
  a.weight += (to - from) * (1.0 - middle);
  b.weight += (to - from) * middle;
}

/// Columns of a map side by side with their rows, a few at a time: a column of a row-major map is
/// scattered over memory.
class ColumnWindow {
 public:
  explicit ColumnWindow(const DeflectionMap& map)
      : map_(map), zeta_(kColumns, map.grid().nz), flags_(kColumns, map.grid().nz) {}

  void move_to(Index ix) {
    if (ix >= first_ && ix < first_ + kColumns) return;
    first_ = ix;
    const Index n = std::min(kColumns, map_.grid().nx - ix);
    for (Index iz = 0; iz < map_.grid().nz; ++iz) {
      for (Index k = 0; k < n; ++k) {
        zeta_(k, iz) = map_.zeta()(iz, ix + k);
        flags_(k, iz) = map_.flags()(iz, ix + k);
      }
    }
  }
  double zeta(Index iz, Index ix) const { return zeta_(ix - first_, iz); }
  FlagBits flags(Index iz, Index ix) const { return flags_(ix - first_, iz); }

 private:
  static constexpr Index kColumns = 8;
  const DeflectionMap& map_;
  Index first_ = -kColumns;
  Array2 zeta_;
  Flags2 flags_;
};

/// @param nodes  work space.
std::optional<ColumnAverage> average_column(const DeflectionMap& map, const ColumnWindow& window,
                                            Index ix, double width,
                                            const WidthAverageOptions& options,
                                            std::vector<Node>& nodes) {
  const ChannelGrid& grid = map.grid();
  const double half = 0.5 * width, pitch = grid.pitch_z.si();
  const Node edge_below{-half, 0.0, 0.0, false}, edge_above{half, 0.0, 0.0, false};
  nodes.assign(1, edge_below);
  std::optional<Node> below, above;
  for (Index iz = 0; iz < grid.nz; ++iz) {
    if (window.flags(iz, ix) != 0) continue;
    const double z = grid.z(iz);
    if (z > -half && z < half) {
      nodes.push_back({z, window.zeta(iz, ix), 0.0, true});
      continue;
    }
    (z < 0.0 ? below : above) = Node{z, window.zeta(iz, ix), 0.0, true};
    if (above) break;
  }
  const auto inside = static_cast<double>(nodes.size() - 1);
  if (inside == 0.0 || inside * pitch / width < options.smallest_coverage) return std::nullopt;
  // Beyond the edges: the pixel next door, or the clamped edge itself where that one is missing.
  const double next_door = 1.5 * pitch;
  if (below && nodes[1].z - below->z < next_door) nodes.front() = *below;
  nodes.push_back(above && above->z - nodes.back().z < next_door ? *above : edge_above);

  const double largest_gap = std::max(options.largest_gap * width, 2.5 * pitch);
  for (std::size_t i = 1; i < nodes.size(); ++i) {
    if (nodes[i].z - nodes[i - 1].z > largest_gap) return std::nullopt;
    integrate_between(nodes[i - 1], nodes[i], -half, half);
  }
  ColumnAverage result;
  double noise_gain = 0.0;
  const double per_width = 1.0 / width;
  for (const Node& node : nodes) {
    const double weight = node.weight * per_width;
    result.zeta += weight * node.zeta;
    if (!node.measured) continue;
    result.measured += weight;
    result.mean_z += weight * node.z;
    noise_gain += weight * weight;
  }
  result.variance = noise_gain * map.noise().si() * map.noise().si() * map.noise_length_z();
  // A parabola of this mean sags by curvature gap^3 / 12 below the chord of a gap.
  const double curvature = 12.0 * std::abs(result.zeta) / (width * width);
  for (std::size_t i = 1; i < nodes.size(); ++i) {
    const double gap = nodes[i].z - nodes[i - 1].z;
    if (gap < 1.5 * pitch) continue;
    const double sag = curvature * gap * gap * gap / 12.0 / width;
    result.variance += sag * sag;
  }
  return result;
}

}  // namespace

void WidthAverageOptions::validate() const {
  if (!(largest_gap > 0.0 && largest_gap <= 1.0)) {
    throw InputError("--largest-gap", fmt::format("is {}", largest_gap),
                     "Give a share of the width in (0, 1]");
  }
  if (!(smallest_coverage > 0.0 && smallest_coverage <= 1.0)) {
    throw InputError("--smallest-coverage", fmt::format("is {}", smallest_coverage),
                     "Give a share of the width in (0, 1]");
  }
}

Profile width_average(const DeflectionMap& map, const RimPlane& plane, Length channel_length,
                      Length channel_width, const std::string& name,
                      const WidthAverageOptions& options) {
  options.validate();
  const ChannelGrid& grid = map.grid();
  std::vector<Index> columns;
  for (Index ix = 0; ix < grid.nx; ++ix) {
    if (grid.x(ix) >= 0.0 && grid.x(ix) <= channel_length.si()) columns.push_back(ix);
  }
  const auto n = static_cast<Index>(columns.size());
  if (n < 2) {
    throw InputError(name, fmt::format("{} columns of the map lie inside the channel", n),
                     "Check channel.origin, length and flow against the map");
  }
  Profile profile;
  profile.x = Array1(n);
  profile.zeta = Array1::Zero(n);
  profile.flags = Flags1::Zero(n);
  profile.uncertainty.independent = Array1::Zero(n);
  Matrix design = Matrix::Zero(n, 3);
  ColumnWindow window(map);
  std::vector<Node> nodes;
  for (Index i = 0; i < n; ++i) {
    const Index ix = columns[static_cast<std::size_t>(i)];
    profile.x[i] = grid.x(ix);
    window.move_to(ix);
    const auto column = average_column(map, window, ix, channel_width.si(), options, nodes);
    if (!column) {
      profile.flags[i] = StationFlag::no_data;
      continue;
    }
    profile.zeta[i] = column->zeta;
    profile.uncertainty.independent[i] = std::sqrt(column->variance);
    design.row(i) << column->measured, column->measured * (profile.x[i] - plane.x_centre),
        column->mean_z;
  }
  // The trapezoid rule takes zeta (pitch / width)^2 off a parabola: the same share of every profile
  // on this grid, hence one error variable for all of them, which cancels where profiles are
  // compared.
  const double lost = std::pow(grid.pitch_z / channel_width, 2);
  profile.uncertainty.modes.push_back(
      {"quadrature across the width", "quadrature", profile.zeta * lost});
  if (plane.covariance(0, 0) <= 0.0) return profile;  // a noise-free rim knows its plane
  const Eigen::Matrix3d root = plane.covariance.llt().matrixL();
  const Matrix effects = design * root;
  for (Index k = 0; k < 3; ++k) {
    profile.uncertainty.modes.push_back(
        {fmt::format("level plane of {}, {}", name, k + 1), "leveling", effects.col(k).array()});
  }
  return profile;
}

}  // namespace manoscope::maps

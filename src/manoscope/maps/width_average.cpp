#include "manoscope/maps/width_average.hpp"

#include <fmt/format.h>

#include <Eigen/Cholesky>
#include <algorithm>
#include <cmath>
#include <cstdint>
#include <cstring>
#include <optional>
#include <vector>

#include "manoscope/core/error.hpp"
#include "manoscope/core/flags.hpp"
#include "manoscope/maps/column_weights.hpp"

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
  double mean_z2 = 0.0;   ///< m2, as mean_z of z squared; not formed by RowwiseAverage
};

/// @param middle  of the wall in this column: z of the result counts from there.
/// @param nodes   work space.
std::optional<ColumnAverage> average_column(const DeflectionMap& map, Index ix, double middle,
                                            double width, const WidthAverageOptions& options,
                                            std::vector<Node>& nodes) {
  const ChannelGrid& grid = map.grid();
  const double half = 0.5 * width, pitch = grid.pitch_z.si();
  const Node edge_below{-half, 0.0, 0.0, false}, edge_above{half, 0.0, 0.0, false};
  nodes.assign(1, edge_below);
  std::optional<Node> below, above;
  for (Index iz = 0; iz < grid.nz; ++iz) {
    if (map.flags()(iz, ix) != 0) continue;
    const double z = grid.z(iz) - middle;
    if (z > -half && z < half) {
      nodes.push_back({z, map.zeta()(iz, ix), 0.0, true});
      continue;
    }
    (z < 0.0 ? below : above) = Node{z, map.zeta()(iz, ix), 0.0, true};
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
    const auto [lower, upper] = line_weights(nodes[i - 1].z, nodes[i].z, -half, half);
    nodes[i - 1].weight += lower;
    nodes[i].weight += upper;
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
    result.mean_z2 += weight * node.z * node.z;
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

/// Averages all columns side by side, row by row as they lie in memory: first as if every pixel
/// were good, the bad ones counting 0, then column by column what a gap changes.
class RowwiseAverage {
 public:
  RowwiseAverage(const DeflectionMap& map, Index first_column, Index n_columns, double width)
      : map_(map), width_(width), full_(map.grid(), width), first_column_(first_column) {
    if (!full_.exist) return;
    zeta_ = Array1::Zero(n_columns);
    bad_.resize(static_cast<std::size_t>(n_columns));
    Array1 row(n_columns);
    for (Index iz = full_.first; iz <= full_.last; ++iz) {
      row = map.zeta().row(iz).segment(first_column, n_columns).transpose();
      take_out_bad(iz, row);
      zeta_ += full_.of(iz) * row;
    }
  }

  /// @return nothing if the column's edges need the general rule, or it does not count.
  std::optional<ColumnAverage> column(Index i, const WidthAverageOptions& options) const {
    if (!full_.exist) return std::nullopt;
    const ChannelGrid& grid = map_.grid();
    const double pitch = grid.pitch_z.si();
    const std::vector<Index>& bad = bad_[static_cast<std::size_t>(i)];
    const Index n_inside = full_.last - full_.first - 1 - static_cast<Index>(bad.size());
    if (static_cast<double>(n_inside) * pitch / width_ < options.smallest_coverage) {
      return std::nullopt;
    }
    const double largest_gap = std::max(options.largest_gap * width_, 2.5 * pitch);
    double zeta = zeta_[i];
    ColumnGaps gaps;
    for (std::size_t k = 0; k < bad.size();) {
      const Index lower = bad[k] - 1;
      Index upper = bad[k] + 1;
      for (++k; k < bad.size() && bad[k] == upper; ++k) ++upper;
      if (lower <= full_.first || upper >= full_.last) return std::nullopt;
      if (grid.z(upper) - grid.z(lower) > largest_gap) return std::nullopt;
      const double by = gaps.close(full_, grid, lower, upper, width_);
      zeta += by * (map_.zeta()(lower, first_column_ + i) + map_.zeta()(upper, first_column_ + i));
    }
    const double noise = map_.noise().si();
    // A parabola of this mean sags by curvature gap^3 / 12 below the chord of a gap.
    const double sag = zeta / (width_ * width_ * width_);
    return ColumnAverage{zeta, full_.sum + gaps.measured, full_.mean_z + gaps.mean_z,
                         (full_.squares + gaps.squares) * noise * noise * map_.noise_length_z() +
                             sag * sag * gaps.sixth};
  }

 private:
  void take_out_bad(Index iz, Array1& row) {
    const FlagBits* const flags = &map_.flags()(iz, first_column_);
    for (Index i = 0; i < row.size();) {
      std::uint64_t eight = 0;
      const Index n = std::min<Index>(8, row.size() - i);
      std::memcpy(&eight, flags + i, static_cast<std::size_t>(n));
      for (Index k = i; eight != 0 && k < i + n; ++k) {
        if (flags[k] == 0) continue;
        row[k] = 0.0;
        bad_[static_cast<std::size_t>(k)].push_back(iz);
      }
      i += n;
    }
  }

  const DeflectionMap& map_;
  double width_;
  ColumnWeights full_;
  Index first_column_;
  Array1 zeta_;
  std::vector<std::vector<Index>> bad_;  ///< rows, ascending, a column
};

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

namespace {

/// The trapezoid rule takes zeta (pitch / width)^2 off a parabola: the same share of every profile
/// on this grid, hence one error variable for all of them, which cancels where profiles are
/// compared.
void add_quadrature_mode(Profile& profile, double pitch_over_width) {
  profile.uncertainty.modes.push_back({"quadrature across the width", "quadrature",
                                       profile.zeta * (pitch_over_width * pitch_over_width)});
}

/// Errors of a surface of second order, one mode a term.
/// @param measured, mean_z, mean_z2  (n) as in ColumnAverage, z from the frame's own axis.
void add_bend_modes(Profile& profile, const RimBend& bend, const Array1& measured,
                    const Array1& mean_z, const Array1& mean_z2, const std::string& name) {
  const Array1 u = (profile.x - bend.x_centre) / bend.reach_x;
  const double v = 1.0 / bend.reach_z;
  Matrix design(profile.x.size(), 6);
  design.col(0) = measured;
  design.col(1) = measured * u;
  design.col(2) = mean_z * v;
  design.col(3) = measured * u * u;
  design.col(4) = u * mean_z * v;
  design.col(5) = mean_z2 * v * v;
  const Matrix effects = design * Matrix(Matrix(bend.covariance).llt().matrixL());
  for (Index k = 0; k < effects.cols(); ++k) {
    profile.uncertainty.modes.push_back(
        {fmt::format("level plane of {}, {}", name, k + 1), "leveling", effects.col(k).array()});
  }
}

}  // namespace

void add_shared_modes(Profile& profile, const RimPlane& plane, const Array1& measured,
                      const Array1& mean_z, double pitch_over_width, const std::string& name) {
  add_quadrature_mode(profile, pitch_over_width);
  if (plane.covariance(0, 0) <= 0.0) return;  // a noise-free rim knows its plane
  const Eigen::Matrix3d root = plane.covariance.llt().matrixL();
  const Array1 along = measured * (profile.x - plane.x_centre);
  for (Index k = 0; k < 3; ++k) {
    profile.uncertainty.modes.push_back(
        {fmt::format("level plane of {}, {}", name, k + 1), "leveling",
         root(0, k) * measured + root(1, k) * along + root(2, k) * mean_z});
  }
}

Profile width_average(const DeflectionMap& map, const RimPlane& plane, Length channel_length,
                      Length channel_width, const std::string& name,
                      const WidthAverageOptions& options, const CentreLine& centre,
                      const RimBend* bend) {
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
  Array1 measured = Array1::Zero(n), mean_z = Array1::Zero(n), mean_z2 = Array1::Zero(n);
  const bool straight = centre.farthest(channel_length.si()) == 0.0 && bend == nullptr;
  std::optional<RowwiseAverage> rowwise;  // of a wall that lies along the rows
  if (straight) rowwise.emplace(map, columns.front(), n, channel_width.si());
  std::vector<Node> nodes;
  for (Index i = 0; i < n; ++i) {
    const Index ix = columns[static_cast<std::size_t>(i)];
    profile.x[i] = grid.x(ix);
    std::optional<ColumnAverage> column;
    if (rowwise) column = rowwise->column(i, options);
    const double middle = centre.z(profile.x[i], channel_length.si());
    if (!column) column = average_column(map, ix, middle, channel_width.si(), options, nodes);
    if (!column) {
      profile.flags[i] = StationFlag::no_data;
      continue;
    }
    profile.zeta[i] = column->zeta;
    profile.uncertainty.independent[i] = std::sqrt(column->variance);
    measured[i] = column->measured;
    // Back from the wall's middle to the axis that the plane counts from.
    mean_z[i] = column->mean_z + column->measured * middle;
    mean_z2[i] = column->mean_z2 + middle * (2.0 * mean_z[i] - column->measured * middle);
  }
  if (bend != nullptr && bend->covariance(0, 0) > 0.0) {
    add_quadrature_mode(profile, grid.pitch_z / channel_width);
    add_bend_modes(profile, *bend, measured, mean_z, mean_z2, name);
    return profile;
  }
  add_shared_modes(profile, plane, measured, mean_z, grid.pitch_z / channel_width, name);
  return profile;
}

}  // namespace manoscope::maps

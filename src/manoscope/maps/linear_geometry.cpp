#include "manoscope/maps/linear_geometry.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>

#include "manoscope/core/error.hpp"
#include "manoscope/maps/reduce.hpp"

namespace manoscope::maps {

LinearReducer::Geometry::Geometry(const CameraGrid& map, const ChannelFrame& frame,
                                  const std::string& name, const LinearReductionOptions& given)
    : camera(map),
      grid(in_pixel_order(map, frame)),
      width(frame.width.si()),
      flow(frame.flow_sign()),
      across(frame.across_sign()),
      outward(frame.outward == Outward::plus_height ? 1.0 : -1.0),
      weights(grid, frame.width.si()),
      options(given.width) {
  const ChannelGrid ascending = channel_grid(map, frame);
  const Length margin = given.rim_margin.value_or(auto_rim_margin(ascending, frame));
  const double length = frame.length.si(), beside = 0.5 * width + margin.si();
  x.resize(grid.nx);
  for (Index ix = 0; ix < grid.nx; ++ix) {
    x[ix] = ascending.x(flow > 0.0 ? ix : grid.nx - 1 - ix);
  }
  x_centre = 0.5 * (x[0] + x[grid.nx - 1]);
  scale_x = std::max(0.5 * std::abs(x[grid.nx - 1] - x[0]), 1e-12);
  scale_z = std::max({std::abs(grid.z(0)), std::abs(grid.z(grid.nz - 1)), 1e-12});
  a = (x - x_centre) / scale_x;
  b.resize(grid.nz);
  for (Index iz = 0; iz < grid.nz; ++iz) b[iz] = grid.z(iz) / scale_z;

  const auto is_inside = [&](double at) { return at >= 0.0 && at <= length; };
  while (first < grid.nx && !is_inside(x[first])) ++first;
  end = first;
  while (end < grid.nx && is_inside(x[end])) ++end;
  if (end - first < 2) {
    throw InputError(name, fmt::format("{} columns of the map lie inside the channel", end - first),
                     "Check channel.origin, length and flow against the map");
  }
  if (!weights.exist) {
    throw InputError(name, "does not show both edges of the channel",
                     "Check channel.origin and width against the map");
  }
  const auto is_beyond = [&](double at) {
    return at <= -margin.si() || at >= length + margin.si();
  };
  while (left < grid.nx && is_beyond(x[left])) ++left;
  right = grid.nx;
  while (right > left && is_beyond(x[right - 1])) --right;
  while (rim_below < grid.nz && grid.z(rim_below) <= -beside) ++rim_below;
  rim_above = grid.nz;
  while (rim_above > rim_below && grid.z(rim_above - 1) >= beside) --rim_above;

  const auto row = [&](Index from, Index to) {  // n, sum a, sum a^2 of the columns
    const Array1 part = a.segment(from, to - from);
    return Eigen::Vector3d(static_cast<double>(to - from), part.sum(), part.square().sum());
  };
  const Eigen::Vector3d whole = row(0, grid.nx), ends = row(0, left) + row(right, grid.nx);
  normal.setZero();
  for (Index iz = 0; iz < grid.nz; ++iz) {
    const Eigen::Vector3d& sums = iz < rim_below || iz >= rim_above ? whole : ends;
    normal += normal_matrix(sums[0], sums[1], sums[0] * b[iz], sums[2], sums[1] * b[iz],
                            sums[0] * b[iz] * b[iz]);
  }

  // The two outer rows on either side share an interval that an edge cuts.
  inner_begin = weights.first + 2;
  inner_end = weights.last - 1;
  inner_weight = grid.pitch_z.si() / width;
  const auto words = [&](const auto& holds) {
    std::vector<std::uint64_t> of_columns(
        static_cast<std::size_t>((grid.nx + numerics::kLanes - 1) / numerics::kLanes));
    for (Index ix = 0; ix < grid.nx; ++ix) {
      constexpr std::uint64_t kEveryByte = 0x0101010101010101;
      if (!holds(ix)) continue;
      of_columns[static_cast<std::size_t>(ix / numerics::kLanes)] |= kEveryByte
                                                                     << ix % numerics::kLanes;
    }
    return of_columns;
  };
  inside = words([&](Index ix) { return ix >= first && ix < end; });
  in_map = words([](Index) { return true; });
  beyond_ends = words([&](Index ix) { return ix < left || ix >= right; });
}

Index LinearReducer::Geometry::rows_alike(Index iz) const {
  Index next = grid.nz;
  for (const Index change :
       {rim_below, rim_above, weights.first, inner_begin, inner_end, weights.last + 1}) {
    if (change > iz) next = std::min(next, change);
  }
  return next - iz;
}

}  // namespace manoscope::maps

#include "manoscope/io/point_grid.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <limits>
#include <vector>

#include "manoscope/core/error.hpp"
#include "manoscope/io/file_units.hpp"

namespace manoscope::io {
namespace {

constexpr double kRounding = 0.05;  ///< of the pitch

/// Differences below this part of the whole range are round-off of 32-bit coordinates.
constexpr double kSame = 1e-6;

constexpr const char* kNotEven =
    "Only maps with evenly spaced pixels are read; resample the points to a grid";

bool is_position(double value) { return std::isfinite(value) && std::abs(value) < kLargestValue; }

struct Axis {
  double first = 0.0, pitch = 0.0;
  Index n = 1;
};

Axis axis_of(NumberView positions, char name, const std::string& where) {
  std::vector<double> sorted(positions.size());
  for (std::size_t i = 0; i < sorted.size(); ++i) sorted[i] = positions[i];
  std::sort(sorted.begin(), sorted.end());
  Axis axis;
  axis.first = sorted.front();
  const double range = sorted.back() - sorted.front();
  if (!(range > 0.0)) return axis;
  // Most steps between neighbours are of one pitch; a step of several passes over absent lines.
  double least = range;
  std::size_t n_lines = 1;
  for (std::size_t i = 1; i < sorted.size(); ++i) {
    const double step = sorted[i] - sorted[i - 1];
    if (step > kSame * range) {
      least = std::min(least, step);
      ++n_lines;
    }
  }
  const double n_steps = std::round(range / least);
  // Rounded coordinates make the least step too small; the number of lines then tells better.
  const auto lines_apart = static_cast<double>(n_lines - 1);
  const double used =
      std::abs(lines_apart * least / range - 1.0) < 2.0 * kRounding ? lines_apart : n_steps;
  if (used > 4.0 * static_cast<double>(n_lines) + 16.0) {
    throw InputError(where,
                     fmt::format("its {} coordinates are not evenly spaced: {} different ones, the "
                                 "nearest {:.4g} apart over {:.4g}",
                                 name, n_lines, least, range),
                     kNotEven);
  }
  axis.n = static_cast<Index>(used) + 1;
  axis.pitch = range / used;
  return axis;
}

Index line_of(double position, const Axis& axis, char name, const std::string& where) {
  if (axis.n == 1) return 0;
  const double line = (position - axis.first) / axis.pitch;
  const double nearest = std::round(line);
  if (std::abs(line - nearest) > kRounding) {
    throw InputError(
        where,
        fmt::format("a point at {} = {:.8g} lies between the lines of the grid, {:.6g} apart", name,
                    position, axis.pitch),
        kNotEven);
  }
  return static_cast<Index>(nearest);
}

}  // namespace

PointGrid grid_of_points(NumberView x, NumberView y, NumberView z, const std::string& where) {
  MANO_ASSERT(x.size() == y.size() && y.size() == z.size());
  if (x.empty()) throw InputError(where, "holds no points", "Export the map again");
  for (const NumberView& positions : {x, y}) {
    for (std::size_t i = 0; i < positions.size(); ++i) {
      if (!is_position(positions[i])) {
        throw InputError(where, "a point lacks its position", "Export x, y and z of every point");
      }
    }
  }
  const Axis columns = axis_of(x, 'x', where), rows = axis_of(y, 'y', where);
  const auto n_points = static_cast<double>(x.size());
  if (static_cast<double>(columns.n) * static_cast<double>(rows.n) > 4.0 * n_points + 16.0) {
    throw InputError(
        where,
        fmt::format("its {} points would fill a grid of {} x {} by less than a quarter", x.size(),
                    columns.n, rows.n),
        kNotEven);
  }
  PointGrid grid;
  grid.pitch_x = columns.pitch;
  grid.pitch_y = rows.pitch;
  grid.x0 = columns.first;
  grid.y0 = rows.first;
  grid.values = Array2::Constant(rows.n, columns.n, std::numeric_limits<double>::quiet_NaN());
  std::vector<bool> taken(static_cast<std::size_t>(grid.values.size()), false);
  for (std::size_t i = 0; i < x.size(); ++i) {
    const Index ix = line_of(x[i], columns, 'x', where), iy = line_of(y[i], rows, 'y', where);
    const auto at = static_cast<std::size_t>(iy * columns.n + ix);
    if (taken[at]) {
      throw InputError(where, fmt::format("two points lie at x = {:.8g}, y = {:.8g}", x[i], y[i]),
                       kNotEven);
    }
    taken[at] = true;
    grid.values(iy, ix) = z[i];
  }
  return grid;
}

double even_spacing(NumberView positions, const std::string& where) {
  if (positions.size() < 2) return 0.0;
  for (std::size_t i = 0; i < positions.size(); ++i) {
    if (!is_position(positions[i])) {
      throw InputError(where, "a position is missing", "Export every position");
    }
  }
  const double step =
      (positions.back() - positions.front()) / static_cast<double>(positions.size() - 1);
  for (std::size_t i = 0; i < positions.size(); ++i) {
    const double even = positions.front() + static_cast<double>(i) * step;
    if (!(std::abs(positions[i] - even) <= 2.0 * kRounding * std::abs(step)) || step == 0.0) {
      throw InputError(where,
                       fmt::format("position {} is {:.8g}, but even spacing asks for {:.8g}", i,
                                   positions[i], even),
                       "Resample to even spacing");
    }
  }
  return step;
}

}  // namespace manoscope::io

#include "roof_map.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <utility>
#include <vector>

#include "manoscope/core/error.hpp"
#include "smooth_stencil.hpp"

namespace manoscope::navier_stokes {
namespace {

constexpr const char* kWhere = "map of the roof";

/// Leaves out the last row where the clamped side is nearer to it than 0.3 of the spacing: slopes
/// over so short a way would carry its noise inwards several times over. Between 0.3 and 1 a value
/// inside holds at most 1.3 times the noise of a row (test).
void leave_room(double side, double near, std::vector<double>& z, std::vector<Index>& column) {
  constexpr double kNearest = 0.3;
  const double behind = side - z.back(), spacing = z.back() - z[z.size() - 2];
  if (behind <= near || behind >= kNearest * spacing) return;
  z.pop_back();
  column.pop_back();
}

/// The same rows from the other side.
void mirror(std::vector<double>& z, std::vector<Index>& column) {
  for (double& at : z) at = -at;
  std::reverse(z.begin(), z.end());
  std::reverse(column.begin(), column.end());
}

/// The map from side to side: mirrored if it begins at the middle, cut or clamped at the sides.
ShapeTable to_sides(const ShapeTable& table, double width) {
  constexpr double kRoundOff = 1e-6, kLargestGap = 0.1;  // widths
  constexpr Index kFewest = 4;
  const double side = 0.5 * width, near = kRoundOff * width;
  const bool half = table.z[0] > -near;
  std::vector<double> z;
  std::vector<Index> column;  // of the table; -1: clamped
  const auto add = [&](double at, Index k) {
    z.push_back(at);
    column.push_back(k);
  };
  for (Index k = 0; k < table.z.size(); ++k) {
    const double at = table.z[k];
    if (std::abs(at) > side + near) continue;
    add(std::clamp(at, -side, side), k);
  }
  if (static_cast<Index>(z.size()) < kFewest) {
    throw InputError(
        kWhere,
        fmt::format("{} positions across lie in a channel {:.4g} mm wide", z.size(), width * 1e3),
        "Give four or more, z counted from the middle of the channel");
  }
  constexpr double kFromOneSide = 0.95;  // no rim is as wide as half the channel
  const bool one_side = half && table.z[table.z.size() - 1] > kFromOneSide * width;
  const double before = half ? z.front() : z.front() + side, behind = side - z.back();
  if (one_side || before > kLargestGap * width || behind > kLargestGap * width) {
    throw InputError(kWhere,
                     fmt::format("z runs from {:.4g} to {:.4g} mm in a channel {:.4g} mm wide",
                                 table.z[0] * 1e3, table.z[table.z.size() - 1] * 1e3, width * 1e3),
                     "Give z from side to side, or from the middle to one side, counted from the "
                     "middle of the channel");
  }
  leave_room(side, near, z, column);
  if (behind > near) add(side, -1);
  if (half) {
    const std::vector<double> right = z;
    const std::vector<Index> its_column = column;
    z.clear();
    column.clear();
    for (std::size_t k = right.size(); k-- > 0;) {
      if (right[k] > near) add(-right[k], its_column[k]);
    }
    for (std::size_t k = 0; k < right.size(); ++k) add(right[k], its_column[k]);
  } else if (before > near) {
    mirror(z, column);
    leave_room(side, near, z, column);
    add(side, -1);
    mirror(z, column);
  }
  const auto n = static_cast<Index>(z.size());
  ShapeTable whole{table.x, Eigen::Map<const Array1>(z.data(), n), Array2::Zero(table.x.size(), n)};
  for (Index k = 0; k < n; ++k) {
    const Index from = column[static_cast<std::size_t>(k)];
    if (from >= 0) whole.zeta.col(k) = table.zeta.col(from);
  }
  return whole;
}

void check(const ShapeTable& table, Length width) {
  if (!(width > Length{})) {
    throw InputError(kWhere, fmt::format("the channel is {:g} mm wide", width.in(mm)),
                     "Give a positive width");
  }
  bool ascends = table.x.size() >= 2 && table.z.size() >= 1;
  for (const Array1* axis : {&table.x, &table.z}) {
    for (Index i = 1; i < axis->size(); ++i) ascends = ascends && (*axis)[i] > (*axis)[i - 1];
  }
  const bool fits = table.zeta.rows() == table.x.size() && table.zeta.cols() == table.z.size();
  if (ascends && fits && table.x.isFinite().all() && table.z.isFinite().all() &&
      table.zeta.isFinite().all()) {
    return;
  }
  throw InputError(kWhere,
                   fmt::format("{} x {} deflections at {} x and {} z", table.zeta.rows(),
                               table.zeta.cols(), table.x.size(), table.z.size()),
                   "Give finite deflections at two or more ascending x, at every ascending z");
}

/// The map, once checked.
ShapeTable checked(const ShapeTable& table, Length width) {
  check(table, width);
  return to_sides(table, width.si());
}

}  // namespace

RoofMap::RoofMap(const ShapeTable& table, Length width)
    : table_(checked(table, width)),
      mean_(table_.x, (table_.zeta.matrix() * mean_weights(table_.z).matrix()).array()) {}

double RoofMap::value(double x, double z) const {
  const SmoothStencil along(table_.x, x), across(table_.z, z);
  double sum = 0.0;
  for (Index i = 0; i < along.n; ++i) {
    double row = 0.0;
    for (Index k = 0; k < across.n; ++k) {
      row += across.weight[static_cast<std::size_t>(k)] *
             table_.zeta(along.first + i, across.first + k);
    }
    sum += along.weight[static_cast<std::size_t>(i)] * row;
  }
  return sum;
}

double RoofMap::odd() const {
  constexpr Index kPositions = 64;
  const double side = table_.z[table_.z.size() - 1];
  double sum = 0.0;
  for (const double x : table_.x) {
    for (Index k = 1; k <= kPositions; ++k) {
      const double z = side * static_cast<double>(k) / static_cast<double>(kPositions);
      sum += std::pow(0.5 * (value(x, z) - value(x, -z)), 2);
    }
  }
  return std::sqrt(sum / static_cast<double>(table_.x.size() * kPositions));
}

void require_open_gap(const RoofMap& roof, Length height) {
  Index i = 0, k = 0;
  const double least = height.si() + roof.zeta().minCoeff(&i, &k);
  if (least > 0.0) return;
  throw InputError(kWhere,
                   fmt::format("the gap is {:.4g} um at x = {:.4g} mm, z = {:.4g} mm", least * 1e6,
                               roof.x()[i] * 1e3, roof.z()[k] * 1e3),
                   "The gap must stay open everywhere; check the sign of zeta, the height, and the "
                   "map at this place");
}

}  // namespace manoscope::navier_stokes

#include "manoscope/maps/linear_reduction.hpp"

#include <fmt/format.h>

#include <Eigen/Cholesky>
#include <Eigen/LU>
#include <algorithm>
#include <array>
#include <cmath>
#include <cstring>
#include <vector>

#include "manoscope/core/error.hpp"
#include "manoscope/core/flags.hpp"
#include "manoscope/maps/channel_map.hpp"
#include "manoscope/maps/column_weights.hpp"
#include "manoscope/maps/linear_geometry.hpp"
#include "manoscope/maps/linear_kernels.hpp"
#include "manoscope/maps/reduce.hpp"

namespace manoscope::maps {
using namespace linear;

LinearReducer::LinearReducer(const CameraGrid& grid, const ChannelFrame& frame,
                             const std::string& name, const LinearReductionOptions& options) {
  options.width.validate();
  if (options.rim_margin && *options.rim_margin < Length{}) {
    throw InputError("--rim-margin", "is negative", "Give a length of 0 or more");
  }
  if (!reduces(frame)) {
    throw InputError(name, "its channel does not run along its rows of pixels",
                     "Reduce it by reduce_map(), or turn the camera");
  }
  geometry_ = std::make_unique<const Geometry>(grid, frame, name, options);
}
LinearReducer::~LinearReducer() = default;
LinearReducer::LinearReducer(LinearReducer&&) noexcept = default;
LinearReducer& LinearReducer::operator=(LinearReducer&&) noexcept = default;

bool LinearReducer::reduces(const ChannelFrame& frame) {
  return frame.along_columns() && frame.rotation == Angle{};
}
const CameraGrid& LinearReducer::grid() const { return geometry_->camera; }

/// What has come in of one map.
class LinearPass::Sums {
 public:
  Sums(const LinearReducer::Geometry& geometry, numerics::Instructions instructions)
      : geometry_(geometry),
        instructions_(instructions),
        nx_(geometry.grid.nx),
        stride_(whole_lanes(nx_)),
        columns_(static_cast<std::size_t>(stride_), 0.0),
        rim_(stride_),
        beside_(stride_),
        last_row_(static_cast<std::size_t>(4 * stride_)),
        row_before_(static_cast<std::size_t>(4 * nx_)),
        missing_(static_cast<std::size_t>(kRows * stride_ + 1)),
        gaps_(static_cast<std::size_t>(nx_)) {}

  void add_rows(std::span<const char> rows);
  LinearReduction finish(double metres_per_unit, const std::string& name);
  void reset();

 private:
  /// A column's missing pixels.
  struct Gap {
    ColumnGaps change;
    Index first = -1, last = -1;  ///< rows of the open gap, first = -1 where none is open
    Index n_inside = 0;           ///< missing pixels inside the channel
    double before = 0.0;          ///< height before the open gap
    double added = 0.0;           ///< to the column's sum
    bool dropped = false, touched = false;
  };

  void take(const char* rows, Index n_rows);
  void take_moments(const Block& block, Moments& moments);
  void take_columns(const Block& block);
  void open_gaps(const Block& block, Index n_missing);
  void close(Index ix, Index upper);
  void close_at_edge(Index ix, Index lower, Index upper);
  double height(Index iz, Index ix) const;
  RimPlane fit_plane(double metres_per_unit, const std::string& name) const;

  const LinearReducer::Geometry& geometry_;
  numerics::Instructions instructions_;
  Index nx_, stride_, n_taken_ = 0, n_looked_at_ = 0, n_missing_ = 0;
  std::vector<double> columns_;
  Moments rim_, beside_;
  Eigen::Matrix3d missing_normal_ = Eigen::Matrix3d::Zero();
  std::vector<char> last_row_, row_before_;
  const char* block_rows_ = nullptr;  ///< of the block at work, its first row n_taken_
  bool first_of_piece_ = true;        ///< the row before it has been handed over earlier
  std::vector<Index> missing_;
  std::vector<Gap> gaps_;
  std::vector<Index> open_, touched_;
};

void LinearPass::Sums::reset() {
  n_taken_ = n_looked_at_ = n_missing_ = 0;
  std::fill(columns_.begin(), columns_.end(), 0.0);
  rim_.reset(stride_);
  beside_.reset(stride_);
  missing_normal_.setZero();
  for (const Index ix : touched_) gaps_[static_cast<std::size_t>(ix)] = {};
  touched_.clear();
  open_.clear();
}

void LinearPass::Sums::add_rows(std::span<const char> rows) {
  const auto row_bytes = static_cast<std::size_t>(4 * nx_);
  MANO_ASSERT(rows.size() % row_bytes == 0);
  auto n_rows = static_cast<Index>(rows.size() / row_bytes);
  MANO_ASSERT(n_taken_ + n_rows <= geometry_.grid.nz);
  if (n_rows == 0) return;
  const char* at = rows.data();
  // The last row may be followed by nothing: whole lanes are read from a copy.
  const bool copies = stride_ != nx_;
  const char* const last = at + static_cast<std::size_t>(n_rows - 1) * row_bytes;
  if (copies) {
    std::memcpy(last_row_.data(), last, row_bytes);
    --n_rows;
  }
  const auto& weights = geometry_.weights;
  const auto kind = [&](Index iz) {
    return std::array{iz < geometry_.rim_below || iz >= geometry_.rim_above,
                      iz >= weights.first && iz <= weights.last};
  };
  while (n_rows > 0) {
    Index n = 1;
    while (n < std::min(kRows, n_rows) && kind(n_taken_ + n) == kind(n_taken_)) ++n;
    if (n < kRows) n = n < kFewRows ? 1 : kFewRows;
    take(at, n);
    first_of_piece_ = false;
    at += static_cast<std::size_t>(n) * row_bytes;
    n_rows -= n;
  }
  if (copies) {
    // Its row before is that of `rows`, not what precedes the copy.
    if (!first_of_piece_) std::memcpy(row_before_.data(), last - row_bytes, row_bytes);
    first_of_piece_ = true;
    take(last_row_.data(), 1);
  }
  std::memcpy(row_before_.data(), last, row_bytes);
  first_of_piece_ = true;
}

void LinearPass::Sums::take(const char* rows, Index n_rows) {
  const auto& g = geometry_;
  block_rows_ = rows;
  Index n_missing = 0;
  Block block{rows, n_rows, 4 * nx_, 0, stride_, stride_, missing_.data(), &n_missing};
  if (n_taken_ < g.rim_below || n_taken_ >= g.rim_above) {
    take_moments(block, rim_);
  } else {
    const Index end = whole_lanes(g.left), begin = g.right / kLanes * kLanes;
    if (end > begin) {
      take_moments(block, beside_);
    } else {
      block.end = end;
      if (g.left > 0) take_moments(block, beside_);
      block.first = begin;
      block.end = stride_;
      if (g.right < nx_) take_moments(block, beside_);
    }
  }
  if (n_taken_ >= g.weights.first && n_taken_ <= g.weights.last) {
    block.first = g.first / kLanes * kLanes;
    block.end = whole_lanes(g.end);
    take_columns(block);
  }
  n_taken_ += n_rows;
}

void LinearPass::Sums::take_moments(const Block& block, Moments& moments) {
  *block.n_missing = 0;
  run_rows<MomentColumns>(instructions_, block, geometry_.b.data() + n_taken_,
                          moments.height.data(), moments.b_height.data(), moments.square.data());
  const bool all = &moments == &rim_;
  for (Index k = 0; k < *block.n_missing; ++k) {
    const Index at = block.missing[k], ix = at % stride_;
    const bool on_rim = all ? ix < nx_ : ix < geometry_.left || (ix >= geometry_.right && ix < nx_);
    if (!on_rim) continue;
    const double a = geometry_.a[ix], b = geometry_.b[n_taken_ + at / stride_];
    missing_normal_ += normal_matrix(1.0, a, b, a * a, a * b, b * b);
  }
}

void LinearPass::Sums::take_columns(const Block& block) {
  *block.n_missing = 0;
  run_rows<WeightedColumns>(
      instructions_, block,
      &geometry_.weights.weight[static_cast<std::size_t>(n_taken_ - geometry_.weights.first)],
      columns_.data());
  n_looked_at_ += block.n_rows * (geometry_.end - geometry_.first);
  if (*block.n_missing > 0) open_gaps(block, *block.n_missing);
  const Index end = n_taken_ + block.n_rows;
  for (std::size_t k = 0; k < open_.size();) {
    const Gap& gap = gaps_[static_cast<std::size_t>(open_[k])];
    if (gap.first >= 0 && gap.last + 1 < end) close(open_[k], gap.last + 1);
    if (gap.first >= 0) {
      ++k;
    } else {
      open_[k] = open_.back();
      open_.pop_back();
    }
  }
}

/// Height of a pixel of the block at work or of the row before it.
double LinearPass::Sums::height(Index iz, Index ix) const {
  const char* const row = iz < n_taken_ && first_of_piece_
                              ? row_before_.data()
                              : block_rows_ + (iz - n_taken_) * 4 * nx_;
  float value = 0.0F;
  std::memcpy(&value, row + 4 * ix, sizeof value);
  return value;
}

void LinearPass::Sums::open_gaps(const Block& block, Index n_missing) {
  const auto& weights = geometry_.weights;
  for (Index k = 0; k < n_missing; ++k) {
    const Index at = block.missing[k], ix = at % stride_, iz = n_taken_ + at / stride_;
    if (ix < geometry_.first || ix >= geometry_.end) continue;
    ++n_missing_;
    Gap& gap = gaps_[static_cast<std::size_t>(ix)];
    if (!gap.touched) touched_.push_back(ix);
    gap.touched = true;
    const bool listed = gap.first >= 0;
    if (iz > weights.first && iz < weights.last) ++gap.n_inside;
    if (gap.first >= 0 && gap.last + 1 < iz) close(ix, gap.last + 1);
    if (gap.first < 0) {
      gap.first = iz;
      gap.before = iz > weights.first ? height(iz - 1, ix) : 0.0;
      if (!listed) open_.push_back(ix);
    }
    gap.last = iz;
  }
}

/// Closes the open gap of a column at the good pixel of row `upper`, or beyond the last row.
void LinearPass::Sums::close(Index ix, Index upper) {
  const auto& g = geometry_;
  Gap& gap = gaps_[static_cast<std::size_t>(ix)];
  const Index lower = gap.first - 1;
  gap.first = -1;
  if (lower <= g.weights.first || upper >= g.weights.last) return close_at_edge(ix, lower, upper);
  const double largest = std::max(g.options.largest_gap * g.width, 2.5 * g.grid.pitch_z.si());
  if (g.grid.z(upper) - g.grid.z(lower) > largest) {
    gap.dropped = true;
    return;
  }
  const double by = gap.change.close(g.weights, g.grid, lower, upper, g.width);
  gap.added += by * (gap.before + height(upper, ix));
}

/// The same where the gap reaches an edge: the clamped edge itself, zeta = 0, takes the place of
/// the pixel beyond it.
void LinearPass::Sums::close_at_edge(Index ix, Index lower, Index upper) {
  const auto& g = geometry_;
  const ColumnWeights& weights = g.weights;
  Gap& gap = gaps_[static_cast<std::size_t>(ix)];
  const bool below = lower <= weights.first;
  if (below && upper >= weights.last) {
    gap.dropped = true;
    return;
  }
  // The good pixel that is left, the rows that lose their weight, and what the one beyond the edge
  // had given if it is good.
  const Index node = below ? upper : lower;
  const Index from = below ? weights.first : lower + 1, to = below ? upper - 1 : weights.last;
  if (below && lower == weights.first) gap.added -= weights.of(lower) * gap.before;
  if (!below && upper == weights.last) gap.added -= weights.of(upper) * height(upper, ix);
  for (Index iz = from; iz <= to; ++iz) gap.change.remove(weights, g.grid, iz);
  const double pitch = g.grid.pitch_z.si();
  const double to_edge = 0.5 * g.width - (below ? -1.0 : 1.0) * g.grid.z(node);
  if (to_edge > std::max(g.options.largest_gap * g.width, 2.5 * pitch)) gap.dropped = true;
  const double by = 0.5 * (to_edge + pitch) / g.width - weights.of(node);
  gap.change.grow(weights, g.grid, node, by);
  gap.added += by * (below ? height(node, ix) : gap.before);
  if (to_edge >= 1.5 * pitch) gap.change.sixth += std::pow(to_edge, 6);
}

RimPlane LinearPass::Sums::fit_plane(double metres_per_unit, const std::string& name) const {
  constexpr double kFewest = 100.0;  // a plane to a tenth of the pixel noise
  const auto& g = geometry_;
  using List = Eigen::Map<const Array1>;
  Eigen::Vector3d right = Eigen::Vector3d::Zero();
  double squares = 0.0;
  const auto add = [&](const Moments& moments, Index first, Index n) {
    const List height(moments.height.data() + first, n);
    right += Eigen::Vector3d(height.sum(), (height * g.a.segment(first, n)).sum(),
                             List(moments.b_height.data() + first, n).sum());
    squares += List(moments.square.data() + first, n).sum();
  };
  add(rim_, 0, nx_);
  add(beside_, 0, g.left);
  add(beside_, g.right, nx_ - g.right);
  const Eigen::Matrix3d normal = g.normal - missing_normal_;
  const double n = std::round(normal(0, 0));
  const auto factors = normal.ldlt();
  const Eigen::Vector3d pivots = factors.vectorD();
  if (n < kFewest || !(pivots.minCoeff() > 1e-12 * pivots.maxCoeff())) {
    throw InputError(name,
                     fmt::format("{} good pixels lie on the rigid rim around the channel, which "
                                 "leaves its plane undetermined",
                                 static_cast<Index>(n)),
                     "Check channel.origin, length and width against the map, and image the wall "
                     "with some of its rigid frame on two sides or more");
  }
  const double to_outward = g.outward * metres_per_unit;
  const Eigen::Vector3d c = factors.solve(right);
  const double variance = std::max(0.0, squares - c.dot(right)) / (n - 3.0);
  const Eigen::Vector3d unscale(1.0, 1.0 / g.scale_x, g.across / g.scale_z);
  RimPlane plane;
  plane.offset = to_outward * c[0];
  plane.tilt_x = to_outward * c[1] * unscale[1];
  plane.tilt_z = to_outward * c[2] * unscale[2];
  plane.x_centre = g.x_centre;
  plane.sigma = Length::from_si(std::sqrt(variance) * std::abs(metres_per_unit));
  plane.covariance = plane.sigma.si() * plane.sigma.si() *
                     (unscale.asDiagonal() * normal.inverse() * unscale.asDiagonal());
  plane.inlier_fraction = 1.0;
  plane.n_samples = static_cast<Index>(n);
  return plane;
}

LinearReduction LinearPass::Sums::finish(double metres_per_unit, const std::string& name) {
  const auto& g = geometry_;
  MANO_ASSERT(n_taken_ == g.grid.nz);
  for (const Index ix : open_) close(ix, g.weights.last + 1);
  LinearReduction result;
  result.plane = fit_plane(metres_per_unit, name);
  result.missing = static_cast<double>(n_missing_) / static_cast<double>(n_looked_at_);
  const RimPlane& plane = result.plane;
  const Index n = g.end - g.first;
  const double pitch = g.grid.pitch_z.si(), noise = plane.sigma.si();
  const auto n_rows = static_cast<double>(g.weights.last - g.weights.first - 1);

  Profile& profile = result.profile;
  profile.x.resize(n);
  profile.zeta.resize(n);
  profile.flags = Flags1::Zero(n);
  profile.uncertainty.independent = Array1::Constant(n, noise * std::sqrt(g.weights.squares));
  Array1 measured = Array1::Constant(n, g.weights.sum);
  Array1 mean_z = Array1::Constant(n, g.across * g.weights.mean_z);
  const auto station = [&](Index ix) { return g.flow > 0.0 ? ix - g.first : g.end - 1 - ix; };
  for (Index ix = g.first; ix < g.end; ++ix) {
    profile.x[station(ix)] = g.x[ix];
    profile.zeta[station(ix)] = columns_[static_cast<std::size_t>(ix)];
  }
  for (const Index ix : touched_) {
    const Gap& gap = gaps_[static_cast<std::size_t>(ix)];
    const Index i = station(ix);
    profile.zeta[i] += gap.added;
    measured[i] += gap.change.measured;
    mean_z[i] += g.across * gap.change.mean_z;
  }
  profile.zeta = g.outward * metres_per_unit * profile.zeta -
                 (plane.offset + plane.tilt_x * (profile.x - plane.x_centre)) * measured -
                 plane.tilt_z * mean_z;
  for (const Index ix : touched_) {
    const Gap& gap = gaps_[static_cast<std::size_t>(ix)];
    const Index i = station(ix);
    const double inside = (n_rows - static_cast<double>(gap.n_inside)) * pitch / g.width;
    if (gap.dropped || inside < g.options.smallest_coverage) {
      profile.flags[i] = StationFlag::no_data;
      profile.zeta[i] = profile.uncertainty.independent[i] = measured[i] = mean_z[i] = 0.0;
      continue;
    }
    // A parabola of this mean sags by curvature gap^3 / 12 below the chord of a gap.
    const double sag = profile.zeta[i] / (g.width * g.width * g.width);
    profile.uncertainty.independent[i] = std::sqrt(
        (g.weights.squares + gap.change.squares) * noise * noise + sag * sag * gap.change.sixth);
  }
  add_shared_modes(profile, plane, measured, mean_z, g.grid.pitch_z / Length::from_si(g.width),
                   name);
  reset();
  return result;
}

LinearPass::LinearPass(const LinearReducer& reducer, numerics::Instructions instructions)
    : sums_(std::make_unique<Sums>(reducer.geometry(), instructions)) {}
LinearPass::~LinearPass() = default;
void LinearPass::add_rows(std::span<const char> rows) { sums_->add_rows(rows); }
LinearReduction LinearPass::finish(double metres_per_unit, const std::string& name) {
  return sums_->finish(metres_per_unit, name);
}

}  // namespace manoscope::maps

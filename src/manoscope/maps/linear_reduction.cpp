#include "manoscope/maps/linear_reduction.hpp"

#include <fmt/format.h>

#include <Eigen/Cholesky>
#include <Eigen/LU>
#include <algorithm>
#include <array>
#include <cfenv>
#include <cmath>
#include <cstring>
#include <vector>

#include "manoscope/core/error.hpp"
#include "manoscope/core/flags.hpp"
#include "manoscope/maps/channel_map.hpp"
#include "manoscope/maps/column_weights.hpp"
#include "manoscope/maps/linear_gaps.hpp"
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

namespace {

/// Masks what the processor says of numbers, as long as it lives: sums over missing pixels are
/// taken before they are found.
class QuietNumbers {
 public:
  QuietNumbers() { std::feholdexcept(&before_); }
  ~QuietNumbers() { std::fesetenv(&before_); }
  QuietNumbers(const QuietNumbers&) = delete;
  QuietNumbers& operator=(const QuietNumbers&) = delete;

 private:
  std::fenv_t before_{};
};

/// Sums over columns of heights and their squares; see linear::Moments.
struct RimColumns {
  std::vector<double> height, stacked, square;
  Index n_rows = 0;

  explicit RimColumns(Index n) { clear(n); }
  void clear(Index n) {
    for (auto* list : {&height, &stacked, &square}) list->assign(static_cast<std::size_t>(n), 0.0);
    n_rows = 0;
  }
};

}  // namespace

/// What has come in of one map.
class LinearPass::Sums {
 public:
  Sums(const LinearReducer::Geometry& geometry, numerics::Instructions instructions)
      : geometry_(geometry),
        instructions_(instructions),
        nx_(geometry.grid.nx),
        stride_(whole_lanes(nx_)),
        columns_(static_cast<std::size_t>(stride_), 0.0),
        edge_columns_(static_cast<std::size_t>(stride_), 0.0),
        rim_(stride_),
        last_row_(static_cast<std::size_t>(4 * stride_)),
        rows_before_(static_cast<std::size_t>(8 * nx_)),
        missing_(static_cast<std::size_t>(stride_ / kLanes)),
        bits_(missing_.size()),
        gaps_(geometry, instructions) {}

  void add_rows(std::span<const char> rows);
  LinearReduction finish(double metres_per_unit, const std::string& name);
  void reset();

 private:
  /// Missing pixels of a row of the rim: how many, sum a, sum a^2.
  struct MissingOfRow {
    double n, a, aa;
  };

  void take(const char* rows, Index n_rows, const Pixels& pixels);
  void take_rim(Block block);
  void add_moments(Block block, std::array<MissingOfRow, kRows>& missing);
  void fold_rim();
  void take_columns(Block block, const Pixels& pixels);
  void fill_profile(double metres_per_unit, const std::string& name, LinearReduction& result) const;
  RimPlane fit_plane(double metres_per_unit, const std::string& name) const;

  const LinearReducer::Geometry& geometry_;
  numerics::Instructions instructions_;
  Index nx_, stride_, n_taken_ = 0;
  std::vector<double> columns_, edge_columns_;  ///< heights; weight times height in the outer rows
  RimColumns rim_;
  Eigen::Vector3d right_ = Eigen::Vector3d::Zero();
  double squares_ = 0.0;
  using Normal = Eigen::Array<double, 6, 1>;  ///< arguments of normal_matrix()
  Normal missing_normal_ = Normal::Zero();
  std::vector<char> last_row_;
  std::vector<char> rows_before_;  ///< the two before those that have just come
  std::vector<std::uint64_t> missing_;
  BitList bits_;
  bool rim_misses_ = false, columns_miss_ = false;  ///< pixels of the last block
  MapGaps gaps_;
};

void LinearPass::Sums::reset() {
  n_taken_ = 0;
  std::fill(columns_.begin(), columns_.end(), 0.0);
  std::fill(edge_columns_.begin(), edge_columns_.end(), 0.0);
  rim_.clear(stride_);
  right_.setZero();
  squares_ = 0.0;
  missing_normal_.setZero();
  gaps_.reset();
}

void LinearPass::Sums::add_rows(std::span<const char> rows) {
  const auto row_bytes = static_cast<std::size_t>(4 * nx_);
  MANO_ASSERT(rows.size() % row_bytes == 0);
  auto n_rows = static_cast<Index>(rows.size() / row_bytes);
  MANO_ASSERT(n_taken_ + n_rows <= geometry_.grid.nz);
  if (n_rows == 0) return;
  const QuietNumbers quiet;
  const char* at = rows.data();
  // The last row may be followed by nothing: whole lanes are read from a copy.
  const bool copies = stride_ != nx_;
  const char* const last = at + static_cast<std::size_t>(n_rows - 1) * row_bytes;
  if (copies) {
    std::memcpy(last_row_.data(), last, row_bytes);
    --n_rows;
  }
  const Pixels pixels{at, rows_before_.data(), n_taken_, 4 * nx_};
  while (n_rows > 0) {
    const Index n = std::min({n_rows, geometry_.rows_alike(n_taken_), kRows});
    take(at, n, pixels);
    at += static_cast<std::size_t>(n) * row_bytes;
    n_rows -= n;
  }
  if (copies) take(last_row_.data(), 1, pixels);
  if (last == rows.data()) {
    std::memmove(rows_before_.data(), rows_before_.data() + row_bytes, row_bytes);
    std::memcpy(rows_before_.data() + row_bytes, last, row_bytes);
  } else {
    std::memcpy(rows_before_.data(), last - row_bytes, 2 * row_bytes);
  }
}

void LinearPass::Sums::take(const char* rows, Index n_rows, const Pixels& pixels) {
  const auto& g = geometry_;
  const Block block{rows, n_rows, 4 * nx_, 0, stride_, missing_.data(), false};
  if (n_taken_ == g.rim_below || n_taken_ == g.rim_above) fold_rim();
  take_rim(block);
  if (n_taken_ >= g.weights.first && n_taken_ <= g.weights.last) {
    take_columns(block, pixels);
  }
  n_taken_ += n_rows;
}

void LinearPass::Sums::take_rim(Block block) {
  const auto& g = geometry_;
  std::array<MissingOfRow, kRows> missing{};
  const Index left_end = whole_lanes(g.left), right_begin = g.right / kLanes * kLanes;
  block.expects_missing = rim_misses_;
  rim_misses_ = false;
  if (g.is_rim_row(n_taken_) || left_end > right_begin) {
    add_moments(block, missing);
  } else {
    block.end = left_end;
    if (g.left > 0) add_moments(block, missing);
    block.first = right_begin;
    block.end = stride_;
    if (g.right < nx_) add_moments(block, missing);
  }
  rim_.n_rows += block.n_rows;
  for (Index r = 0; rim_misses_ && r < block.n_rows; ++r) {
    const auto [n, a, aa] = missing[static_cast<std::size_t>(r)];
    const double b = g.b[n_taken_ + r];
    missing_normal_ += Normal{n, a, n * b, aa, a * b, n * b * b};
  }
}

void LinearPass::Sums::add_moments(Block block, std::array<MissingOfRow, kRows>& missing) {
  const auto& g = geometry_;
  const Moments moments{rim_.height.data(), rim_.stacked.data(), rim_.square.data()};
  const Index n_found = linear::add_rows(instructions_, block, moments);
  if (n_found == 0) return;
  rim_misses_ = true;
  const std::vector<std::uint64_t>& on_rim = g.is_rim_row(n_taken_) ? g.in_map : g.beyond_ends;
  bits_.clear();
  for (Index group = block.first / kLanes; group < block.end / kLanes; ++group) {
    const auto at = static_cast<std::size_t>(group);
    bits_.add(missing_[at] & on_rim[at], group);
  }
  for (const std::uint32_t at : bits_) {
    const BlockPixel pixel(at);
    MissingOfRow& row = missing[static_cast<std::size_t>(pixel.row)];
    const double a = g.a[pixel.column];
    row.n += 1.0;
    row.a += a;
    row.aa += a * a;
  }
}

/// Adds the columns to the right side of the plane's equations. All rows that are in them have the
/// same columns on the rim.
void LinearPass::Sums::fold_rim() {
  if (rim_.n_rows == 0) return;
  const auto& g = geometry_;
  using List = Eigen::Map<const Array1>;
  // Of row r of n the stacked heights hold n - r times what it holds.
  const double b_after = g.grid.z(n_taken_) / g.scale_z, step = g.grid.pitch_z.si() / g.scale_z;
  const auto add = [&](Index first, Index n) {
    const List height(rim_.height.data() + first, n);
    const double sum = height.sum();
    const double stacked = List(rim_.stacked.data() + first, n).sum();
    right_ += Eigen::Vector3d(sum, (height * g.a.segment(first, n)).sum(),
                              b_after * sum - step * stacked);
    squares_ += List(rim_.square.data() + first, n).sum();
  };
  if (g.is_rim_row(n_taken_ - 1)) {
    add(0, nx_);
  } else {
    add(0, g.left);
    add(g.right, nx_ - g.right);
  }
  rim_.clear(stride_);
}

void LinearPass::Sums::take_columns(Block block, const Pixels& pixels) {
  const auto& g = geometry_;
  block.first = g.first / kLanes * kLanes;
  block.end = whole_lanes(g.end);
  block.expects_missing = columns_miss_;
  Index n_found = 0;
  if (g.is_inner_row(n_taken_)) {
    n_found = linear::add_rows(instructions_, block, Heights{columns_.data()});
  } else {
    const double* const weight =
        &g.weights.weight[static_cast<std::size_t>(n_taken_ - g.weights.first)];
    n_found = linear::add_rows(instructions_, block, WeightedHeights{edge_columns_.data(), weight});
  }
  columns_miss_ = n_found > 0;
  if (n_found > 0 || gaps_.any_open()) {
    gaps_.follow(block, n_taken_, pixels);
  }
}

RimPlane LinearPass::Sums::fit_plane(double metres_per_unit, const std::string& name) const {
  constexpr double kFewest = 100.0;  // a plane to a tenth of the pixel noise
  const auto& g = geometry_;
  const Normal& none = missing_normal_;
  const Eigen::Matrix3d normal =
      g.normal - normal_matrix(none[0], none[1], none[2], none[3], none[4], none[5]);
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
  const Eigen::Vector3d c = factors.solve(right_);
  const double variance = std::max(0.0, squares_ - c.dot(right_)) / (n - 3.0);
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
  MANO_ASSERT(n_taken_ == geometry_.grid.nz);
  fold_rim();
  LinearReduction result;
  result.plane = fit_plane(metres_per_unit, name);
  fill_profile(metres_per_unit, name, result);
  reset();
  return result;
}

/// Stations run along the flow: where it runs against the columns they are turned round.
void LinearPass::Sums::fill_profile(double metres_per_unit, const std::string& name,
                                    LinearReduction& result) const {
  using List = Eigen::Map<const Array1>;
  const auto& g = geometry_;
  const RimPlane& plane = result.plane;
  const Index n = g.end - g.first;
  const double pitch = g.grid.pitch_z.si(), noise = plane.sigma.si();
  const auto n_rows = static_cast<double>(g.weights.last - g.weights.first - 1);
  const bool turns = g.flow < 0.0;
  const auto station = [&](Index ix) { return turns ? g.end - 1 - ix : ix - g.first; };

  Profile& profile = result.profile;
  profile.x = g.x.segment(g.first, n);
  profile.zeta =
      g.inner_weight * List(columns_.data() + g.first, n) + List(edge_columns_.data() + g.first, n);
  if (turns) {
    profile.x.reverseInPlace();
    profile.zeta.reverseInPlace();
  }
  profile.flags = Flags1::Zero(n);
  profile.uncertainty.independent = Array1::Constant(n, noise * std::sqrt(g.weights.squares));
  Array1 measured = Array1::Constant(n, g.weights.sum);
  Array1 mean_z = Array1::Constant(n, g.across * g.weights.mean_z);
  const double looked_at = (n_rows + 2.0) * static_cast<double>(n);
  result.missing = static_cast<double>(gaps_.missing()) / looked_at;
  const double to_outward = g.outward * metres_per_unit, balance = mean_z[0];
  profile.zeta = to_outward * profile.zeta -
                 (plane.offset + plane.tilt_x * (profile.x - plane.x_centre)) * g.weights.sum -
                 plane.tilt_z * balance;
  if (gaps_.missing() > 0) {
    Array1 count(n), height(n), squares(n), sixth(n);
    for (Index ix = g.first; ix < g.end; ++ix) {
      const MapGaps::Singles singles = gaps_.singles_in(ix);
      const Index i = station(ix);
      count[i] = singles.count;
      height[i] = singles.height;
      squares[i] = g.weights.squares + singles.squares;
      sixth[i] = singles.sixth;
    }
    profile.zeta += to_outward * height;
    for (const Index ix : gaps_.with_several()) {
      const MapGaps::Change& change = gaps_.several_in(ix);
      const Index i = station(ix);
      count[i] += change.dropped ? n_rows + 1.0 : static_cast<double>(change.n_inside);
      squares[i] += change.weights.squares;
      sixth[i] += change.weights.sixth;
      measured[i] += change.weights.measured;
      mean_z[i] += g.across * change.weights.mean_z;
      const double level = plane.offset + plane.tilt_x * (profile.x[i] - plane.x_centre);
      profile.zeta[i] += to_outward * change.height - level * change.weights.measured -
                         plane.tilt_z * g.across * change.weights.mean_z;
    }
    // A parabola of this mean sags by curvature gap^3 / 12 below the chord of a gap.
    const double inverse_cube = 1.0 / (g.width * g.width * g.width);
    profile.uncertainty.independent =
        (squares.max(0.0) * (noise * noise) + (profile.zeta * inverse_cube).square() * sixth)
            .sqrt();
    for (Index i = 0; i < n; ++i) {
      if ((n_rows - count[i]) * pitch / g.width >= g.options.smallest_coverage) continue;
      profile.flags[i] = StationFlag::no_data;
      profile.zeta[i] = profile.uncertainty.independent[i] = measured[i] = mean_z[i] = 0.0;
    }
  }
  profile.uncertainty.modes.reserve(4);  // three of the plane, one of the quadrature
  add_shared_modes(profile, plane, measured, mean_z, g.grid.pitch_z / Length::from_si(g.width),
                   name);
}

LinearPass::LinearPass(const LinearReducer& reducer, numerics::Instructions instructions)
    : sums_(std::make_unique<Sums>(reducer.geometry(), instructions)) {}
LinearPass::~LinearPass() = default;
void LinearPass::add_rows(std::span<const char> rows) { sums_->add_rows(rows); }
LinearReduction LinearPass::finish(double metres_per_unit, const std::string& name) {
  return sums_->finish(metres_per_unit, name);
}

}  // namespace manoscope::maps

#include "manoscope/maps/rim_bend.hpp"

#include <Eigen/Cholesky>
#include <Eigen/LU>
#include <algorithm>
#include <array>
#include <cmath>
#include <cstring>
#include <limits>
#include <vector>

#include "manoscope/core/flags.hpp"
#include "manoscope/numerics/lanes.hpp"
#include "manoscope/numerics/ranks.hpp"

namespace manoscope::maps {
namespace {

using numerics::kLanes;
using Terms = RimBend::Terms;
using Normal = Eigen::Matrix<double, 6, 6>;

/// Some pixels of the rim, row by row; each row is filled up to a multiple of kLanes by kAbsent.
struct Samples {
  static constexpr double kAbsent = 1e200;
  struct Row {
    Index start, length;
    double v;
  };
  std::vector<double> u, height;
  std::vector<Row> rows;
  std::size_t count = 0;
};

/// Every n-th of the good pixels, fewer than 40 000.
Samples choose_samples(const ChannelMap& map, const Flags2& rim, const RimBend& bend) {
  constexpr Index kMost = 20000;
  const Index nx = map.grid.nx, every = std::max<Index>(1, count_set(rim, 1) / kMost);
  Array1 u(nx);
  for (Index ix = 0; ix < nx; ++ix) u[ix] = bend.u(map.grid.x(ix));
  Samples samples;
  samples.u.reserve(static_cast<std::size_t>(2 * kMost + kLanes * map.grid.nz));
  samples.height.reserve(samples.u.capacity());
  Index to_pass = 0;
  for (Index iz = 0; iz < map.grid.nz; ++iz) {
    const FlagBits *const on_rim = &rim(iz, 0), *const flags = &map.flags(iz, 0);
    const double* const height = &map.height(iz, 0);
    const std::size_t start = samples.u.size();
    for (Index ix = 0; ix < nx; ++ix) {
      if (on_rim[ix] == 0) {
        const void* const next = std::memchr(on_rim + ix, 1, static_cast<std::size_t>(nx - ix));
        if (next == nullptr) break;
        ix = static_cast<const FlagBits*>(next) - on_rim;
      }
      if (flags[ix] != 0 || to_pass-- > 0) continue;
      to_pass = every - 1;
      samples.u.push_back(u[ix]);
      samples.height.push_back(height[ix]);
    }
    const std::size_t n = samples.u.size() - start;
    if (n == 0) continue;
    const std::size_t filled = start + (n + kLanes - 1) / kLanes * kLanes;
    samples.u.resize(filled, 0.0);
    samples.height.resize(filled, Samples::kAbsent);
    samples.rows.push_back(
        {static_cast<Index>(start), static_cast<Index>(filled - start), bend.v(map.grid.z(iz))});
    samples.count += n;
  }
  return samples;
}

/// A surface along one row: base + slope u + curve u^2.
struct RowSurface {
  double base, slope, curve;

  RowSurface(const Terms& c, double v)
      : base(c[0] + c[2] * v + c[5] * v * v), slope(c[1] + c[4] * v), curve(c[3]) {}
};

/// Distance from a surface of the kLanes samples at i.
template <class Lanes>
[[gnu::always_inline]] inline Lanes size_at(const Samples& samples, const RowSurface& surface,
                                            Index i) {
  const Lanes u = Lanes::load(samples.u.data() + i);
  return size_of(Lanes::load(samples.height.data() + i) -
                 (Lanes::all(surface.base) + Lanes::all(surface.slope) * u +
                  Lanes::all(surface.curve) * (u * u)));
}

/// The distances of all.
struct Sizes {
  template <class Lanes>
  [[gnu::always_inline]] static void run(const Samples* samples, const Terms* c, double* sizes) {
    for (const Samples::Row& row : samples->rows) {
      const RowSurface surface(*c, row.v);
      for (Index i = row.start; i < row.start + row.length; i += kLanes) {
        size_at<Lanes>(*samples, surface, i).store(sizes + i);
      }
    }
  }
};

/// Of one row the sums of w, w u, ... w u^4, and of w h, w h u, w h u^2, under Tukey's weights
/// about a surface.
struct RowSums {
  template <class Lanes>
  [[gnu::always_inline]] static void run(const Samples* samples, const Samples::Row* row,
                                         RowSurface surface, double bound, double* sums) {
    // What lies on the bound or beyond must have the weight 0 to the last digit.
    const Lanes inverse = Lanes::all((1.0 + 4.0 * std::numeric_limits<double>::epsilon()) / bound);
    const Lanes zero = Lanes::all(0.0), one = Lanes::all(1.0), reach = Lanes::all(bound);
    Lanes w0 = zero, w1 = zero, w2 = zero, w3 = zero, w4 = zero, h0 = zero, h1 = zero, h2 = zero;
    for (Index i = row->start; i < row->start + row->length; i += kLanes) {
      const Lanes u = Lanes::load(samples->u.data() + i), uu = u * u;
      const Lanes share =
          lesser(lesser(size_at<Lanes>(*samples, surface, i), reach) * inverse, one);
      const Lanes root = one - share * share, weight = root * root;
      const Lanes wu = weight * u, wuu = weight * uu;
      const Lanes wh = weight * Lanes::load(samples->height.data() + i);
      w0 = w0 + weight;
      w1 = w1 + wu;
      w2 = w2 + wuu;
      w3 = w3 + wu * uu;
      w4 = w4 + wuu * uu;
      h0 = h0 + wh;
      h1 = h1 + wh * u;
      h2 = h2 + wh * uu;
    }
    w0.store(sums), w1.store(sums + kLanes), w2.store(sums + 2 * kLanes);
    w3.store(sums + 3 * kLanes), w4.store(sums + 4 * kLanes), h0.store(sums + 5 * kLanes);
    h1.store(sums + 6 * kLanes), h2.store(sums + 7 * kLanes);
  }
};

/// Normal equations of a surface under Tukey's weights about the surface c.
struct Equations {
  Normal normal = Normal::Zero();
  Terms right = Terms::Zero();

  Equations(const Samples& samples, const Terms& c, double bound) {
    constexpr std::array<std::size_t, 6> kPowerOfU{0, 1, 0, 2, 1, 0}, kPowerOfV{0, 0, 1, 0, 1, 2};
    constexpr std::size_t kHeights = 5;
    for (const Samples::Row& row : samples.rows) {
      std::array<double, 8 * kLanes> lanes;
      numerics::run_in_lanes<RowSums>(numerics::best_instructions(), &samples, &row,
                                      RowSurface(c, row.v), bound, lanes.data());
      std::array<double, 8> sum;
      for (std::size_t k = 0; k < sum.size(); ++k) {
        sum[k] = numerics::sum_of_lanes(lanes.data() + k * kLanes);
      }
      const double v = row.v;
      const std::array<double, 5> power{1.0, v, v * v, v * v * v, v * v * v * v};
      for (std::size_t i = 0; i < 6; ++i) {
        const auto at = static_cast<Index>(i);
        for (std::size_t j = 0; j <= i; ++j) {
          normal(at, static_cast<Index>(j)) +=
              sum[kPowerOfU[i] + kPowerOfU[j]] * power[kPowerOfV[i] + kPowerOfV[j]];
        }
        right[at] += sum[kHeights + kPowerOfU[i]] * power[kPowerOfV[i]];
      }
    }
    normal = Normal(normal.selfadjointView<Eigen::Lower>());
  }
};

/// 1.4826 times the median size; what was filled up lies beyond all others.
double spread_of(std::vector<double>& sizes, std::size_t count, double expected) {
  constexpr double kNormalConsistency = 1.482602218505602;  // 1 / quantile(3/4)
  const double guess = expected / kNormalConsistency;
  const numerics::Range middle =
      numerics::values_of_ranks(sizes, (count - 1) / 2, count / 2, {0.9 * guess, 1.1 * guess});
  return kNormalConsistency * 0.5 * (middle.low + middle.high);
}

}  // namespace

RimBend fit_rim_bend(const ChannelMap& leveled, const Flags2& rim, Length sigma,
                     Length channel_length) {
  constexpr double kTukey = 4.685;
  constexpr int kPasses = 3;
  constexpr double kLeastPivot = 1e-4;  // of the first: below it a term is not told from the others
  const ChannelGrid& grid = leveled.grid;
  RimBend bend;
  bend.x_centre = 0.5 * (grid.x(0) + grid.x(grid.nx - 1));
  bend.reach_x = std::max(0.5 * (grid.x(grid.nx - 1) - grid.x(0)), 1e-12);
  bend.reach_z = std::max({std::abs(grid.z(0)), std::abs(grid.z(grid.nz - 1)), 1e-12});
  bend.sigma = sigma;
  const Samples samples = choose_samples(leveled, rim, bend);
  if (samples.count == 0) return bend;
  Terms coefficient = Terms::Zero();
  double spread = sigma.si();
  Normal normal;
  std::vector<double> sizes(samples.u.size());
  for (int pass = 0; pass < kPasses; ++pass) {
    const Equations equations(samples, coefficient, kTukey * std::max(spread, 1e-300));
    const auto factors = equations.normal.ldlt();
    if (!(factors.vectorD().minCoeff() > kLeastPivot * equations.normal(0, 0))) return bend;
    coefficient = factors.solve(equations.right);
    normal = equations.normal;
    numerics::run_in_lanes<Sizes>(numerics::best_instructions(), &samples, &coefficient,
                                  sizes.data());
    spread = spread_of(sizes, samples.count, spread);
  }
  bend.coefficient = coefficient;
  bend.covariance = spread * spread * normal.inverse();
  bend.sigma = Length::from_si(spread);
  const Terms middle = bend.terms(0.5 * channel_length.si(), 0.0);
  bend.at_middle = Length::from_si(middle.dot(coefficient));
  bend.at_middle_uncertainty = Length::from_si(std::sqrt(middle.dot(bend.covariance * middle)));
  return bend;
}

void subtract_bend(ChannelMap& map, const RimBend& bend) {
  for (Index iz = 0; iz < map.grid.nz; ++iz) {
    const double z = map.grid.z(iz);
    for (Index ix = 0; ix < map.grid.nx; ++ix) map.height(iz, ix) -= bend.height(map.grid.x(ix), z);
  }
}

}  // namespace manoscope::maps

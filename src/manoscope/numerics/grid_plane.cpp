#include "manoscope/numerics/grid_plane.hpp"

#include <Eigen/Cholesky>
#include <Eigen/LU>
#include <algorithm>
#include <cmath>
#include <cstring>
#include <limits>

#include "manoscope/core/error.hpp"
#include "manoscope/core/flags.hpp"
#include "manoscope/numerics/ranks.hpp"

namespace manoscope::numerics {
namespace {

using Run = GridPoints::Run;

/// Weighted sums over all points, lane by lane: of w, w a, w b, w a a, w a b, w b b, of w r, w a r,
/// w b r with the residual r, and what the size of a step is judged by.
struct LaneSums {
  double w[kLanes], wa[kLanes], wb[kLanes], waa[kLanes], wab[kLanes], wbb[kLanes];
  double wr[kLanes], war[kLanes], wbr[kLanes];
  double root_w[kLanes];   ///< sum of the square roots of the weights
  double outside[kLanes];  ///< samples beyond the rejection bound, absent ones among them
};

struct NormalEquations {
  Eigen::Matrix3d matrix;
  Eigen::Vector3d right;  ///< towards the residuals: the solution is a step

  explicit NormalEquations(const LaneSums& sums) {
    const auto of = [](const double* lanes) { return sum_of_lanes(lanes); };
    matrix << of(sums.w), of(sums.wa), of(sums.wb),  //
        of(sums.wa), of(sums.waa), of(sums.wab),     //
        of(sums.wb), of(sums.wab), of(sums.wbb);
    right << of(sums.wr), of(sums.war), of(sums.wbr);
  }
  /// Relative size of the smallest pivot below which the points count as collinear.
  bool determined() const {
    const Eigen::Vector3d pivots = matrix.ldlt().vectorD();
    return pivots.minCoeff() > 1e-12 * pivots.maxCoeff();
  }
  Eigen::Vector3d step() const { return matrix.ldlt().solve(right); }
};

/// What the kernels read.
struct Samples {
  const double* values;
  const Run* runs;
  Index n_runs;
  const double* a;
};

Samples samples_of(const GridPoints& points) {
  return {points.values().data(), points.runs().data(), static_cast<Index>(points.runs().size()),
          points.a().data()};
}

/// Tukey's weights (1 - (r / bound)^2)^2 and the sums over them.
struct BiweightSums {
  template <class Lanes>
  [[gnu::always_inline]] static void run(Samples samples, const double* c, double bound,
                                         LaneSums* sums) {
    // What lies on the bound or beyond must have the weight 0 to the last digit.
    const Lanes inverse = Lanes::all((1.0 + 4.0 * std::numeric_limits<double>::epsilon()) / bound);
    const Lanes reach = Lanes::all(bound), one = Lanes::all(1.0), slope = Lanes::all(c[1]);
    const Lanes zero = Lanes::all(0.0);
    Lanes all_w = zero, all_wa = zero, all_wb = zero, all_waa = zero, all_wab = zero;
    Lanes all_wbb = zero, all_wr = zero, all_war = zero, all_wbr = zero;
    Lanes root_w = zero, outside = zero;
    for (Index k = 0; k < samples.n_runs; ++k) {
      const Run& here = samples.runs[k];
      const Lanes base = Lanes::all(c[0] + c[2] * here.b), b = Lanes::all(here.b);
      Lanes w = zero, wa = zero, waa = zero, wr = zero, war = zero;
      const double *value = samples.values + here.start, *column = samples.a + here.first;
      for (Index i = 0; i < here.length; i += kLanes) {
        const Lanes a = Lanes::load(column + i);
        const Lanes residual = Lanes::load(value + i) - (base + slope * a);
        const Lanes size = size_of(residual);
        const Lanes share = lesser(lesser(size, reach) * inverse, one);
        const Lanes root = one - share * share, weight = root * root;
        const Lanes weight_a = weight * a;
        root_w = root_w + root;
        outside = outside + is_below(reach, size);
        w = w + weight;
        wa = wa + weight_a;
        waa = waa + weight_a * a;
        wr = wr + weight * residual;
        war = war + weight_a * residual;
      }
      all_w = all_w + w;
      all_wa = all_wa + wa;
      all_waa = all_waa + waa;
      all_wr = all_wr + wr;
      all_war = all_war + war;
      all_wb = all_wb + w * b;
      all_wab = all_wab + wa * b;
      all_wbb = all_wbb + w * b * b;
      all_wbr = all_wbr + wr * b;
    }
    all_w.store(sums->w), all_wa.store(sums->wa), all_wb.store(sums->wb);
    all_waa.store(sums->waa), all_wab.store(sums->wab), all_wbb.store(sums->wbb);
    all_wr.store(sums->wr), all_war.store(sums->war), all_wbr.store(sums->wbr);
    root_w.store(sums->root_w), outside.store(sums->outside);
  }
};

/// Sizes of the residuals: how many lie below `low`, and a list of those from there to below
/// `high`.
struct SizesWithin {
  template <class Lanes>
  [[gnu::always_inline]] static void run(Samples samples, const double* c, double low, double high,
                                         double* found, Index* n_found, Index* n_below) {
    constexpr Index kBlock = 4 * kLanes;
    const Lanes lowest = Lanes::all(low), end = Lanes::all(high), slope = Lanes::all(c[1]);
    Lanes below = Lanes::all(0.0);
    double sizes[kBlock], hits[kLanes];
    Index n = 0;
    for (Index k = 0; k < samples.n_runs; ++k) {
      const Run& here = samples.runs[k];
      const Lanes base = Lanes::all(c[0] + c[2] * here.b);
      const double *value = samples.values + here.start, *column = samples.a + here.first;
      for (Index start = 0; start < here.length; start += kBlock) {
        const Index length = std::min(kBlock, here.length - start);
        Lanes within = Lanes::all(0.0);
        for (Index i = 0; i < length; i += kLanes) {
          const Lanes size = size_of(Lanes::load(value + start + i) -
                                     (base + slope * Lanes::load(column + start + i)));
          const Lanes lower = is_below(size, lowest);
          below = below + lower;
          within = within + (is_below(size, end) - lower);
          size.store(sizes + i);
        }
        within.store(hits);
        if (sum_of_lanes(hits) == 0.0) continue;
        for (Index i = 0; i < length; ++i) {
          found[n] = sizes[i];
          n += static_cast<Index>(sizes[i] >= low) & static_cast<Index>(sizes[i] < high);
        }
      }
    }
    below.store(hits);
    *n_found = n;
    *n_below = static_cast<Index>(sum_of_lanes(hits));
  }
};

/// A few points, scattered: a multiple of kLanes.
struct Few {
  std::vector<double> a, b, v;
};

/// Weights 1 / max(|r|, floor), the sums over them, and the sizes |r|.
struct AbsoluteSums {
  template <class Lanes>
  [[gnu::always_inline]] static void run(const Few* few, const double* c, double floor,
                                         LaneSums* sums, double* sizes) {
    const Lanes zero = Lanes::all(0.0), one = Lanes::all(1.0), least = Lanes::all(floor);
    Lanes w = zero, wa = zero, wb = zero, waa = zero, wab = zero, wbb = zero;
    Lanes wr = zero, war = zero, wbr = zero;
    const auto n = static_cast<Index>(few->v.size());
    for (Index i = 0; i < n; i += kLanes) {
      const Lanes a = Lanes::load(few->a.data() + i), b = Lanes::load(few->b.data() + i);
      const Lanes residual = Lanes::load(few->v.data() + i) -
                             (Lanes::all(c[0]) + Lanes::all(c[1]) * a + Lanes::all(c[2]) * b);
      const Lanes size = size_of(residual), weight = one / greater(size, least);
      size.store(sizes + i);
      const Lanes weight_a = weight * a, weight_b = weight * b;
      w = w + weight;
      wa = wa + weight_a;
      wb = wb + weight_b;
      waa = waa + weight_a * a;
      wab = wab + weight_a * b;
      wbb = wbb + weight_b * b;
      wr = wr + weight * residual;
      war = war + weight_a * residual;
      wbr = wbr + weight_b * residual;
    }
    w.store(sums->w), wa.store(sums->wa), wb.store(sums->wb);
    waa.store(sums->waa), wab.store(sums->wab), wbb.store(sums->wbb);
    wr.store(sums->wr), war.store(sums->war), wbr.store(sums->wbr);
  }
};

constexpr Index kFew = 4000;
constexpr double kNormalConsistency = 1.482602218505602;  // 1 / quantile(3/4)

Few every_nth(const GridPoints& points) {
  Few few;
  const auto stride = static_cast<Index>(points.values().size()) / kFew + 1;
  Index next = stride / 2;
  for (const Run& run : points.runs()) {
    for (; next < run.start + run.length; next += stride) {
      const double v = points.values()[static_cast<std::size_t>(next)];
      if (v == GridPoints::kAbsent) continue;
      few.a.push_back(points.a()[static_cast<std::size_t>(run.first + next - run.start)]);
      few.b.push_back(run.b);
      few.v.push_back(v);
    }
  }
  const std::size_t n = few.v.size() / kLanes * kLanes;
  few.a.resize(n), few.b.resize(n), few.v.resize(n);
  return few;
}

/// Median of every sixteenth value, to a tenth or so.
double rough_median(const std::vector<double>& values) {
  std::vector<double> some;
  some.reserve(values.size() / 16 + 1);
  for (std::size_t i = 0; i < values.size(); i += 16) some.push_back(values[i]);
  const auto middle = some.begin() + static_cast<std::ptrdiff_t>(some.size() / 2);
  std::nth_element(some.begin(), middle, some.end());
  return *middle;
}

/// Where the median of all residuals is looked for: four standard deviations about the median of
/// these few.
Range bracket_of_median(std::vector<double>& sizes) {
  const std::size_t n = sizes.size(), middle = n / 2;
  const auto reach = static_cast<std::size_t>(2.0 * std::sqrt(static_cast<double>(n))) + 1;
  const std::size_t lower = middle - std::min(middle, reach),
                    upper = std::min(middle + reach, n - 1);
  if (const auto range = range_of_ranks(sizes, lower, upper, {0.0, 3.0 * rough_median(sizes)})) {
    return *range;
  }
  const double high = values_of_ranks(sizes, upper, upper, {}).high;
  return {values_of_ranks(sizes, lower, lower, {}).low, high};
}

/// Least absolute deviations of a few points, to within about their own uncertainty: `c`, and a
/// bracket of four standard deviations about the median of their residuals.
/// @return nullopt if they lie on one line.
std::optional<Range> start_from_few(const GridPoints& points, Instructions instructions,
                                    Eigen::Vector3d& c) {
  const Few few = every_nth(points);
  if (few.v.size() < 64) return std::nullopt;
  constexpr int kSteps = 30;
  std::vector<double> sizes(few.v.size());
  double floor = 1e150;  // first all points count alike
  for (int step = 0; step < kSteps; ++step) {
    LaneSums sums;
    run_in_lanes<AbsoluteSums>(instructions, &few, c.data(), floor, &sums, sizes.data());
    const NormalEquations normal(sums);
    if (!normal.determined()) {
      if (step == 0) return std::nullopt;
      break;
    }
    const Eigen::Vector3d by = normal.step();
    c += by;
    // Weights stay bounded: no residual counts as smaller than a hundredth of the median.
    floor = std::max(1e-2 * rough_median(sizes), 1e-300);
    // A hundredth of the noise: half of what the few points leave open.
    if (by.cwiseAbs().maxCoeff() <= floor) break;
  }
  LaneSums sums;
  run_in_lanes<AbsoluteSums>(instructions, &few, c.data(), floor, &sums, sizes.data());
  return bracket_of_median(sizes);
}

/// The two middle ones of the sizes of all residuals; `space` has room for all.
Range middle_sizes(const GridPoints& points, Instructions instructions, const Eigen::Vector3d& c,
                   const Range& guess, std::vector<double>& space) {
  const auto n = static_cast<Index>(points.size());
  const Index lower = (n - 1) / 2, upper = n / 2;
  for (const Range& bracket : {guess, Range{0.0, 0.5 * GridPoints::kAbsent}}) {
    Index n_found = 0, n_below = 0;
    run_in_lanes<SizesWithin>(instructions, samples_of(points), c.data(), bracket.low, bracket.high,
                              space.data(), &n_found, &n_below);
    if (lower < n_below || upper >= n_below + n_found) continue;
    return values_of_ranks({space.data(), static_cast<std::size_t>(n_found)},
                           static_cast<std::size_t>(lower - n_below),
                           static_cast<std::size_t>(upper - n_below), bracket);
  }
  throw InternalError("a residual is beyond 1e199");
}

std::vector<PlanePoint> scattered(const GridPoints& points) {
  std::vector<PlanePoint> list;
  for (const Run& run : points.runs()) {
    for (Index i = 0; i < run.length; ++i) {
      const double v = points.values()[static_cast<std::size_t>(run.start + i)];
      if (v == GridPoints::kAbsent) continue;
      list.push_back({points.a()[static_cast<std::size_t>(run.first + i)], run.b, v});
    }
  }
  return list;
}

}  // namespace

GridPoints::GridPoints(const Array1& a, const Array1& b, const Array2& v, const Flags2& selected,
                       const Flags2& flags)
    : a_(a.begin(), a.end()) {
  MANO_ASSERT(v.rows() == b.size() && v.cols() == a.size());
  MANO_ASSERT(selected.rows() == v.rows() && selected.cols() == v.cols());
  MANO_ASSERT(flags.rows() == v.rows() && flags.cols() == v.cols());
  const Index nx = v.cols();
  a_.resize(a_.size() + kLanes, 0.0);
  values_.reserve(static_cast<std::size_t>(count_set(selected, 1) + 2 * kLanes * v.rows()));
  for (Index iz = 0; iz < v.rows(); ++iz) {
    const FlagBits* const row = selected.data() + iz * nx;
    for (Index ix = 0; ix < nx;) {
      const void* const begin = std::memchr(row + ix, 1, static_cast<std::size_t>(nx - ix));
      if (begin == nullptr) break;
      const Index first = static_cast<const FlagBits*>(begin) - row;
      const void* const end = std::memchr(row + first, 0, static_cast<std::size_t>(nx - first));
      ix = end == nullptr ? nx : static_cast<const FlagBits*>(end) - row;
      add_run(&v(iz, first), &flags(iz, first), {0, first, 0, iz, b[iz]}, ix - first);
    }
  }
}

void GridPoints::add_run(const double* v, const FlagBits* flags, const Run& run, Index n) {
  const auto start = static_cast<Index>(values_.size());
  const Index length = (n + kLanes - 1) / kLanes * kLanes;
  values_.resize(static_cast<std::size_t>(start + length), kAbsent);
  double* const to = values_.data() + start;
  Index bad = 0;
  for (Index i = 0; i < n; ++i) {
    to[i] = flags[i] == 0 ? v[i] : kAbsent;
    bad += static_cast<Index>(flags[i] != 0);
  }
  size_ += n - bad;
  runs_.push_back({start, run.first, length, run.row, run.b});
}

std::optional<PlaneFit> fit_plane(const GridPoints& points, Instructions instructions) {
  MANO_ASSERT(points.size() >= 3);
  constexpr double kTukey = 4.685;
  constexpr int kSteps = 20;
  if (points.size() < kFew) return fit_plane(scattered(points));
  PlaneFit fit;
  const auto start = start_from_few(points, instructions, fit.coefficient);
  if (!start) return fit_plane(scattered(points));

  const auto n = static_cast<double>(points.size());
  std::vector<double> space(points.values().size() + kLanes);
  Range bracket = *start;
  for (int step = 0; step < kSteps; ++step) {
    const Range middle = middle_sizes(points, instructions, fit.coefficient, bracket, space);
    fit.sigma = kNormalConsistency * 0.5 * (middle.low + middle.high);
    // An exact fit has sigma = 0: then only exact points keep their weight.
    const double bound = kTukey * std::max(fit.sigma, 1e-300);
    LaneSums sums;
    run_in_lanes<BiweightSums>(instructions, samples_of(points), fit.coefficient.data(), bound,
                               &sums);
    fit.inlier_fraction =
        (static_cast<double>(points.values().size()) - sum_of_lanes(sums.outside)) / n;
    const NormalEquations normal(sums);
    if (!normal.determined()) break;
    // Plain reweighting falls short of the minimum by the share 1 - curvature of every step; steps
    // up to twice as long still go downhill. With u = 1 - (r / bound)^2 the curvature is the mean
    // of u (5 u - 4) over that of u^2.
    const double weights = sum_of_lanes(sums.w);
    const double curvature = (5.0 * weights - 4.0 * sum_of_lanes(sums.root_w)) / weights;
    const Eigen::Vector3d by = normal.step() / std::clamp(curvature, 0.6, 1.0);
    fit.coefficient += by;
    fit.covariance = fit.sigma * fit.sigma * normal.matrix.inverse();
    if (by.cwiseAbs().maxCoeff() <= 1e-6 * fit.sigma / std::sqrt(n)) break;
    // No residual moves by more than the plane does; a and b are of order 1.
    const double reach = 1.5 * by.cwiseAbs().sum() + 1e-9 * middle.high;
    bracket = {middle.low - reach, middle.high + reach};
  }
  return fit;
}

double mad_sigma(const GridPoints& points, Instructions instructions) {
  MANO_ASSERT(points.size() > 0);
  std::vector<double> sizes = every_nth(points).v;
  for (double& size : sizes) size = std::abs(size);
  const Range bracket = sizes.empty() ? Range{0.0, 0.0} : bracket_of_median(sizes);
  std::vector<double> space(points.values().size() + kLanes);
  const Range middle = middle_sizes(points, instructions, Eigen::Vector3d::Zero(), bracket, space);
  return kNormalConsistency * 0.5 * (middle.low + middle.high);
}

}  // namespace manoscope::numerics

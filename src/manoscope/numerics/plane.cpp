#include "manoscope/numerics/plane.hpp"

#include <Eigen/Cholesky>
#include <Eigen/LU>
#include <algorithm>
#include <cmath>

#include "manoscope/core/arrays.hpp"
#include "manoscope/core/error.hpp"
#include "manoscope/core/index.hpp"
#include "manoscope/numerics/robust.hpp"

namespace manoscope::numerics {
namespace {

/// Points as columns, which the processor reads in step.
struct Columns {
  Array1 a, b, v;

  Columns(const std::vector<PlanePoint>& points, std::size_t stride) {
    const auto n = static_cast<Index>((points.size() + stride - 1) / stride);
    a.resize(n), b.resize(n), v.resize(n);
    for (Index i = 0; i < n; ++i) {
      const PlanePoint& point = points[static_cast<std::size_t>(i) * stride];
      a[i] = point.a, b[i] = point.b, v[i] = point.v;
    }
  }
  Index size() const { return v.size(); }
  auto residuals(const Eigen::Vector3d& c) const { return v - (c[0] + c[1] * a + c[2] * b); }
};

struct NormalEquations {
  Eigen::Matrix3d matrix = Eigen::Matrix3d::Zero();
  Eigen::Vector3d right = Eigen::Vector3d::Zero();

  NormalEquations(const Columns& points, const Array1& weights) {
    constexpr Index kBlock = 512;  // stays in the processor's first cache
    for (Index start = 0; start < points.size(); start += kBlock) {
      const Index n = std::min(kBlock, points.size() - start);
      const auto a = points.a.segment(start, n).matrix();
      const auto b = points.b.segment(start, n).matrix();
      const auto v = points.v.segment(start, n).matrix();
      const auto w = weights.segment(start, n).matrix();
      using Block = Eigen::Matrix<double, Eigen::Dynamic, 1, 0, kBlock, 1>;
      const Block wa = w.cwiseProduct(a), wb = w.cwiseProduct(b);
      Eigen::Matrix3d sums;
      sums << w.sum(), wa.sum(), wb.sum(), 0.0, wa.dot(a), wa.dot(b), 0.0, 0.0, wb.dot(b);
      matrix += sums;
      right += Eigen::Vector3d(w.dot(v), wa.dot(v), wb.dot(v));
    }
    matrix.triangularView<Eigen::StrictlyLower>() = matrix.transpose();
  }
  /// Relative size of the smallest pivot below which the points count as collinear.
  bool determined() const {
    const Eigen::Vector3d pivots = matrix.ldlt().vectorD();
    return pivots.minCoeff() > 1e-12 * pivots.maxCoeff();
  }
};

Eigen::Vector3d least_absolute(const std::vector<PlanePoint>& all) {
  constexpr std::size_t kMost = 4000;
  constexpr int kSteps = 30;
  const Columns points(all, all.size() / kMost + 1);
  Eigen::Vector3d c = Eigen::Vector3d::Zero();
  Array1 weights = Array1::Ones(points.size());
  for (int step = 0; step < kSteps; ++step) {
    const NormalEquations sums(points, weights);
    if (!sums.determined()) break;
    const Array1 sizes = points.residuals(c).abs();
    const Eigen::Vector3d next = sums.matrix.ldlt().solve(sums.right);
    const double change = (next - c).cwiseAbs().maxCoeff();
    c = next;
    // Weights stay bounded: no residual counts as smaller than a hundredth of the median.
    std::vector<double> reordered(sizes.begin(), sizes.end());
    const double floor = std::max(1e-2 * median(reordered), 1e-300);
    if (change <= 0.1 * floor) break;  // a thousandth of the noise: good enough for a start
    weights = points.residuals(c).abs().max(floor).inverse();
  }
  return c;
}

}  // namespace

std::optional<PlaneFit> fit_plane(const std::vector<PlanePoint>& points) {
  MANO_ASSERT(points.size() >= 3);
  const Columns columns(points, 1);
  if (!NormalEquations(columns, Array1::Ones(columns.size())).determined()) return std::nullopt;

  constexpr double kTukey = 4.685;
  constexpr int kSteps = 20;
  PlaneFit fit;
  fit.coefficient = least_absolute(points);
  std::vector<double> sizes(points.size());
  Eigen::Map<Array1> size(sizes.data(), columns.size());
  Array1 weights(columns.size());
  for (int step = 0; step < kSteps; ++step) {
    size = columns.residuals(fit.coefficient).abs();
    fit.sigma = mad_sigma(sizes, 0.0);
    // An exact fit has sigma = 0: then only exact points keep their weight.
    const double bound = kTukey * std::max(fit.sigma, 1e-300);
    const auto share = (size.min(bound) / bound).square();
    weights = (1.0 - share).square();
    // Plain reweighting falls short of the minimum by the share 1 - curvature of every step; steps
    // up to twice as long still go downhill.
    const double curvature = ((1.0 - share) * (1.0 - 5.0 * share)).sum() / weights.sum();
    const double stretch = 1.0 / std::clamp(curvature, 0.6, 1.0);
    fit.inlier_fraction =
        static_cast<double>((size <= bound).count()) / static_cast<double>(points.size());
    const NormalEquations sums(columns, weights);
    if (!sums.determined()) break;
    const Eigen::Vector3d step_by =
        stretch * (sums.matrix.ldlt().solve(sums.right) - fit.coefficient);
    const double change = step_by.cwiseAbs().maxCoeff();
    fit.coefficient += step_by;
    fit.covariance = fit.sigma * fit.sigma * sums.matrix.inverse();
    if (change <= 1e-6 * fit.sigma / std::sqrt(static_cast<double>(points.size()))) break;
  }
  return fit;
}

}  // namespace manoscope::numerics

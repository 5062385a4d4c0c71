#include "manoscope/inversion/weak_window.hpp"

#include <Eigen/QR>
#include <algorithm>
#include <cmath>
#include <vector>

#include "manoscope/numerics/robust.hpp"

namespace manoscope::inversion {
namespace {

constexpr Index kFewestStations = 9;
constexpr Index kSmooth = 6;   // polynomials
constexpr double kOpen = 0.5;  // half widths between neighbouring stations that count

using Moments = Eigen::Matrix<double, kSmooth, 1>;

/// Weights changed by as little as makes their sums with 1, t ... t^5 those moments.
void meet_moments(const Matrix& polynomials, const Matrix& triangle, const Moments& moments,
                  Array1& weights) {
  const Eigen::VectorXd wanted = triangle.transpose().triangularView<Eigen::Lower>().solve(moments);
  weights += (polynomials * (wanted - polynomials.transpose() * weights.matrix())).array();
}

}  // namespace

std::optional<WeakWindow> make_weak_window(const Array1& x, const Flags1& usable, double centre,
                                           double half_width) {
  const double* begin = x.data();
  const double* end = begin + x.size();
  const Index first = std::upper_bound(begin, end, centre - half_width) - begin;
  const Index n = (std::lower_bound(begin, end, centre + half_width) - begin) - first;
  const Flags1 here = usable.segment(first, n);
  std::vector<Index> used;
  for (Index i = 0; i < n; ++i) {
    if (here[i] != 0) used.push_back(i);
  }
  if (static_cast<Index>(used.size()) < kFewestStations) return std::nullopt;
  const Array1 t = (x.segment(first, n) - centre) / half_width;
  WeakWindow window{centre,          first,           Array1::Zero(n),
                    Array1::Zero(n), Array1::Zero(n), Matrix(n, kSmooth)};
  for (std::size_t j = 0; j < used.size(); ++j) {
    const double at = t[used[j]];
    const double before = j > 0 ? at - t[used[j - 1]] : at + 1.0;
    const double behind = j + 1 < used.size() ? t[used[j + 1]] - at : 1.0 - at;
    if (before > kOpen || behind > kOpen) return std::nullopt;
    const double share = 0.5 * (before + behind), inside = 1.0 - at * at;
    window.mean[used[j]] = share * std::pow(inside, 3);
    window.curvature[used[j]] = share * (24.0 * at * at * inside - 6.0 * inside * inside);
    window.skew[used[j]] = at * window.curvature[used[j]] - 12.0 * share * at * inside * inside;
  }
  window.mean /= window.mean.sum();
  window.curvature *= 35.0 / 32.0;  // over the integral of phi
  window.skew *= 35.0 / 32.0;
  Matrix powers(n, kSmooth);
  for (Index j = 0; j < kSmooth; ++j) {
    powers.col(j) = ((here != 0).cast<double>() * t.pow(static_cast<double>(j))).matrix();
  }
  const Eigen::HouseholderQR<Matrix> factors(powers);
  window.smooth = factors.householderQ() * Matrix::Identity(n, kSmooth);
  const Matrix triangle =
      factors.matrixQR().topRows(kSmooth).triangularView<Eigen::Upper>().toDenseMatrix();
  // Moments of phi over its integral: int t^2 is 1/9, int t^4 is 1/33 of it.
  const Moments of_mean(1.0, 0.0, 1.0 / 9.0, 0.0, 1.0 / 33.0, 0.0);
  const Moments of_curvature(0.0, 0.0, 2.0, 0.0, 12.0 / 9.0, 0.0);
  const Moments of_skew(0.0, 0.0, 0.0, 6.0 / 9.0, 0.0, 20.0 / 33.0);
  meet_moments(window.smooth, triangle, of_mean, window.mean);
  meet_moments(window.smooth, triangle, of_skew, window.skew);
  meet_moments(window.smooth, triangle, of_curvature, window.curvature);
  window.curvature /= half_width * half_width;
  window.skew /= half_width * half_width;
  return window;
}

double WeakWindow::roughness(const Array1& values, const Array1& sigma) const {
  const Array1 used = (mean != 0.0).cast<double>();
  const Eigen::VectorXd given = (values * used).matrix();
  const Array1 left = (given - smooth * (smooth.transpose() * given)).array() * used;
  const double n_free = used.sum() - static_cast<double>(kSmooth);
  return (left / (sigma * used + (1.0 - used))).square().sum() / n_free;
}

std::vector<bool> not_rough(const std::vector<double>& roughness) {
  constexpr double kOfMedian = 3.0, kOfNoise = 2.0;
  std::vector<double> sorted = roughness;
  const double median = sorted.empty() ? 0.0 : numerics::median(sorted);
  std::vector<bool> passed;
  for (const double value : roughness) {
    passed.push_back(value <= std::max(kOfMedian * median, kOfNoise));
  }
  return passed;
}

double window_half_width(const Array1& x, double channel_width) {
  constexpr double kShare = 0.125, kSpacings = 4.6;
  const double spacing = (x[x.size() - 1] - x[0]) / static_cast<double>(x.size() - 1);
  return std::max(kShare * channel_width, kSpacings * spacing);
}

}  // namespace manoscope::inversion

#include "manoscope/twin/point_spread.hpp"

#include <cmath>
#include <vector>

#include "manoscope/core/error.hpp"

namespace manoscope::twin {
namespace {

constexpr double kWidestDiscrete = 4.0;  // pixels; I_k(t) e^-t would overflow for t beyond 700
constexpr double kSmallestWeight = 1e-8;
constexpr double kWidest = 1000.0;

/// Index of a mirrored sample: ... 1 0 | 0 1 2 ... n-1 | n-1 n-2 ...
Index mirrored(Index i, Index n) {
  const Index period = 2 * n;
  i = ((i % period) + period) % period;
  return i < n ? i : period - 1 - i;
}

void blur_rows(Array2& values, const Array1& weights) {
  const Index m = weights.size() / 2, n = values.cols();
  if (m == 0) return;
  Array1 row(n + 2 * m);
  for (Index iy = 0; iy < values.rows(); ++iy) {
    for (Index i = 0; i < row.size(); ++i) row(i) = values(iy, mirrored(i - m, n));
    for (Index ix = 0; ix < n; ++ix) {
      values(iy, ix) = (row.segment(ix, weights.size()) * weights).sum();
    }
  }
}

void blur_columns(Array2& values, const Array1& weights) {
  const Index m = weights.size() / 2, n = values.rows();
  if (m == 0) return;
  const Array2 before = values;
  values.setZero();
  for (Index iy = 0; iy < n; ++iy) {
    for (Index k = -m; k <= m; ++k) {
      values.row(iy) += weights(k + m) * before.row(mirrored(iy + k, n));
    }
  }
}

}  // namespace

Array1 gaussian_weights(double sigma) {
  MANO_ASSERT(sigma >= 0.0 && sigma <= kWidest);
  const double t = sigma * sigma;
  std::vector<double> half;  // from the centre outwards
  for (int k = 0; half.empty() || half.back() >= kSmallestWeight * half.front(); ++k) {
    half.push_back(sigma <= kWidestDiscrete ? std::exp(-t) * std::cyl_bessel_i(k, t)
                                            : std::exp(-0.5 * k * k / t));
  }
  half.pop_back();
  const auto m = static_cast<Index>(half.size()) - 1;
  Array1 weights(2 * m + 1);
  for (Index k = -m; k <= m; ++k) weights(k + m) = half[static_cast<std::size_t>(std::abs(k))];
  return weights / weights.sum();
}

void blur(Array2& values, double sigma_x, double sigma_y) {
  blur_rows(values, gaussian_weights(sigma_x));
  blur_columns(values, gaussian_weights(sigma_y));
}

Array2 correlated_noise(Index ny, Index nx, double l_x, double l_y, RandomStream& random) {
  Array1 along = gaussian_weights(0.5 * l_x), across = gaussian_weights(0.5 * l_y);
  along /= std::sqrt(along.square().sum());
  across /= std::sqrt(across.square().sum());
  // White noise reaches beyond the edges by half a kernel: every pixel averages as many numbers.
  Array2 white(ny + across.size() - 1, nx + along.size() - 1);
  for (Index i = 0; i < white.size(); ++i) white.data()[i] = random.normal();
  Array2 half = Array2::Zero(white.rows(), nx);
  for (Index k = 0; k < along.size(); ++k) half += along(k) * white.middleCols(k, nx);
  Array2 noise = Array2::Zero(ny, nx);
  for (Index k = 0; k < across.size(); ++k) noise += across(k) * half.middleRows(k, ny);
  return noise;
}

}  // namespace manoscope::twin

#include "manoscope/maps/noise.hpp"

#include <cmath>
#include <vector>

#include "manoscope/numerics/robust.hpp"

namespace manoscope::maps {
namespace {

/// 1 + 2 sum rho_k along one axis: step_x, step_z is (1, 0) or (0, 1). Heights that are not good
/// are 0.
double correlation_length(const Array2& height, const Flags2& good, Index step_x, Index step_z) {
  constexpr Index kMostLags = 50;
  double length = 1.0, variance = 0.0;
  for (Index lag = 0; lag <= kMostLags; ++lag) {
    const Index nx = height.cols() - lag * step_x, nz = height.rows() - lag * step_z;
    if (nx < 1 || nz < 1) break;
    double sum = 0.0;
    Index pairs = 0;
    for (Index iz = 0; iz < nz; ++iz) {
      const Index jz = iz + lag * step_z, jx = lag * step_x;
      sum += (height.row(iz).head(nx) * height.row(jz).segment(jx, nx)).sum();
      const FlagBits *here = &good(iz, 0), *there = &good(jz, jx);
      for (Index ix = 0; ix < nx; ++ix) pairs += here[ix] & there[ix];
    }
    if (pairs == 0) break;
    const double covariance = sum / static_cast<double>(pairs);
    if (lag == 0) {
      variance = covariance;
      if (variance <= 0.0) break;
      continue;
    }
    const double rho = covariance / variance;
    if (rho < 2.0 / std::sqrt(static_cast<double>(pairs))) break;
    length += 2.0 * rho;
  }
  return length;
}

}  // namespace

PixelNoise measure_noise(const ChannelMap& leveled, const Flags2& rim) {
  constexpr double kOutlier = 5.0;
  std::vector<double> heights;
  for (Index i = 0; i < rim.size(); ++i) {
    if (rim.data()[i] != 0 && leveled.flags.data()[i] == 0) {
      heights.push_back(leveled.height.data()[i]);
    }
  }
  PixelNoise noise;
  if (heights.empty()) return noise;
  const double sigma = numerics::mad_sigma(heights, 0.0);
  noise.sigma = Length::from_si(sigma);
  Flags2 good(rim.rows(), rim.cols());
  Array2 height(rim.rows(), rim.cols());
  for (Index i = 0; i < rim.size(); ++i) {
    const double value = leveled.height.data()[i];
    const bool counts =
        rim.data()[i] != 0 && leveled.flags.data()[i] == 0 && std::abs(value) <= kOutlier * sigma;
    good.data()[i] = counts ? 1 : 0;
    height.data()[i] = counts ? value : 0.0;
  }
  noise.length_x = correlation_length(height, good, 1, 0);
  noise.length_z = correlation_length(height, good, 0, 1);
  return noise;
}

}  // namespace manoscope::maps

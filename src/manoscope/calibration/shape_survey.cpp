#include "manoscope/calibration/shape_survey.hpp"

#include <Eigen/QR>
#include <algorithm>
#include <array>
#include <cmath>
#include <limits>
#include <vector>

namespace manoscope::calibration {
namespace {

constexpr double kNan = std::numeric_limits<double>::quiet_NaN();
constexpr double kFewestShare = 0.7;  // of the bins of a stretch
constexpr Index kReach = 2;           // stretches to either side

/// The cubic through four points.
double cubic(const std::array<double, 4>& place, const std::array<double, 4>& value, double at) {
  double sum = 0.0;
  for (std::size_t i = 0; i < 4; ++i) {
    double term = value[i];
    for (std::size_t k = 0; k < 4; ++k) {
      if (k != i) term *= (at - place[k]) / (place[i] - place[k]);
    }
    sum += term;
  }
  return sum;
}

/// Column j of the cells, the bad ones bridged; false where too few are good.
bool bridge(const CrossSections& cells, Index j, double width, Array2& whole) {
  std::vector<double> place{-0.5 * width}, value{0.0};
  for (Index b = 0; b < cells.z.size(); ++b) {
    if (cells.flags(b, j) != 0) continue;
    place.push_back(cells.z[b]);
    value.push_back(cells.zeta(b, j));
  }
  const auto n_good = static_cast<double>(place.size() - 1);
  place.push_back(0.5 * width);
  value.push_back(0.0);
  if (n_good < std::max(2.0, kFewestShare * static_cast<double>(cells.z.size()))) return false;
  for (Index b = 0; b < cells.z.size(); ++b) {
    whole(b, j) = cells.zeta(b, j);
    if (cells.flags(b, j) == 0) continue;
    const auto above = std::upper_bound(place.begin(), place.end(), cells.z[b]) - place.begin();
    const auto from = static_cast<std::size_t>(
        std::clamp<Index>(above - 2, 0, static_cast<Index>(place.size()) - 4));
    whole(b, j) =
        cubic({place[from], place[from + 1], place[from + 2], place[from + 3]},
              {value[from], value[from + 1], value[from + 2], value[from + 3]}, cells.z[b]);
  }
  return true;
}

/// Second derivative by the parabola through `kReach` stretches to either side, one of which may be
/// missing.
Array1 curvatures(const Array1& x, const Array1& values) {
  const Index n = x.size(), window = 2 * kReach + 1;
  Array1 curvature = Array1::Constant(n, kNan);
  for (Index j = 0; j < n && n >= window; ++j) {
    const Index from = std::clamp<Index>(j - kReach, 0, n - window);
    Eigen::Matrix3d normal = Eigen::Matrix3d::Zero();
    Eigen::Vector3d right = Eigen::Vector3d::Zero();
    const double reach = x[from + window - 1] - x[from];
    Index count = 0;
    for (Index i = from; i < from + window; ++i) {
      if (std::isnan(values[i])) continue;
      const double t = (x[i] - x[j]) / reach;
      const Eigen::Vector3d row(1.0, t, t * t);
      normal += row * row.transpose();
      right += values[i] * row;
      ++count;
    }
    if (count < window - 1) continue;
    const Eigen::Vector3d fit = normal.colPivHouseholderQr().solve(right);
    curvature[j] = 2.0 * fit[2] / (reach * reach);
  }
  return curvature;
}

}  // namespace

SurveyedMap survey(const ShapedMap& map, double width) {
  const CrossSections& cells = *map.sections;
  SurveyedMap surveyed{map,
                       Array2::Constant(cells.z.size(), cells.x.size(), kNan),
                       Array1::Constant(cells.x.size(), kNan),
                       {}};
  for (Index j = 0; j < cells.x.size(); ++j) {
    if (bridge(cells, j, width, surveyed.whole)) {
      surveyed.average[j] = surveyed.whole.col(j).mean();
    }
  }
  surveyed.curvature = curvatures(cells.x, surveyed.average);
  return surveyed;
}

BinVector slope_across(const BinVector& zeta, double bin_width) {
  const Index n = zeta.size();
  BinVector edge(n + 1);
  for (Index e = 2; e + 2 <= n; ++e) {
    edge[e] = (7.0 * (zeta[e - 1] + zeta[e]) - (zeta[e - 2] + zeta[e + 1])) / 12.0;
  }
  const Eigen::Vector4d first(25.0, -23.0, 13.0, -3.0), second(3.0, 13.0, -5.0, 1.0);
  const Eigen::Vector4d low = zeta.head<4>(), high = zeta.tail<4>().reverse();
  edge[0] = first.dot(low) / 12.0;
  edge[1] = second.dot(low) / 12.0;
  edge[n] = first.dot(high) / 12.0;
  edge[n - 1] = second.dot(high) / 12.0;
  return (edge.tail(n) - edge.head(n)) / bin_width;
}

}  // namespace manoscope::calibration

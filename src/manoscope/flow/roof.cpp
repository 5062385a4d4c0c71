#include "manoscope/flow/roof.hpp"

#include <fmt/format.h>

#include <Eigen/QR>
#include <cmath>

#include "manoscope/core/error.hpp"

namespace manoscope::flow {
namespace {

constexpr const char* kWhere = "shape of the wall across the channel";

}  // namespace

WallShape::WallShape(std::vector<double> even_powers) : coefficients_(std::move(even_powers)) {
  double mean = 0.0, size = 0.0;
  for (std::size_t k = 0; k < coefficients_.size(); ++k) {
    if (!std::isfinite(coefficients_[k])) {
      throw InputError(kWhere, fmt::format("coefficient {} is not finite", k),
                       "Give finite coefficients of 1, s^2, s^4 and so on");
    }
    mean += coefficients_[k] / (2.0 * static_cast<double>(k) + 1.0);
    size += std::abs(coefficients_[k]);
  }
  // Round-off of the sum: below it the mean has no digit left.
  if (!(std::abs(mean) > 1e-12 * size)) {
    throw InputError(kWhere, "its mean over the width is 0",
                     "Give a shape that moves the mean gap, such as 1 - s^2");
  }
  for (double& coefficient : coefficients_) coefficient /= mean;
}

WallShape WallShape::fit(const Array1& s, const Array1& zeta, int terms) {
  if (s.size() != zeta.size() || terms < 1 || s.size() <= terms) {
    throw InputError(kWhere,
                     fmt::format("{} deflections at {} positions for {} coefficients", zeta.size(),
                                 s.size(), terms),
                     "Give one deflection a position, and more positions than coefficients");
  }
  if (!(s.abs().maxCoeff() <= 1.0) || !zeta.isFinite().all()) {
    throw InputError(kWhere, "a position outside the width, or a deflection that is not finite",
                     "Give positions s = 2 z / width from -1 to 1 and finite deflections");
  }
  Matrix basis(s.size(), terms);
  basis.col(0) = (1.0 - s.square()).matrix();
  for (int k = 1; k < terms; ++k) {
    basis.col(k) = (basis.col(k - 1).array() * s.square()).matrix();
  }
  const Eigen::VectorXd fitted = basis.colPivHouseholderQr().solve(zeta.matrix());
  std::vector<double> powers(static_cast<std::size_t>(terms) + 1, 0.0);
  for (int k = 0; k < terms; ++k) {
    powers[static_cast<std::size_t>(k)] += fitted(k);
    powers[static_cast<std::size_t>(k) + 1] -= fitted(k);
  }
  return WallShape(std::move(powers));
}

double WallShape::value(double s) const {
  double sum = 0.0;
  for (std::size_t k = coefficients_.size(); k-- > 0;) sum = sum * s * s + coefficients_[k];
  return sum;
}

double WallShape::slope(double s) const {
  double sum = 0.0;
  for (std::size_t k = coefficients_.size(); k-- > 1;) {
    sum = sum * s * s + 2.0 * static_cast<double>(k) * coefficients_[k];
  }
  return sum * s;
}

Roof bulged_roof(Length width, Length height, Length mean_deflection, const WallShape& shape) {
  const double h = height.si(), zeta = mean_deflection.si();
  if (!(width.si() > 0.0) || !std::isfinite(width.si())) {
    throw InputError("section of the channel", fmt::format("its width is {:g} mm", width.in(mm)),
                     "Give a positive width such as \"1.7 mm\"");
  }
  for (const double s : {0.0, 1.0}) {
    const double gap = h + zeta * shape.value(s);
    if (gap > 0.0 && std::isfinite(gap)) continue;
    throw InputError("section of the channel",
                     fmt::format("the gap is {:.4g} um {}", gap * 1e6,
                                 s == 0.0 ? "in the middle" : "at the sides"),
                     "The gap must be positive; check the sign of zeta and the channel height");
  }
  return {width, [h, zeta, shape](double s) { return h + zeta * shape.value(s); },
          [zeta, shape](double s) { return zeta * shape.slope(s); }};
}

Roof flat_roof(Length width, Length height) {
  return bulged_roof(width, height, Length{}, WallShape::rigid());
}

}  // namespace manoscope::flow

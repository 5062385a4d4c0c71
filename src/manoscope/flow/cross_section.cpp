#include "manoscope/flow/cross_section.hpp"

#include <fmt/format.h>

#include <Eigen/Cholesky>
#include <algorithm>
#include <cmath>
#include <numbers>

#include "manoscope/core/error.hpp"
#include "manoscope/flow/spectral.hpp"

namespace manoscope::flow {
namespace {

constexpr const char* kWhere = "section of the channel";

/// The roof at the quadrature points across, in units of half the width.
struct SampledRoof {
  QuadratureRule rule;  ///< on [-1, 1]
  Array1 gap, slope;
  double left = 0.0, right = 0.0;  ///< gap at the sides
  bool symmetric = false;
};

SampledRoof sample(const Roof& roof, int n_points) {
  const double half = 0.5 * roof.width.si();
  if (!(half > 0.0) || !std::isfinite(half)) {
    throw InputError(kWhere, fmt::format("its width is {:g} mm", roof.width.in(mm)),
                     "Give a positive width such as \"1.7 mm\"");
  }
  SampledRoof sampled{gauss_legendre(n_points), Array1(n_points), Array1(n_points)};
  for (Index i = 0; i < n_points; ++i) {
    const double s = sampled.rule.nodes(i);
    sampled.gap(i) = roof.gap(s) / half;
    sampled.slope(i) = roof.slope(s) / half;
    if (sampled.gap(i) > 0.0 && std::isfinite(sampled.gap(i)) && std::isfinite(sampled.slope(i))) {
      continue;
    }
    throw InputError(kWhere,
                     fmt::format("the gap is {:.4g} um at z = {:.4g} of half the width",
                                 sampled.gap(i) * half * 1e6, s),
                     "The gap must be positive and finite; check the sign of zeta and the height");
  }
  sampled.left = std::max(0.0, roof.gap(-1.0) / half);
  sampled.right = std::max(0.0, roof.gap(1.0) / half);
  // Round-off of a symmetric formula.
  sampled.symmetric =
      ((sampled.gap - sampled.gap.reverse()).abs() < 1e-13 * sampled.gap.maxCoeff()).all();
  return sampled;
}

/// sum over q of weight(q) left(q, i) right(q, j).
Matrix weighted(const Matrix& left, const Array1& weight, const Matrix& right) {
  return left.transpose() * weight.matrix().asDiagonal() * right;
}

Matrix every_other_column(const Matrix& all) {
  Matrix even(all.rows(), (all.cols() + 1) / 2);
  for (Index k = 0; k < even.cols(); ++k) even.col(k) = all.col(2 * k);
  return even;
}

/// Basis functions across and up, at the quadrature points of each.
struct Basis {
  BubbleFunctions across, up;
  QuadratureRule up_rule;  ///< on [0, 1]
};

Basis make_basis(const SampledRoof& roof, int across, int up) {
  Basis basis{bubble_functions(roof.rule.nodes, across), {}, gauss_legendre(2 * up)};
  basis.up = bubble_functions(basis.up_rule.nodes, up);
  basis.up.slopes *= 2.0;  // t = (1 + tau)/2
  basis.up_rule.nodes = 0.5 * (1.0 + basis.up_rule.nodes);
  basis.up_rule.weights *= 0.5;
  if (roof.symmetric) {
    basis.across.values = every_other_column(basis.across.values);
    basis.across.slopes = every_other_column(basis.across.slopes);
  }
  return basis;
}

/// Coefficients (n_up, n_across) of u in the basis.
///
/// Weak form in s, t (half the width is 1): u_z = u_s - t h'/h u_t, u_y = u_t/h, dA = h ds dt.
Matrix solve(const SampledRoof& roof, const Basis& basis) {
  const Array1& h = roof.gap;
  const Array1& weight = roof.rule.weights;
  const Matrix& f = basis.across.values;
  const Matrix& df = basis.across.slopes;
  const Matrix s_slopes = weighted(df, weight * h, df);
  const Matrix s_mixed = weighted(df, weight * roof.slope, f);
  const Matrix s_tilt = weighted(f, weight * roof.slope.square() / h, f);
  const Matrix s_values = weighted(f, weight / h, f);

  const Array1& t = basis.up_rule.nodes;
  const Array1& up_weight = basis.up_rule.weights;
  const Matrix& g = basis.up.values;
  const Matrix& dg = basis.up.slopes;
  const Matrix t_values = weighted(g, up_weight, g);
  const Matrix t_mixed = weighted(g, up_weight * t, dg);
  const Matrix t_tilt = weighted(dg, up_weight * t.square(), dg);
  const Matrix t_slopes = weighted(dg, up_weight, dg);

  const Index n_across = f.cols(), n_up = g.cols();
  Matrix stiffness(n_across * n_up, n_across * n_up);
  for (Index k = 0; k < n_across; ++k) {
    for (Index i = 0; i < n_across; ++i) {
      stiffness.block(i * n_up, k * n_up, n_up, n_up) =
          s_slopes(i, k) * t_values - s_mixed(i, k) * t_mixed -
          s_mixed(k, i) * t_mixed.transpose() + s_tilt(i, k) * t_tilt + s_values(i, k) * t_slopes;
    }
  }
  const Eigen::VectorXd load_across = f.transpose() * (weight * h).matrix();
  const Eigen::VectorXd load_up = g.transpose() * up_weight.matrix();
  const Matrix load = load_up * load_across.transpose();
  const Eigen::LLT<Eigen::Ref<Matrix>> factor(stiffness);
  MANO_ASSERT(factor.info() == Eigen::Success);
  const Eigen::VectorXd solution =
      factor.solve(Eigen::Map<const Eigen::VectorXd>(load.data(), load.size()));
  return Eigen::Map<const Matrix>(solution.data(), n_up, n_across);
}

/// Slopes of the basis functions at one end: P_k(+-1) = (+-1)^k.
Eigen::VectorXd end_slopes(int degree, double end, bool symmetric) {
  const Matrix slopes = bubble_functions(Array1::Constant(1, end), degree).slopes;
  return (symmetric ? every_other_column(slopes) : slopes).row(0).transpose();
}

}  // namespace

int degree_for_gap(double width_over_gap) {
  // A side layer is e^(-pi (w/2h) (1 - |s|)): Chebyshev's coefficients fall as e^(-k^2/2c) with
  // c = pi w/2h, so that the degree grows with its root.
  const double decay = 0.5 * std::numbers::pi * std::clamp(width_over_gap, 0.0, 100.0);
  const int degree = 26 + static_cast<int>(std::ceil(6.0 * std::sqrt(decay)));
  return std::min(degree + degree % 2, 80);
}

void CrossSectionOptions::validate() const {
  if ((degree_across == 0 || (degree_across >= 4 && degree_across <= 200)) && degree_up >= 4 &&
      degree_up <= 60) {
    return;
  }
  throw InputError(
      kWhere, fmt::format("polynomials of degree {} across and {} up", degree_across, degree_up),
      "Give 0 or 4 to 200 across and 4 to 60 up");
}

CrossSection solve_cross_section(const Roof& roof, const CrossSectionOptions& options) {
  options.validate();
  const int wished = options.degree_across;
  SampledRoof sampled = sample(roof, wished > 0 ? 2 * wished : 64);
  const int across = wished > 0 ? wished : degree_for_gap(2.0 / sampled.gap.minCoeff());
  if (wished == 0) sampled = sample(roof, 2 * across);
  const Basis basis = make_basis(sampled, across, options.degree_up);
  const Matrix coefficients = solve(sampled, basis);

  const Array1& h = sampled.gap;
  const Array1& weight = sampled.rule.weights;
  const Array1 strip = weight * h;
  const Array1& up_weight = basis.up_rule.weights;
  const Array2 u =
      (basis.up.values * coefficients * basis.across.values.transpose()).array();  // (up, across)
  const auto integral = [&](const Array2& field) {
    return (up_weight.matrix().transpose() * field.matrix() * strip.matrix())(0, 0);
  };
  const double half = 0.5 * roof.width.si();
  const double area = strip.sum(), flux = integral(u);
  const Array1 arc = weight * (1.0 + sampled.slope.square()).sqrt();

  CrossSection result;
  result.area = area * half * half;
  result.mean_gap = 0.5 * area * half;
  result.roof_length = arc.sum() * half;
  result.side_height = (sampled.left + sampled.right) * half;
  result.perimeter = roof.width.si() + result.roof_length + result.side_height;
  result.conductance = flux * half * half * half * half;
  result.momentum_factor = area * integral(u.square()) / (flux * flux);
  result.energy_factor = area * area * integral(u.cube()) / (flux * flux * flux);

  // Slopes at the walls. Along the roof u = 0: |grad u| dS = |u_y| (1 + h'^2) dz.
  const int up = options.degree_up;
  const Matrix by_z = coefficients * basis.across.values.transpose();  // (n_up, quadrature)
  const Array1 floor =
      (2.0 * end_slopes(up, -1.0, false).transpose() * by_z).transpose().array() / h;
  const Array1 ceiling =
      (-2.0 * end_slopes(up, 1.0, false).transpose() * by_z).transpose().array() / h;
  result.floor_shear = 0.5 * (weight * floor).sum() * half;
  result.roof_shear = (weight * ceiling * (1.0 + sampled.slope.square())).sum() / arc.sum() * half;
  const Eigen::VectorXd by_y = (up_weight.matrix().transpose() * basis.up.values).transpose();
  const double left =
      by_y.dot(coefficients * end_slopes(across, -1.0, sampled.symmetric)) * sampled.left;
  const double right =
      -by_y.dot(coefficients * end_slopes(across, 1.0, sampled.symmetric)) * sampled.right;
  const double sides = sampled.left + sampled.right;
  result.side_shear = sides > 0.0 ? (left + right) / sides * half : 0.0;
  return result;
}

}  // namespace manoscope::flow

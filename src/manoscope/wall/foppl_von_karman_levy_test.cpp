// Large deflections of the clamped square plate: Levy's table, and an independent solution.
#include <gtest/gtest.h>

#include <Eigen/Dense>
#include <cmath>
#include <utility>
#include <vector>

#include "manoscope/wall/foppl_von_karman.hpp"

namespace manoscope::wall {
namespace {

constexpr double kPoisson = 0.316;

/// S. Levy, Square plate with clamped edges under normal pressure producing large deflections,
/// NACA TN 847 (1942) = NACA Rep. 740, table 5, nu = 0.316; reprinted by Timoshenko &
/// Woinowsky-Krieger. Load p w^4/(E t^4), centre deflection over t. His edges are clamped and do
/// not move across, but slide along themselves in the plane.
const std::vector<std::pair<double, double>> kLevy = {
    {17.79, 0.237}, {38.3, 0.471},  {63.4, 0.695},  {95.0, 0.912}, {134.9, 1.121},
    {184.0, 1.323}, {245.0, 1.521}, {318.0, 1.714}, {402.0, 1.902}};

struct Functions {
  Matrix value, slope, curvature;  // (functions, points)
};

/// Legendre polynomials of one parity times (1 - x^2)^power at points of [0, 1].
Functions polynomials(const Array1& x, int count, int first, int power) {
  const Index n = x.size();
  Functions made{Matrix(count, n), Matrix(count, n), Matrix(count, n)};
  const int top = 2 * count + 2;
  for (Index i = 0; i < n; ++i) {
    std::vector<double> p(top), d(top, 0.0), dd(top, 0.0);
    p[0] = 1.0;
    p[1] = x(i);
    d[1] = 1.0;
    for (int k = 1; k + 1 < top; ++k) {
      p[k + 1] = ((2 * k + 1) * x(i) * p[k] - k * p[k - 1]) / (k + 1);
      d[k + 1] = d[k - 1] + (2 * k + 1) * p[k];
      dd[k + 1] = dd[k - 1] + (2 * k + 1) * d[k];
    }
    const double gap = 1.0 - x(i) * x(i);
    const double m = std::pow(gap, power);
    const double m1 = power == 0 ? 0.0 : -2.0 * power * x(i) * std::pow(gap, power - 1);
    const double m2 = power == 2 ? 12.0 * x(i) * x(i) - 4.0 : (power == 1 ? -2.0 : 0.0);
    for (int k = 0; k < count; ++k) {
      const int at = 2 * k + first;
      made.value(k, i) = m * p[at];
      made.slope(k, i) = m1 * p[at] + m * d[at];
      made.curvature(k, i) = m2 * p[at] + 2.0 * m1 * d[at] + m * dd[at];
    }
  }
  return made;
}

/// All products of functions along x and along z at all points of the square: (points, functions).
Matrix products(const Matrix& along_x, const Matrix& along_z) {
  const Index count = along_x.rows(), n = along_x.cols();
  Matrix made(n * n, count * count);
  for (Index ix = 0; ix < n; ++ix) {
    for (Index iz = 0; iz < n; ++iz) {
      for (Index a = 0; a < count; ++a) {
        for (Index c = 0; c < count; ++c) {
          made(ix * n + iz, a * count + c) = along_x(a, ix) * along_z(c, iz);
        }
      }
    }
  }
  return made;
}

/// Ritz solution in global polynomials: another discretisation, another minimiser and other code
/// than the elements. Scaled like FvkModel, half side 1. Returns centre deflections over t.
std::vector<double> ritz(int count, bool sliding, const std::vector<double>& loads) {
  // Gauss-Legendre points by Golub & Welsch, on [0, 1]: everything is even.
  const Index n = 2 * count + 6;
  Matrix jacobi = Matrix::Zero(n, n);
  for (Index k = 1; k < n; ++k) {
    const auto square = static_cast<double>(k * k);
    jacobi(k, k - 1) = jacobi(k - 1, k) = std::sqrt(square / (4.0 * square - 1.0));
  }
  const Eigen::SelfAdjointEigenSolver<Matrix> gauss(jacobi);
  const Array1 x = 0.5 * (gauss.eigenvalues().array() + 1.0);
  const Array1 weight = gauss.eigenvectors().row(0).array().square().transpose();
  Array1 w(n * n);
  for (Index ix = 0; ix < n; ++ix) w.segment(ix * n, n) = weight(ix) * weight;

  const Functions plate = polynomials(x, count, 0, 2);
  const Functions across = polynomials(x, count, 1, 1);
  const Functions along = polynomials(x, count, 0, sliding ? 0 : 1);
  const Matrix value = products(plate.value, plate.value);
  const Matrix w_x = products(plate.slope, plate.value), w_z = products(plate.value, plate.slope);
  const Matrix w_xx = products(plate.curvature, plate.value),
               w_zz = products(plate.value, plate.curvature),
               w_xz = products(plate.slope, plate.slope);
  const Matrix u_x = products(across.slope, along.value), u_z = products(across.value, along.slope);
  // v(x, z) = u(z, x) with the same coefficients: the plate is square.
  const Matrix v_z = [&] {
    Matrix made(u_x.rows(), u_x.cols());
    for (Index ix = 0; ix < n; ++ix) {
      for (Index iz = 0; iz < n; ++iz) made.row(ix * n + iz) = u_x.row(iz * n + ix);
    }
    return made;
  }();
  const Matrix shear = [&] {
    Matrix made = u_z;
    for (Index ix = 0; ix < n; ++ix) {
      for (Index iz = 0; iz < n; ++iz) made.row(ix * n + iz) += u_z.row(iz * n + ix);
    }
    return made;
  }();
  const auto weighted = [&](const Matrix& a, const Array1& by, const Matrix& b) -> Matrix {
    return a.transpose() * (w * by).matrix().asDiagonal() * b;
  };
  const Array1 one = Array1::Ones(n * n);
  const Matrix lap = w_xx + w_zz, cross = weighted(w_xx, one, w_zz);
  const Matrix bending =
      (weighted(lap, one, lap) -
       (1.0 - kPoisson) * (cross + cross.transpose() - 2.0 * weighted(w_xz, one, w_xz))) /
      12.0;
  const Index m = count * count;
  Eigen::VectorXd q = Eigen::VectorXd::Zero(2 * m);
  std::vector<double> crests;
  const Array1 centre = Array1::Zero(1);
  const Functions middle = polynomials(centre, count, 0, 2);
  for (const double load : loads) {
    const double p = load * (1.0 - kPoisson * kPoisson) / 16.0;  // w = 2 a
    for (int step = 0; step < 30; ++step) {
      const Array1 s_x = (w_x * q.head(m)).array(), s_z = (w_z * q.head(m)).array();
      const Array1 e_x = (u_x * q.tail(m)).array() + 0.5 * s_x.square();
      const Array1 e_z = (v_z * q.tail(m)).array() + 0.5 * s_z.square();
      const Array1 g = (shear * q.tail(m)).array() + s_x * s_z;
      const double rest = 0.5 * (1.0 - kPoisson);
      const Array1 n_x = e_x + kPoisson * e_z, n_z = e_z + kPoisson * e_x, n_xz = rest * g;
      Matrix b_x(n * n, 2 * m), b_z(n * n, 2 * m), b_g(n * n, 2 * m);
      b_x << s_x.matrix().asDiagonal() * w_x, u_x;
      b_z << s_z.matrix().asDiagonal() * w_z, v_z;
      b_g << s_x.matrix().asDiagonal() * w_z + s_z.matrix().asDiagonal() * w_x, shear;
      Eigen::VectorXd gradient = b_x.transpose() * (w * n_x).matrix() +
                                 b_z.transpose() * (w * n_z).matrix() +
                                 b_g.transpose() * (w * n_xz).matrix();
      gradient.head(m) += bending * q.head(m) - p * value.transpose() * w.matrix();
      Matrix hessian = weighted(b_x, one, b_x + kPoisson * b_z) +
                       weighted(b_z, one, b_z + kPoisson * b_x) + rest * weighted(b_g, one, b_g);
      const Matrix twist = weighted(w_x, n_xz, w_z);
      hessian.topLeftCorner(m, m) +=
          bending + weighted(w_x, n_x, w_x) + weighted(w_z, n_z, w_z) + twist + twist.transpose();
      const Eigen::VectorXd change = hessian.ldlt().solve(gradient);
      q -= change;
      if (change.norm() < 1e-11 * q.norm()) break;
    }
    crests.push_back((products(middle.value, middle.value) * q.head(m))(0));
  }
  return crests;
}

std::vector<double> levy_loads() {
  std::vector<double> loads;
  for (const auto& row : kLevy) loads.push_back(row.first);
  return loads;
}

std::vector<double> by_elements(bool sliding) {
  ClampedWall plate{2.0 * mm, 2.0 * mm, 10.0 * um, 100.0 * GPa, kPoisson};
  plate.sliding_edges = sliding;
  FopplVonKarmanOptions options;
  options.n_cells_x = 32;
  options.n_cells_z = 16;
  const FopplVonKarman wall(plate, options);
  std::vector<double> crests;
  for (const double load : levy_loads()) {
    const Pressure p = load * std::pow(10e-6 / 2e-3, 4) * plate.youngs_modulus;
    crests.push_back(wall.equilibrium(WallLoad::uniform(p)).deflection(1e-3, 0.0) / 10e-6);
  }
  return crests;
}

TEST(FopplVonKarman, SquarePlateIsAnIndependentRitzSolutionForHeldAndSlidingEdges) {
  for (const bool sliding : {false, true}) {
    const std::vector<double> coarse = ritz(6, sliding, levy_loads());
    const std::vector<double> fine = ritz(8, sliding, levy_loads());
    const std::vector<double> found = by_elements(sliding);
    for (std::size_t i = 0; i < found.size(); ++i) {
      EXPECT_NEAR(coarse[i] / fine[i], 1.0, 2e-5) << kLevy[i].first;  // the reference has converged
      // 16 cells over the half side: a sixteenth of the 6e-5 between 8 and 16 cells.
      EXPECT_NEAR(found[i] / fine[i], 1.0, 2e-5) << kLevy[i].first;
    }
  }
}

TEST(FopplVonKarman, SquarePlateLiesBelowLevysTableByWhatItGrowsWithTheLoad) {
  // Both converged solutions above, elements and polynomials, agree to 2e-5 and lie below the
  // table: by 0.3 % in its first rows (one to two units of the last digit), growing to 2.0 % in the
  // last. So the table's digits are not those of the equations; a deflection too large that grows
  // with the load is what a double series of few terms would do, which we have not retraced. Edges
  // held both ways, as a bonded wall's, are 0.44 % stiffer still at the largest load.
  const std::vector<double> sliding = by_elements(true), held = by_elements(false);
  double before = 0.0;
  for (std::size_t i = 0; i < kLevy.size(); ++i) {
    const double below = 1.0 - sliding[i] / kLevy[i].second;
    EXPECT_GT(below, 0.0025) << kLevy[i].first;
    EXPECT_LT(below, 0.0200) << kLevy[i].first;
    EXPECT_GT(below, before - 1e-3 / kLevy[i].second) << kLevy[i].first;  // grows but for rounding
    before = below;
    if (i < 2) {
      EXPECT_NEAR(sliding[i], kLevy[i].second, 0.0020) << kLevy[i].first;
    }
    EXPECT_LT(held[i], sliding[i]);
    EXPECT_NEAR(held[i] / sliding[i], 1.0, 0.0045);
  }
}

}  // namespace
}  // namespace manoscope::wall

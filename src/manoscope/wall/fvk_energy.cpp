// Energy, gradient and Hessian of FvkModel: the integrals over the cells.
#include <cmath>

#include "manoscope/wall/fvk_model.hpp"

namespace manoscope::wall {

template <class Visit>
void FvkModel::for_each_cell(const Visit& visit) const {
  for (Index ix = 0; ix < x_.n_cells(); ++ix) {
    for (Index iz = 0; iz < z_.n_cells(); ++iz) visit(cell(ix, iz), cell_unknowns(ix, iz));
  }
}

FvkModel::Stretch FvkModel::stretch(const Vector& q, const Cell& at,
                                    const Unknowns& indices) const {
  const auto slope = [](const Points& functions, const Values& values) -> Values {
    return (functions * values.matrix()).array();
  };
  const double nu = coefficients_.poisson_ratio;
  Values deflection = gather(q, indices, b);
  if (n_fields_ > s) deflection += gather(q, indices, s);
  const Values along = gather(q, indices, u), across = gather(q, indices, v);
  const Values shape = gather(initial_shape_, indices, b);
  const Values shape_x = slope(at.x, shape), shape_z = slope(at.z, shape);
  Stretch made;
  made.w_x = slope(at.x, deflection);
  made.w_z = slope(at.z, deflection);
  made.e_x = slope(at.x, along) + 0.5 * (made.w_x.square() - shape_x.square());
  made.e_z = slope(at.z, across) + 0.5 * (made.w_z.square() - shape_z.square());
  made.g = slope(at.z, along) + slope(at.x, across) + made.w_x * made.w_z - shape_x * shape_z;
  made.n_x = made.e_x + nu * made.e_z;
  made.n_z = made.e_z + nu * made.e_x;
  made.n_xz = 0.5 * (1.0 - nu) * made.g;
  return made;
}

double FvkModel::energy(const Vector& q) const {
  double sum = 0.0;
  const double s0 = coefficients_.prestress;
  for_each_cell([&](const Cell& at, const Unknowns& indices) {
    const Stretch now = stretch(q, at, indices);
    sum += (at.weight * (0.5 * (now.e_x * now.n_x + now.e_z * now.n_z + now.g * now.n_xz) +
                         s0 * (now.e_x + now.e_z)))
               .sum();
    const Values bent = gather(q, indices, b) - gather(initial_shape_, indices, b);
    sum += 0.5 * bent.matrix().dot(bending_[at.index] * bent.matrix());
    if (n_fields_ > s) {
      const Values sheared = gather(q, indices, s);
      const Values slope_x = (at.x * sheared.matrix()).array();
      const Values slope_z = (at.z * sheared.matrix()).array();
      sum += 0.5 * coefficients_.shear * (at.weight * (slope_x.square() + slope_z.square())).sum();
    }
  });
  return sum;
}

FvkModel::Vector FvkModel::gradient(const Vector& q, Vector* magnitude) const {
  Vector made = Vector::Zero(n_unknowns());
  if (magnitude != nullptr) magnitude->setZero(n_unknowns());
  const double s0 = coefficients_.prestress;
  for_each_cell([&](const Cell& at, const Unknowns& indices) {
    const Stretch now = stretch(q, at, indices);
    const auto divergence = [&](const Values& flux_x, const Values& flux_z) -> Values {
      return (at.x.transpose() * (at.weight * flux_x).matrix() +
              at.z.transpose() * (at.weight * flux_z).matrix())
          .array();
    };
    const auto collect = [&](Field field, const Values& part) {
      for (int k = 0; k < 16; ++k) {
        const Index index = indices[16 * field + k];
        if (index < 0) continue;
        made(index) += part(k);
        if (magnitude != nullptr) (*magnitude)(index) += std::abs(part(k));
      }
    };
    // The uniform prestress does no work in-plane: no edge moves across itself.
    collect(u, divergence(now.n_x, now.n_xz));
    collect(v, divergence(now.n_xz, now.n_z));
    const Values tension = divergence((now.n_x + s0) * now.w_x + now.n_xz * now.w_z,
                                      (now.n_z + s0) * now.w_z + now.n_xz * now.w_x);
    const Values bent = gather(q, indices, b) - gather(initial_shape_, indices, b);
    collect(b, tension + (bending_[at.index] * bent.matrix()).array());
    if (n_fields_ > s) {
      const Values sheared = gather(q, indices, s);
      const Values slope_x = (at.x * sheared.matrix()).array();
      const Values slope_z = (at.z * sheared.matrix()).array();
      collect(s, tension + coefficients_.shear * divergence(slope_x, slope_z));
    }
  });
  return made;
}

void FvkModel::scatter(Index ix, const Unknowns& indices, Field row, Field column,
                       const Points& block, BlockTridiagonal& matrix) const {
  // Functions 0 to 7 belong to node column ix, 8 to 15 to ix + 1; block (ix, ix + 1) is implied.
  for (int i = 0; i < 16; ++i) {
    const Index gi = indices[16 * row + i];
    if (gi < 0) continue;
    for (int j = 0; j < 16; ++j) {
      const Index gj = indices[16 * column + j];
      if (gj < 0) continue;
      if (i < 8 && j < 8) {
        matrix.diagonal[ix](gi - offsets_[ix], gj - offsets_[ix]) += block(i, j);
      } else if (i >= 8 && j >= 8) {
        matrix.diagonal[ix + 1](gi - offsets_[ix + 1], gj - offsets_[ix + 1]) += block(i, j);
      } else if (i >= 8) {
        matrix.below[ix](gi - offsets_[ix + 1], gj - offsets_[ix]) += block(i, j);
      }
    }
  }
}

void FvkModel::add_hessian(const Vector& q, BlockTridiagonal& hessian) const {
  const double nu = coefficients_.poisson_ratio, rest = 0.5 * (1.0 - nu);
  const double s0 = coefficients_.prestress;
  for_each_cell([&](const Cell& at, const Unknowns& indices) {
    const Stretch now = stretch(q, at, indices);
    const auto pair = [&](Field row, Field column, const Points& block) {
      scatter(at.ix, indices, row, column, block, hessian);
      if (row != column) scatter(at.ix, indices, column, row, block.transpose(), hessian);
    };
    const Points x_t = at.x.transpose(), z_t = at.z.transpose();
    const auto scaled = [&](const Points& functions, const Values& by) -> Points {
      return (at.weight * by).matrix().asDiagonal() * functions;
    };
    const Values one = Values::Ones();
    const Points x1 = scaled(at.x, one), z1 = scaled(at.z, one);
    const Points xx = x_t * x1, zz = z_t * z1, xz = x_t * z1;
    pair(u, u, xx + rest * zz);
    pair(v, v, zz + rest * xx);
    pair(u, v, nu * xz + rest * xz.transpose());

    // Derivatives of the three forces with respect to the deflection.
    const Points n_x = scaled(at.x, now.w_x) + scaled(at.z, nu * now.w_z);
    const Points n_z = scaled(at.x, nu * now.w_x) + scaled(at.z, now.w_z);
    const Points n_xz = scaled(at.x, rest * now.w_z) + scaled(at.z, rest * now.w_x);
    const Points along = x_t * n_x + z_t * n_xz, across = x_t * n_xz + z_t * n_z;

    const Values a_xx = now.n_x + s0 + now.w_x.square() + rest * now.w_z.square();
    const Values a_xz = now.n_xz + (nu + rest) * now.w_x * now.w_z;
    const Values a_zz = now.n_z + s0 + now.w_z.square() + rest * now.w_x.square();
    const Points tension = x_t * (scaled(at.x, a_xx) + scaled(at.z, a_xz)) +
                           z_t * (scaled(at.x, a_xz) + scaled(at.z, a_zz));
    pair(u, b, along);
    pair(v, b, across);
    pair(b, b, tension + bending_[at.index]);
    if (n_fields_ > s) {
      pair(u, s, along);
      pair(v, s, across);
      pair(b, s, tension);
      pair(s, s, tension + coefficients_.shear * (xx + zz));
    }
  });
}

void FvkModel::add_geometric_stiffness(BlockTridiagonal& matrix) const {
  for_each_cell([&](const Cell& at, const Unknowns& indices) {
    const auto weight = at.weight.matrix().asDiagonal();
    const Points laplacian =
        at.x.transpose() * (weight * at.x) + at.z.transpose() * (weight * at.z);
    for (Index row = b; row < n_fields_; ++row) {
      for (Index column = b; column < n_fields_; ++column) {
        scatter(at.ix, indices, Field(row), Field(column), laplacian, matrix);
      }
    }
  });
}

}  // namespace manoscope::wall

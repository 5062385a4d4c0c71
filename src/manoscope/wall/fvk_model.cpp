#include "manoscope/wall/fvk_model.hpp"

#include <utility>

#include "manoscope/core/error.hpp"

namespace manoscope::wall {
namespace {

// Gauss-Legendre abscissae and weights on [0, 1].
constexpr std::array<double, 4> kGauss4 = {0.069431844202973712, 0.33000947820757187,
                                           0.66999052179242813, 0.93056815579702629};
constexpr std::array<double, 4> kWeight4 = {0.17392742256872693, 0.32607257743127307,
                                            0.32607257743127307, 0.17392742256872693};
constexpr std::array<double, 6> kGauss6 = {0.033765242898423989, 0.16939530676686774,
                                           0.38069040695840155,  0.61930959304159845,
                                           0.83060469323313226,  0.96623475710157601};
constexpr std::array<double, 6> kWeight6 = {0.085662246189585178, 0.18038078652406930,
                                            0.23395696728634552,  0.23395696728634552,
                                            0.18038078652406930,  0.085662246189585178};

/// Of the four functions along one axis: which node (0 first, 1 last) and whether its slope.
constexpr int node_of(int function) { return function / 2; }
constexpr int slope_of(int function) { return function % 2; }

}  // namespace

FvkModel::FvkModel(HermiteAxis x, HermiteAxis z, FvkCoefficients coefficients, bool symmetric)
    : x_(std::move(x)),
      z_(std::move(z)),
      coefficients_(coefficients),
      symmetric_(symmetric),
      n_fields_(coefficients.shear > 0.0 ? 4 : 3) {
  MANO_ASSERT(!symmetric || z_.first() == 0.0);
  unknowns_.assign(x_.n_nodes() * z_.n_nodes() * n_fields_ * 4, -1);
  offsets_.push_back(0);
  Index next = 0;
  for (Index ix = 0; ix < x_.n_nodes(); ++ix) {
    const bool x_edge = ix == 0 || ix == x_.n_nodes() - 1;
    for (Index iz = 0; iz < z_.n_nodes(); ++iz) {
      const bool mirror = symmetric_ && iz == 0;
      const bool z_edge = !mirror && (iz == 0 || iz == z_.n_nodes() - 1);
      for (Index field = 0; field < n_fields_; ++field) {
        for (int kind = 0; kind < 4; ++kind) {
          const bool x_slope = kind / 2 == 1, z_slope = kind % 2 == 1;
          bool held = false;
          if (field == b) {
            held = x_edge || z_edge;
          } else {
            const bool holds_x = !coefficients.sliding_edges || field != v;
            const bool holds_z = !coefficients.sliding_edges || field != u;
            held = (x_edge && holds_x && !x_slope) || (z_edge && holds_z && !z_slope);
          }
          if (mirror) held = held || (z_slope != (field == v));
          if (!held) unknowns_[((ix * z_.n_nodes() + iz) * n_fields_ + field) * 4 + kind] = next++;
        }
      }
    }
    offsets_.push_back(next);
  }
  for (Index ix = 0; ix < x_.n_cells(); ++ix) table_x_.push_back(table(x_.size(ix)));
  for (Index iz = 0; iz < z_.n_cells(); ++iz) table_z_.push_back(table(z_.size(iz)));
  for (Index ix = 0; ix < x_.n_cells(); ++ix) {
    for (Index iz = 0; iz < z_.n_cells(); ++iz) bending_.push_back(bending(ix, iz));
  }
  initial_shape_ = Vector::Zero(n_unknowns());
}

std::vector<Index> FvkModel::block_sizes() const {
  std::vector<Index> sizes;
  for (std::size_t k = 0; k + 1 < offsets_.size(); ++k) {
    sizes.push_back(offsets_[k + 1] - offsets_[k]);
  }
  return sizes;
}

FvkModel::CellTable FvkModel::table(double h) {
  CellTable made;
  for (std::size_t point = 0; point < 4; ++point) {
    made.value[point] = hermite(kGauss4[point], h, 0);
    made.slope[point] = hermite(kGauss4[point], h, 1);
    made.curvature[point] = hermite(kGauss4[point], h, 2);
  }
  return made;
}

FvkModel::Points FvkModel::products(const HermiteValues* along_x, const HermiteValues* along_z) {
  Points made;
  for (int px = 0; px < 4; ++px) {
    for (int pz = 0; pz < 4; ++pz) {
      for (int fx = 0; fx < 4; ++fx) {
        for (int fz = 0; fz < 4; ++fz) {
          made(4 * px + pz, 4 * fx + fz) = along_x[px][fx] * along_z[pz][fz];
        }
      }
    }
  }
  return made;
}

FvkModel::Cell FvkModel::cell(Index ix, Index iz) const {
  Cell made;
  made.ix = ix;
  made.index = ix * z_.n_cells() + iz;
  for (int px = 0; px < 4; ++px) {
    for (int pz = 0; pz < 4; ++pz) {
      made.weight(4 * px + pz) = kWeight4[px] * kWeight4[pz] * x_.size(ix) * z_.size(iz);
    }
  }
  made.x = products(table_x_[ix].slope.data(), table_z_[iz].value.data());
  made.z = products(table_x_[ix].value.data(), table_z_[iz].slope.data());
  return made;
}

FvkModel::Points FvkModel::bending(Index ix, Index iz) const {
  const Points xx = products(table_x_[ix].curvature.data(), table_z_[iz].value.data());
  const Points zz = products(table_x_[ix].value.data(), table_z_[iz].curvature.data());
  const Points xz = products(table_x_[ix].slope.data(), table_z_[iz].slope.data());
  const Cell at = cell(ix, iz);
  const auto weight = at.weight.matrix().asDiagonal();
  const double rest = 1.0 - coefficients_.poisson_ratio;
  const Points sum = xx + zz, cross = xx.transpose() * (weight * zz);
  return (sum.transpose() * (weight * sum) -
          rest * (cross + cross.transpose() - 2.0 * xz.transpose() * (weight * xz))) /
         12.0;
}

FvkModel::Unknowns FvkModel::cell_unknowns(Index ix, Index iz) const {
  Unknowns indices;
  indices.fill(-1);
  for (Index field = 0; field < n_fields_; ++field) {
    for (int fx = 0; fx < 4; ++fx) {
      for (int fz = 0; fz < 4; ++fz) {
        indices[16 * field + 4 * fx + fz] = unknown(ix + node_of(fx), iz + node_of(fz),
                                                    Field(field), 2 * slope_of(fx) + slope_of(fz));
      }
    }
  }
  return indices;
}

FvkModel::Values FvkModel::gather(const Vector& q, const Unknowns& indices, Field field) {
  Values values;
  for (int k = 0; k < 16; ++k) {
    const Index index = indices[16 * field + k];
    values(k) = index < 0 ? 0.0 : q(index);
  }
  return values;
}

FvkModel::Vector FvkModel::line_functional(const Vector& weights) const {
  MANO_ASSERT(weights.size() == 2 * x_.n_nodes());
  // int H dz of the functions of each z node, both neighbouring cells together.
  Vector across = Vector::Zero(2 * z_.n_nodes());
  for (Index iz = 0; iz < z_.n_cells(); ++iz) {
    const HermiteValues integral = hermite_integral(z_.size(iz));
    for (int f = 0; f < 4; ++f) across(2 * iz + f) += integral[f];
  }
  Vector made = Vector::Zero(n_unknowns());
  for (Index ix = 0; ix < x_.n_nodes(); ++ix) {
    for (Index iz = 0; iz < z_.n_nodes(); ++iz) {
      for (Index field = b; field < n_fields_; ++field) {
        for (int kind = 0; kind < 4; ++kind) {
          const Index index = unknown(ix, iz, Field(field), kind);
          if (index < 0) continue;
          made(index) = weights(2 * ix + kind / 2) * across(2 * iz + kind % 2);
        }
      }
    }
  }
  return made;
}

FvkModel::Vector FvkModel::load(const std::function<double(double, double)>& pressure) const {
  Vector made = Vector::Zero(n_unknowns());
  for (Index ix = 0; ix < x_.n_cells(); ++ix) {
    for (Index iz = 0; iz < z_.n_cells(); ++iz) {
      Values part = Values::Zero();
      const double area = x_.size(ix) * z_.size(iz);
      for (std::size_t px = 0; px < 6; ++px) {
        const HermiteValues along_x = hermite(kGauss6[px], x_.size(ix), 0);
        for (std::size_t pz = 0; pz < 6; ++pz) {
          const HermiteValues along_z = hermite(kGauss6[pz], z_.size(iz), 0);
          const double value = area * kWeight6[px] * kWeight6[pz] *
                               pressure(x_.node(ix) + kGauss6[px] * x_.size(ix),
                                        z_.node(iz) + kGauss6[pz] * z_.size(iz));
          for (int k = 0; k < 16; ++k) part(k) += value * along_x[k / 4] * along_z[k % 4];
        }
      }
      const auto indices = cell_unknowns(ix, iz);
      for (Index field = b; field < n_fields_; ++field) {
        for (int k = 0; k < 16; ++k) {
          const Index index = indices[16 * field + k];
          if (index >= 0) made(index) += part(k);
        }
      }
    }
  }
  return made;
}

double FvkModel::evaluate(const Vector& q, Field field, double x, double z, int dx, int dz) const {
  if (field >= n_fields_) return 0.0;
  const Index ix = x_.cell_of(x), iz = z_.cell_of(z);
  const HermiteValues along_x = hermite(x_.local(ix, x), x_.size(ix), dx);
  const HermiteValues along_z = hermite(z_.local(iz, z), z_.size(iz), dz);
  const Values values = gather(q, cell_unknowns(ix, iz), field);
  double sum = 0.0;
  for (int k = 0; k < 16; ++k) sum += values(k) * along_x[k / 4] * along_z[k % 4];
  return sum;
}

FvkModel::Vector FvkModel::prolong(const FvkModel& other, const Vector& q) const {
  Vector made = Vector::Zero(n_unknowns());
  for (Index ix = 0; ix < x_.n_nodes(); ++ix) {
    for (Index iz = 0; iz < z_.n_nodes(); ++iz) {
      for (Index field = 0; field < n_fields_; ++field) {
        for (int kind = 0; kind < 4; ++kind) {
          const Index index = unknown(ix, iz, Field(field), kind);
          if (index < 0) continue;
          made(index) =
              other.evaluate(q, Field(field), x_.node(ix), z_.node(iz), kind / 2, kind % 2);
        }
      }
    }
  }
  return made;
}

}  // namespace manoscope::wall

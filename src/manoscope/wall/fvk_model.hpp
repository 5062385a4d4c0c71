#pragma once

#include <array>
#include <functional>
#include <utility>
#include <vector>

#include "manoscope/wall/block_tridiagonal.hpp"
#include "manoscope/wall/hermite_grid.hpp"

namespace manoscope::wall {

/// Coefficients of the scaled Foeppl-von Karman energy; see FvkModel.
struct FvkCoefficients {
  double poisson_ratio = 0.0;
  double prestress = 0.0;  ///< s0 (1 - nu^2)/E (a/t)^2
  double shear = 0.0;      ///< kappa (1 - nu)/2 (a/t)^2; 0 = rigid in shear
  /// Edges may move along themselves (u free where z is an end, v where x is), never across.
  bool sliding_edges = false;
};

/// Scaled elastic energy of a shallow clamped plate on a grid, its gradient and exact Hessian.
///
/// Lengths in the plane are counted in a (half the width), deflections in t, in-plane displacements
/// in t^2/a, pressures in E t^4/((1 - nu^2) a^4), energy in E t^5/((1 - nu^2) a^2). Then
///
///   e_xx = u_x + (w_x^2 - w0_x^2)/2,  e_zz = v_z + (w_z^2 - w0_z^2)/2,
///   g_xz = u_z + v_x + w_x w_z - w0_x w0_z,  w = b + s,
///   U = int 1/2 (e_xx^2 + e_zz^2 + 2 nu e_xx e_zz + (1 - nu)/2 g_xz^2) + prestress (e_xx + e_zz)
///         + 1/24 [(k_xx + k_zz)^2 - 2 (1 - nu)(k_xx k_zz - k_xz^2)] + shear/2 |grad s|^2,
///   k = second derivatives of b - w0.
///
/// b is the part of the deflection that bends the wall (the cross-sections turn by -grad b), s the
/// part that shears it; without shear flexibility s is absent. That is Mindlin's plate with
/// rotations that are a gradient: exact for a strip, slightly stiff within about t of a corner.
///
/// All fields are bicubic Hermite functions (value, both slopes and twist at each node:
/// Bogner-Fox-Schmit); edges hold u = v = s = 0 (or slide) and b = 0, grad b = 0. Integrals by 4 x
/// 4 Gauss points a cell, one quadrature for energy, gradient and Hessian, so that the derivatives
/// are exact. Unknowns run node column by node column along x: the Hessian is block-tridiagonal.
class FvkModel {
 public:
  using Vector = Eigen::VectorXd;
  enum Field { u = 0, v = 1, b = 2, s = 3 };

  /// @param symmetric  The grid covers 0 <= z <= 1 and z = 0 is a plane of mirror symmetry.
  FvkModel(HermiteAxis x, HermiteAxis z, FvkCoefficients coefficients, bool symmetric);

  const HermiteAxis& x() const { return x_; }
  const HermiteAxis& z() const { return z_; }
  const FvkCoefficients& coefficients() const { return coefficients_; }
  bool symmetric() const { return symmetric_; }
  Index n_unknowns() const { return offsets_.back(); }
  std::vector<Index> block_sizes() const;

  /// Stress-free shape w0, as unknowns of b (zero elsewhere).
  void set_initial_shape(Vector shape) { initial_shape_ = std::move(shape); }
  void set_prestress(double prestress) { coefficients_.prestress = prestress; }
  const Vector& initial_shape() const { return initial_shape_; }

  /// Elastic energy U; that of the modelled half if the model is symmetric.
  double energy(const Vector& q) const;
  /// dU/dq; `magnitude`, where asked for, adds up the moduli of the cells' parts: the scale that
  /// a residual is to be judged by.
  Vector gradient(const Vector& q, Vector* magnitude = nullptr) const;
  /// d2U/dq2 is added to `hessian`, which has block_sizes().
  void add_hessian(const Vector& q, BlockTridiagonal& hessian) const;
  /// The part of the Hessian that is due to a unit prestress.
  void add_geometric_stiffness(BlockTridiagonal& matrix) const;

  /// Work-conjugate load of a pressure f(x) that is given by its integrals with the Hermite
  /// functions of x: weights(2 i) with the value function of node i, weights(2 i + 1) with its
  /// slope function. Also the functional int w dz at a station, from the functions' values there.
  Vector line_functional(const Vector& weights) const;
  /// Load of any pressure p(x, z), by 6 x 6 Gauss points a cell.
  Vector load(const std::function<double(double, double)>& pressure) const;

  /// Value or derivative of a field at a point of the grid.
  double evaluate(const Vector& q, Field field, double x, double z, int dx = 0, int dz = 0) const;
  /// Index of the unknown of a node, kind 0: value, 1: z slope, 2: x slope, 3: twist; -1 if held.
  Index unknown(Index ix, Index iz, Field field, int kind) const {
    return unknowns_[((ix * z_.n_nodes() + iz) * n_fields_ + field) * 4 + kind];
  }
  Index n_fields() const { return n_fields_; }
  /// The fields of another grid's solution, sampled at the nodes of this one.
  Vector prolong(const FvkModel& other, const Vector& q) const;

 private:
  using Points = Eigen::Matrix<double, 16, 16>;  // (Gauss points, functions) or (functions)^2
  using Values = Eigen::Array<double, 16, 1>;
  using Unknowns = std::array<Index, 64>;  // of a cell's functions, field by field; -1 if held
  struct CellTable {
    std::array<HermiteValues, 4> value, slope, curvature;  // at the four Gauss points
  };
  /// What an integral over one cell needs: weights and slopes of the 16 functions at its points.
  struct Cell {
    Index ix, index;  ///< column, and place in bending_
    Values weight;
    Points x, z;
  };
  /// Slopes of the deflection, strains, and stretching forces without the prestress, at the points.
  struct Stretch {
    Values w_x, w_z, e_x, e_z, g, n_x, n_z, n_xz;
  };

  Cell cell(Index ix, Index iz) const;
  /// visit(cell, unknowns) for all cells, in their order.
  template <class Visit>
  void for_each_cell(const Visit& visit) const;
  Unknowns cell_unknowns(Index ix, Index iz) const;
  static Values gather(const Vector& q, const Unknowns& indices, Field field);
  Stretch stretch(const Vector& q, const Cell& at, const Unknowns& indices) const;
  static CellTable table(double h);
  static Points products(const HermiteValues* along_x, const HermiteValues* along_z);
  Points bending(Index ix, Index iz) const;
  void scatter(Index ix, const Unknowns& indices, Field row, Field column, const Points& block,
               BlockTridiagonal& matrix) const;

  HermiteAxis x_, z_;
  FvkCoefficients coefficients_;
  bool symmetric_;
  Index n_fields_;
  std::vector<Index> unknowns_, offsets_;
  std::vector<CellTable> table_x_, table_z_;
  std::vector<Points> bending_;
  Vector initial_shape_;
};

}  // namespace manoscope::wall

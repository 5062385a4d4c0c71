#pragma once

#include <deal.II/base/quadrature_lib.h>
#include <deal.II/fe/fe_values.h>
#include <deal.II/lac/affine_constraints.h>
#include <deal.II/lac/petsc_sparse_matrix.h>
#include <deal.II/lac/petsc_vector.h>

#include <array>
#include <vector>

#include "discrete_flow.hpp"
#include "linear_solver.hpp"

namespace manoscope::navier_stokes {

/// The given values of a problem.
template <int dim>
struct GivenValues {
  using Discrete = typename FlowSolver<dim>::Discrete;

  explicit GivenValues(const Discrete& discrete)
      : fixed(discrete.relevant), value(discrete.zero_state()) {}

  dealii::AffineConstraints<double> fixed;  ///< changes that must be 0
  typename Discrete::State value;           ///< 0 where none is given
};

/// Finds the given values: where two sides meet, walls win, for fluid that enters at a wall stands
/// still there. Without an open side the pressure of one node is given, too.
template <int dim>
GivenValues<dim> find_given_values(const typename FlowSolver<dim>::Discrete& discrete);

/// Assembles residual and derivative of the weak form.
template <int dim>
class FlowAssembler {
 public:
  using Discrete = typename FlowSolver<dim>::Discrete;
  using Matrix = dealii::PETScWrappers::MPI::SparseMatrix;
  using PetscVector = dealii::PETScWrappers::MPI::Vector;

  FlowAssembler(const Discrete& discrete, const dealii::AffineConstraints<double>& fixed);

  /// Weight of the grad-div term over the Reynolds number.
  void set_grad_div(double weight) { grad_div_ = weight; }
  double grad_div() const { return grad_div_; }
  /// The derivative at the state and minus the residual there.
  void assemble(double reynolds);

  const Matrix& matrix() const { return matrix_; }
  const PetscVector& right() const { return right_; }
  FlowBlocks blocks() const;
  double n_unknowns() const;

 private:
  using Block = Eigen::MatrixXd;

  template <class Cell>
  void take_shapes(const Cell& cell);
  void take_cell(double reynolds, const typename Discrete::Local& local);
  Block forces() const;

  const Discrete& discrete_;
  const dealii::AffineConstraints<double>& fixed_;
  dealii::QGauss<dim> quadrature_;
  dealii::FEValues<dim> velocity_values_, pressure_values_;
  unsigned int n_q_, n_v_, n_p_;
  Block phi_, psi_;                  // (q, node)
  std::array<Block, dim> gradient_;  // [axis](q, node)
  Eigen::VectorXd weight_;           // (q)
  Block block_;                      // (local, local)
  Eigen::VectorXd rest_;             // (local)
  double grad_div_ = 0.0;
  Matrix matrix_;
  PetscVector right_;
};

}  // namespace manoscope::navier_stokes

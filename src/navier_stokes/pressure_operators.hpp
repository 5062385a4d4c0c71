#pragma once

#include <deal.II/base/quadrature_lib.h>
#include <deal.II/fe/fe_values.h>
#include <deal.II/lac/affine_constraints.h>
#include <deal.II/lac/full_matrix.h>
#include <deal.II/lac/petsc_sparse_matrix.h>

#include "discrete_flow.hpp"

namespace manoscope::navier_stokes {

/// What stands for the momentum equation among the pressures, (degrees of freedom) with entries for
/// pressures alone: mass (q, p); stiffness (grad q, grad p), p = 0 on open sides; and transport
/// Re (q, u . grad p) + (q, s p), with Re (q, -u . n p) over faces where fluid enters.
///
/// s = 12/h^2 is the drag of the walls on a flow that follows a pressure which hardly changes from
/// wall to wall. Without it the pressures of a long channel, which are nearly all such, would be
/// off by (length/h)^2: see BlockSolver.
template <int dim>
class PressureOperators {
 public:
  using Discrete = typename FlowSolver<dim>::Discrete;
  using Matrix = dealii::PETScWrappers::MPI::SparseMatrix;

  explicit PressureOperators(const Discrete& discrete);

  /// Assembles them for the state.
  void assemble(double reynolds);

  const Matrix& mass() const { return mass_; }
  const Matrix& stiffness() const { return stiffness_; }
  const Matrix& transport() const { return transport_; }

 private:
  void add_inflow(const typename dealii::Triangulation<dim>::cell_iterator& cell, unsigned int face,
                  const typename Discrete::Local& local, double reynolds,
                  dealii::FullMatrix<double>& transport);
  double wall_drag(const CellIndex<dim>& index) const;

  const Discrete& discrete_;
  dealii::AffineConstraints<double> open_, none_;
  dealii::QGauss<dim - 1> face_quadrature_;
  dealii::FEFaceValues<dim> of_inflow_velocity_, of_inflow_pressure_;
  Matrix mass_, stiffness_, transport_;
};

}  // namespace manoscope::navier_stokes

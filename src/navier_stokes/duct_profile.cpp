#include "duct_profile.hpp"

#include <deal.II/base/quadrature_lib.h>
#include <deal.II/dofs/dof_handler.h>
#include <deal.II/dofs/dof_tools.h>
#include <deal.II/fe/fe_q.h>
#include <deal.II/fe/fe_values.h>
#include <deal.II/lac/affine_constraints.h>
#include <deal.II/lac/dynamic_sparsity_pattern.h>
#include <deal.II/lac/precondition.h>
#include <deal.II/lac/solver_cg.h>
#include <deal.II/lac/sparse_matrix.h>
#include <deal.II/lac/vector.h>

#include <array>
#include <memory>

#include "lattice_mesh.hpp"
#include "processes.hpp"

namespace manoscope::navier_stokes {
namespace {

/// The finite-element solution on the section, axes (z, t); each process solves it for itself.
struct Section {
  Section(const std::vector<double>& z_edges, const std::vector<double>& t_edges,
          const std::function<double(double z)>& gap, int order)
      : mesh(Processes::all().alone(),
             {{z_edges, t_edges},
              {},
              [&gap](const std::array<double, 2>& chart) {
                return std::array<double, 2>{chart[0], chart[1] * gap(chart[0])};
              }},
             order),
        element(order),
        dofs(mesh.triangulation()) {
    dofs.distribute_dofs(element);
  }

  LatticeMesh<2> mesh;
  dealii::FE_Q<2> element;
  dealii::DoFHandler<2> dofs;
  dealii::Vector<double> value;  ///< one a degree of freedom
};

void solve(Section& section) {
  dealii::AffineConstraints<double> walls;
  for (const dealii::types::boundary_id side : {1, 2, 3}) {  // not the plane of symmetry, 0
    dealii::DoFTools::make_zero_boundary_constraints(section.dofs, side, walls);
  }
  walls.close();
  const auto n_dofs = section.dofs.n_dofs();
  dealii::DynamicSparsityPattern found(n_dofs);
  dealii::DoFTools::make_sparsity_pattern(section.dofs, found, walls, true);
  dealii::SparsityPattern pattern;
  pattern.copy_from(found);
  dealii::SparseMatrix<double> matrix(pattern);
  dealii::Vector<double> right(n_dofs);

  const dealii::QGauss<2> quadrature(section.element.degree + 1);
  dealii::FEValues<2> values(
      section.mesh.mapping(), section.element, quadrature,
      dealii::update_values | dealii::update_gradients | dealii::update_JxW_values);
  const unsigned int n = section.element.n_dofs_per_cell();
  std::vector<dealii::types::global_dof_index> local(n);
  dealii::FullMatrix<double> block(n, n);
  dealii::Vector<double> load(n);
  for (const auto& cell : section.dofs.active_cell_iterators()) {
    values.reinit(cell);
    cell->get_dof_indices(local);
    block = 0.0;
    load = 0.0;
    for (const unsigned int q : values.quadrature_point_indices()) {
      for (unsigned int i = 0; i < n; ++i) {
        for (unsigned int j = 0; j < n; ++j) {
          block(i, j) += values.shape_grad(i, q) * values.shape_grad(j, q) * values.JxW(q);
        }
        load(i) += values.shape_value(i, q) * values.JxW(q);
      }
    }
    walls.distribute_local_to_global(block, load, local, matrix, right);
  }
  section.value.reinit(n_dofs);
  constexpr double kSmall = 1e-13;
  dealii::SolverControl control(10 * n_dofs, kSmall * right.l2_norm());
  dealii::PreconditionSSOR<dealii::SparseMatrix<double>> preconditioner;
  preconditioner.initialize(matrix, 1.2);
  dealii::SolverCG<dealii::Vector<double>>(control).solve(matrix, section.value, right,
                                                          preconditioner);
  walls.distribute(section.value);
}

}  // namespace

std::function<double(double t, double z)> duct_profile(const std::vector<double>& z_edges,
                                                       const std::vector<double>& t_edges,
                                                       const std::function<double(double z)>& gap,
                                                       int order) {
  const auto section = std::make_shared<Section>(z_edges, t_edges, gap, order);
  solve(*section);
  return [section](double t, double z) {
    const auto located = section->mesh.locate({z, t});
    const auto cell = section->mesh.own_cell(section->dofs, located.index);
    std::vector<dealii::types::global_dof_index> local(section->element.n_dofs_per_cell());
    (*cell)->get_dof_indices(local);
    double sum = 0.0;
    for (unsigned int i = 0; i < local.size(); ++i) {
      sum += section->value[local[i]] * section->element.shape_value(i, located.unit);
    }
    return sum;
  };
}

}  // namespace manoscope::navier_stokes

#include "duct_profile.hpp"

#include <deal.II/base/quadrature_lib.h>
#include <deal.II/dofs/dof_handler.h>
#include <deal.II/fe/fe_q.h>
#include <deal.II/fe/fe_values.h>

#include <algorithm>
#include <memory>

#include "cell_place.hpp"
#include "dof_pattern.hpp"
#include "mapped_box.hpp"
#include "sparse_direct.hpp"

namespace manoscope::navier_stokes {
namespace {

/// The finite-element solution on the section, axes (z, t).
struct Section {
  Section(const std::vector<double>& z_edges, const std::vector<double>& t_edges,
          const std::function<double(double z)>& gap, int order)
      : edges{z_edges, t_edges},
        box(
            edges, [&gap](double z, double) { return gap(z); }, order),
        element(order),
        dofs(box.triangulation) {
    dofs.distribute_dofs(element);
  }

  std::array<std::vector<double>, 2> edges;
  MappedBox<2> box;
  dealii::FE_Q<2> element;
  dealii::DoFHandler<2> dofs;
  std::vector<double> value;  ///< one a degree of freedom
};

/// Degrees of freedom on the walls: everywhere but on z = 0.
std::vector<char> on_walls(const Section& section) {
  std::vector<char> result(section.dofs.n_dofs(), 0);
  std::vector<dealii::types::global_dof_index> local(section.element.n_dofs_per_cell());
  for (const auto& cell : section.dofs.active_cell_iterators()) {
    cell->get_dof_indices(local);
    for (const unsigned int face : cell->face_indices()) {
      if (!cell->face(face)->at_boundary() || cell->face(face)->boundary_id() == 0) continue;
      for (unsigned int i = 0; i < local.size(); ++i) {
        if (section.element.has_support_on_face(i, face)) result[local[i]] = 1;
      }
    }
  }
  return result;
}

void solve(Section& section) {
  DofPattern pattern(section.dofs, on_walls(section),
                     [](unsigned int, unsigned int) { return true; });
  SparseMatrix matrix = pattern.matrix();
  std::vector<double> right(static_cast<std::size_t>(pattern.n_free()), 0.0);
  const dealii::QGauss<2> quadrature(section.element.degree + 1);
  dealii::FEValues<2> values(
      section.box.mapping, section.element, quadrature,
      dealii::update_values | dealii::update_gradients | dealii::update_JxW_values);
  const unsigned int n = section.element.n_dofs_per_cell();
  std::vector<dealii::types::global_dof_index> local(n);
  Eigen::MatrixXd block(n, n);
  for (const auto& cell : section.dofs.active_cell_iterators()) {
    values.reinit(cell);
    cell->get_dof_indices(local);
    block.setZero();
    for (const unsigned int q : values.quadrature_point_indices()) {
      for (unsigned int i = 0; i < n; ++i) {
        for (unsigned int j = 0; j < n; ++j) {
          block(i, j) += values.shape_grad(i, q) * values.shape_grad(j, q) * values.JxW(q);
        }
        const int row = pattern.free_index(local[i]);
        if (row >= 0) right[row] += values.shape_value(i, q) * values.JxW(q);
      }
    }
    pattern.add(local, block, matrix);
  }
  const std::vector<double> free = SparseDirect().solve(matrix, right);
  section.value.assign(section.dofs.n_dofs(), 0.0);
  for (unsigned int i = 0; i < section.dofs.n_dofs(); ++i) {
    if (pattern.free_index(i) >= 0) section.value[i] = free[pattern.free_index(i)];
  }
}

}  // namespace

std::function<double(double t, double z)> duct_profile(const std::vector<double>& z_edges,
                                                       const std::vector<double>& t_edges,
                                                       const std::function<double(double z)>& gap,
                                                       int order) {
  const auto section = std::make_shared<Section>(z_edges, t_edges, gap, order);
  solve(*section);
  return [section](double t, double z) {
    const CellPlace<2> place = CellPlace<2>::of(section->edges, {z, t});
    const auto cell = place.cell(section->dofs);
    std::vector<dealii::types::global_dof_index> local(section->element.n_dofs_per_cell());
    cell->get_dof_indices(local);
    double sum = 0.0;
    for (unsigned int i = 0; i < local.size(); ++i) {
      sum += section->value[local[i]] * section->element.shape_value(i, place.unit_point());
    }
    return sum;
  };
}

}  // namespace manoscope::navier_stokes

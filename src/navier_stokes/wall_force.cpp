// The force on the cells taken out of a lattice.
#include <deal.II/base/quadrature_lib.h>
#include <deal.II/fe/fe_values.h>

#include <vector>

#include "discrete_flow.hpp"

namespace manoscope::navier_stokes {
namespace {

/// Minus the residual of the momentum equation, tested with the function v that is 1 at the nodes
/// on walls of cells taken out and 0 at all others.
template <int dim>
class WallForce {
 public:
  using Discrete = typename FlowSolver<dim>::Discrete;

  explicit WallForce(const Discrete& discrete)
      : discrete_(discrete),
        quadrature_(static_cast<unsigned int>(discrete.problem.order) + 2),  // as it was solved
        of_velocity_(discrete.mesh.mapping(), discrete.velocity_element, quadrature_,
                     dealii::update_values | dealii::update_gradients | dealii::update_JxW_values |
                         dealii::update_quadrature_points),
        of_pressure_(discrete.mesh.mapping(), discrete.pressure_element, quadrature_,
                     dealii::update_values),
        indices_(discrete.element.n_dofs_per_cell()),
        on_wall_(discrete.relevant.n_elements(), 0) {
    mark_nodes();
  }

  Vector<dim> of_all_processes() {
    std::vector<double> force(dim, 0.0);
    for (const auto& cell : discrete_.dofs.active_cell_iterators()) {
      if (!cell->is_locally_owned()) continue;
      cell->get_dof_indices(indices_);
      std::vector<unsigned int> nodes;  // of this cell, where v is 1
      for (unsigned int a = 0; a < of_velocity_.dofs_per_cell; ++a) {
        if (mark(indices_[discrete_.element.component_to_system_index(0, a)]) != 0) {
          nodes.push_back(a);
        }
      }
      if (!nodes.empty()) add(cell, nodes, force);
    }
    force = discrete_.processes.sum(force);
    Vector<dim> result;
    for (int c = 0; c < dim; ++c) result[c] = force[c];
    return result;
  }

 private:
  using Slope = dealii::Tensor<1, dim>;

  char& mark(typename Discrete::DofIndex dof) {
    return on_wall_[discrete_.relevant.index_within_set(dof)];
  }

  void mark_nodes() {
    for (const auto& cell : discrete_.dofs.active_cell_iterators()) {
      if (cell->is_artificial()) continue;
      cell->get_dof_indices(indices_);
      for (const unsigned int face : cell->face_indices()) {
        if (!cell->face(face)->at_boundary()) continue;
        if (cell->face(face)->boundary_id() != LatticeMesh<dim>::inner_side) continue;
        for (unsigned int a = 0; a < of_velocity_.dofs_per_cell; ++a) {
          const auto first = discrete_.element.component_to_system_index(0, a);
          // Of a cell beside those held, some are beyond what is relevant here.
          if (!discrete_.relevant.is_element(indices_[first])) continue;
          if (discrete_.element.has_support_on_face(first, face)) mark(indices_[first]) = 1;
        }
      }
    }
  }

  template <class Cell>
  void add(const Cell& cell, const std::vector<unsigned int>& nodes, std::vector<double>& force) {
    const auto local = discrete_.local_state(indices_);
    const typename dealii::Triangulation<dim>::cell_iterator plain_cell(cell);
    of_velocity_.reinit(plain_cell);
    of_pressure_.reinit(plain_cell);
    const double reynolds = discrete_.problem.reynolds;
    for (const unsigned int q : of_velocity_.quadrature_point_indices()) {
      double v = 0.0, p = 0.0;
      Slope v_slope, u;
      std::array<Slope, dim> u_slope;
      for (const unsigned int a : nodes) {
        v += of_velocity_.shape_value(a, q);
        v_slope += of_velocity_.shape_grad(a, q);
      }
      for (unsigned int a = 0; a < of_velocity_.dofs_per_cell; ++a) {
        for (int c = 0; c < dim; ++c) {
          u[c] += local.velocity(a, c) * of_velocity_.shape_value(a, q);
          u_slope[c] += local.velocity(a, c) * of_velocity_.shape_grad(a, q);
        }
      }
      for (unsigned int k = 0; k < of_pressure_.dofs_per_cell; ++k) {
        p += local.pressure(k) * of_pressure_.shape_value(k, q);
      }
      double divergence = 0.0;
      for (int c = 0; c < dim; ++c) divergence += u_slope[c][c];
      const double mean_stress = discrete_.grad_div * reynolds * divergence - p;
      Vector<dim> given{};
      if (discrete_.problem.force) {
        Vector<dim> place;
        for (int c = 0; c < dim; ++c) place[c] = of_velocity_.quadrature_point(q)[c];
        given = discrete_.problem.force(place);
      }
      for (int c = 0; c < dim; ++c) {
        force[c] -= of_velocity_.JxW(q) * (v * (reynolds * (u * u_slope[c]) - given[c]) +
                                           v_slope * u_slope[c] + mean_stress * v_slope[c]);
      }
    }
  }

  const Discrete& discrete_;
  dealii::QGauss<dim> quadrature_;
  dealii::FEValues<dim> of_velocity_, of_pressure_;
  std::vector<typename Discrete::DofIndex> indices_;
  std::vector<char> on_wall_;  ///< (relevant degrees of freedom), first component of each node
};

}  // namespace

template <int dim>
Vector<dim> FlowSolver<dim>::force_on_solids() const {
  return WallForce<dim>(*discrete_).of_all_processes();
}

template Vector<2> FlowSolver<2>::force_on_solids() const;
template Vector<3> FlowSolver<3>::force_on_solids() const;

}  // namespace manoscope::navier_stokes

#include "flow_assembly.hpp"

#include <deal.II/dofs/dof_tools.h>
#include <deal.II/lac/dynamic_sparsity_pattern.h>
#include <deal.II/lac/full_matrix.h>
#include <deal.II/lac/sparsity_tools.h>

#include "manoscope/core/error.hpp"

namespace manoscope::navier_stokes {
namespace {

template <int dim>
Vector<dim> plain(const dealii::Point<dim>& point) {
  Vector<dim> result;
  for (int axis = 0; axis < dim; ++axis) result[axis] = point[axis];
  return result;
}

template <int dim>
class GivenValuesFinder {
 public:
  using Discrete = typename FlowSolver<dim>::Discrete;
  using DofIndex = typename Discrete::DofIndex;

  explicit GivenValuesFinder(const Discrete& discrete)
      : discrete_(discrete),
        element_(discrete.element),
        given_(discrete),
        local_(element_.n_dofs_per_cell()) {}

  GivenValues<dim> find() {
    bool open = false;
    for (const SideCondition condition :
         {SideCondition::wall, SideCondition::velocity, SideCondition::slip}) {
      for_faces([&](const auto& cell, unsigned int face, int side) {
        if (condition_of(cell, face, side) == condition) fix(cell, face, side, condition);
      });
    }
    for (const Side<dim>& side : discrete_.problem.sides) {
      open = open || side.condition == SideCondition::open;
    }
    if (!open) fix_one_pressure();
    if (discrete_.problem.inlet_flow) scale_inlet(*discrete_.problem.inlet_flow);
    given_.value.update_ghost_values();
    given_.fixed.close();
    return std::move(given_);
  }

 private:
  using Mesh = LatticeMesh<dim>;

  template <class Visit>
  void for_faces(const Visit& visit) {
    for (const auto& cell : discrete_.dofs.active_cell_iterators()) {
      if (cell->is_artificial()) continue;
      for (const unsigned int face : cell->face_indices()) {
        if (!cell->face(face)->at_boundary()) continue;
        const int side = static_cast<int>(cell->face(face)->boundary_id());
        if (side != Mesh::elsewhere) visit(cell, face, side);
      }
    }
  }

  template <class Cell>
  SideCondition condition_of(const Cell& cell, unsigned int face, int side) const {
    if (side == Mesh::inner_side) return SideCondition::wall;
    const SideCondition condition = discrete_.problem.sides[side].condition;
    const bool before = cell->face(face)->center()[0] < discrete_.problem.slip_before;
    return before && condition == SideCondition::wall ? SideCondition::slip : condition;
  }

  template <class Cell>
  void fix(const Cell& cell, unsigned int face, int side, SideCondition condition) {
    cell->get_dof_indices(local_);
    for (unsigned int i = 0; i < local_.size(); ++i) {
      const int component = static_cast<int>(element_.system_to_component_index(i).first);
      if (component == dim || !discrete_.relevant.is_element(local_[i])) continue;
      if (given_.fixed.is_constrained(local_[i]) || !element_.has_support_on_face(i, face))
        continue;
      if (condition == SideCondition::slip && component != side / 2) continue;
      given_.fixed.add_line(local_[i]);
      if (condition != SideCondition::velocity) continue;
      const auto place = discrete_.mesh.mapping().transform_unit_to_real_cell(
          cell, element_.unit_support_point(i));
      given_.value(local_[i]) = discrete_.problem.sides[side].velocity(plain(place))[component];
    }
  }

  void fix_one_pressure() {
    const auto& cell = discrete_.dofs.begin_active();  // the lowest that the process holds
    const auto first = discrete_.mesh.index_of(cell);
    if (first[0] != 0) return;
    cell->get_dof_indices(local_);
    given_.fixed.add_line(local_[element_.component_to_system_index(dim, 0)]);
  }

  /// Scales the given velocities so that `wanted` flows in.
  void scale_inlet(double wanted) {
    const dealii::QGauss<dim - 1> quadrature(discrete_.problem.order + 1);
    dealii::FEFaceValues<dim> values(
        discrete_.mesh.mapping(), discrete_.velocity_element, quadrature,
        dealii::update_values | dealii::update_JxW_values | dealii::update_normal_vectors);
    double flow = 0.0;
    for_faces([&](const auto& cell, unsigned int face, int side) {
      if (!cell->is_locally_owned()) return;
      if (condition_of(cell, face, side) != SideCondition::velocity) return;
      cell->get_dof_indices(local_);
      values.reinit(typename dealii::Triangulation<dim>::cell_iterator(cell), face);
      for (unsigned int a = 0; a < discrete_.velocity_element.n_dofs_per_cell(); ++a) {
        for (int c = 0; c < dim; ++c) {
          const double u = given_.value(local_[element_.component_to_system_index(c, a)]);
          for (const unsigned int q : values.quadrature_point_indices()) {
            flow -= u * values.shape_value(a, q) * values.normal_vector(q)[c] * values.JxW(q);
          }
        }
      }
    });
    flow = discrete_.processes.sum(flow);
    MANO_ASSERT(flow != 0.0);
    for (unsigned int i = 0; i < given_.value.locally_owned_size(); ++i) {
      given_.value.local_element(i) *= wanted / flow;
    }
  }

  const Discrete& discrete_;
  const dealii::FESystem<dim>& element_;
  GivenValues<dim> given_;
  std::vector<DofIndex> local_;
};

/// Pairs of unknowns that share an entry: all but those of p among themselves.
template <int dim>
dealii::Table<2, dealii::DoFTools::Coupling> couplings() {
  dealii::Table<2, dealii::DoFTools::Coupling> table(dim + 1, dim + 1);
  table.fill(dealii::DoFTools::always);
  table(dim, dim) = dealii::DoFTools::none;
  return table;
}

}  // namespace

template <int dim>
GivenValues<dim> find_given_values(const typename FlowSolver<dim>::Discrete& discrete) {
  return GivenValuesFinder<dim>(discrete).find();
}

template <int dim>
FlowAssembler<dim>::FlowAssembler(const Discrete& discrete,
                                  const dealii::AffineConstraints<double>& fixed)
    : discrete_(discrete),
      fixed_(fixed),
      quadrature_(discrete.problem.order + 2),
      velocity_values_(discrete.mesh.mapping(), discrete.velocity_element, quadrature_,
                       dealii::update_values | dealii::update_gradients |
                           dealii::update_JxW_values | dealii::update_quadrature_points),
      pressure_values_(discrete.mesh.mapping(), discrete.pressure_element, quadrature_,
                       dealii::update_values),
      n_q_(quadrature_.size()),
      n_v_(discrete.velocity_element.n_dofs_per_cell()),
      n_p_(discrete.pressure_element.n_dofs_per_cell()) {
  dealii::DynamicSparsityPattern pattern(discrete.relevant);
  dealii::DoFTools::make_sparsity_pattern(discrete.dofs, couplings<dim>(), pattern, fixed, false);
  const MPI_Comm comm = discrete.processes.comm();
  dealii::SparsityTools::distribute_sparsity_pattern(pattern, discrete.owned, comm,
                                                     discrete.relevant);
  matrix_.reinit(discrete.owned, discrete.owned, pattern, comm);
  right_.reinit(discrete.owned, comm);
}

template <int dim>
double FlowAssembler<dim>::n_unknowns() const {
  double n = 0.0;
  for (const auto dof : discrete_.owned) n += fixed_.is_constrained(dof) ? 0.0 : 1.0;
  return discrete_.processes.sum(n);
}

template <int dim>
FlowBlocks FlowAssembler<dim>::blocks() const {
  FlowBlocks blocks;
  std::vector<typename Discrete::DofIndex> indices(discrete_.element.n_dofs_per_cell());
  std::vector<char> seen(discrete_.owned.n_elements(), 0);
  const auto take = [&](unsigned int component, unsigned int node, std::vector<int>& list) {
    const auto dof = indices[discrete_.element.component_to_system_index(component, node)];
    if (!discrete_.owned.is_element(dof)) return;
    char& known = seen[discrete_.owned.index_within_set(dof)];
    if (known == 0) list.push_back(static_cast<int>(dof));
    known = 1;
  };
  blocks.n_components = dim;
  for (const auto& cell : discrete_.dofs.active_cell_iterators()) {
    if (!cell->is_locally_owned()) continue;
    cell->get_dof_indices(indices);
    for (unsigned int a = 0; a < n_v_; ++a) {
      for (unsigned int c = 0; c < dim; ++c) take(c, a, blocks.velocity);
    }
    for (unsigned int k = 0; k < n_p_; ++k) take(dim, k, blocks.pressure);
  }
  return blocks;
}

template <int dim>
void FlowAssembler<dim>::assemble(double reynolds) {
  matrix_ = 0.0;
  right_ = 0.0;
  std::vector<typename Discrete::DofIndex> indices(discrete_.element.n_dofs_per_cell());
  const auto n = static_cast<unsigned int>(indices.size());
  dealii::FullMatrix<double> block(n, n);
  dealii::Vector<double> rest(n);
  for (const auto& cell : discrete_.dofs.active_cell_iterators()) {
    if (!cell->is_locally_owned()) continue;
    cell->get_dof_indices(indices);
    take_shapes(cell);
    take_cell(reynolds, discrete_.local_state(indices));
    for (unsigned int i = 0; i < n; ++i) {
      rest(i) = -rest_(i);
      for (unsigned int j = 0; j < n; ++j) block(i, j) = block_(i, j);
    }
    fixed_.distribute_local_to_global(block, rest, indices, matrix_, right_);
  }
  matrix_.compress(dealii::VectorOperation::add);
  right_.compress(dealii::VectorOperation::add);
}

template <int dim>
template <class Cell>
void FlowAssembler<dim>::take_shapes(const Cell& cell) {
  const typename dealii::Triangulation<dim>::cell_iterator plain_cell(cell);
  velocity_values_.reinit(plain_cell);
  pressure_values_.reinit(plain_cell);
  phi_.resize(n_q_, n_v_);
  psi_.resize(n_q_, n_p_);
  weight_.resize(n_q_);
  for (Block& gradient : gradient_) gradient.resize(n_q_, n_v_);
  for (unsigned int q = 0; q < n_q_; ++q) {
    weight_(q) = velocity_values_.JxW(q);
    for (unsigned int a = 0; a < n_v_; ++a) {
      phi_(q, a) = velocity_values_.shape_value(a, q);
      const auto& slope = velocity_values_.shape_grad(a, q);
      for (int axis = 0; axis < dim; ++axis) gradient_[axis](q, a) = slope[axis];
    }
    for (unsigned int k = 0; k < n_p_; ++k) psi_(q, k) = pressure_values_.shape_value(k, q);
  }
}

/// Residual and derivative of one cell from the shapes taken.
template <int dim>
void FlowAssembler<dim>::take_cell(double reynolds, const typename Discrete::Local& local) {
  const auto& element = discrete_.element;
  const auto n = static_cast<Eigen::Index>(element.n_dofs_per_cell());
  block_.setZero(n, n);
  rest_.setZero(n);
  const Block u = phi_ * local.velocity;  // (q, component)
  std::array<Block, dim> slope;           // [axis](q, component)
  Eigen::VectorXd divergence = Eigen::VectorXd::Zero(n_q_);
  Block carried = Block::Zero(n_q_, n_v_);  // u . grad of every shape
  for (int axis = 0; axis < dim; ++axis) {
    slope[axis] = gradient_[axis] * local.velocity;
    divergence += slope[axis].col(axis);
    carried += u.col(axis).asDiagonal() * gradient_[axis];
  }
  const Eigen::VectorXd p = psi_ * local.pressure;
  const Block weighted_phi = weight_.asDiagonal() * phi_;
  const Block weighted_psi = weight_.asDiagonal() * psi_;

  Block friction = reynolds * weighted_phi.transpose() * carried;  // and convection by u
  for (int axis = 0; axis < dim; ++axis) {
    friction += gradient_[axis].transpose() * weight_.asDiagonal() * gradient_[axis];
  }
  const double stiffness = grad_div_ * reynolds;
  const Block force = forces();
  const Eigen::VectorXd continuity = -weighted_psi.transpose() * divergence;
  for (unsigned int k = 0; k < n_p_; ++k) {
    rest_(element.component_to_system_index(dim, k)) = continuity(k);
  }
  for (int c = 0; c < dim; ++c) {
    const Eigen::VectorXd momentum = friction * local.velocity.col(c) -
                                     gradient_[c].transpose() * weight_.cwiseProduct(p) -
                                     weighted_phi.transpose() * force.col(c);
    const Block pressure = -gradient_[c].transpose() * weighted_psi;
    for (unsigned int a = 0; a < n_v_; ++a) {
      const unsigned int row = element.component_to_system_index(c, a);
      rest_(row) = momentum(a);
      for (unsigned int b = 0; b < n_v_; ++b) {
        block_(row, element.component_to_system_index(c, b)) = friction(a, b);
      }
      for (unsigned int k = 0; k < n_p_; ++k) {
        const unsigned int column = element.component_to_system_index(dim, k);
        block_(row, column) = block_(column, row) = pressure(a, k);
      }
    }
    const Block weighted_slope = stiffness * gradient_[c].transpose() * weight_.asDiagonal();
    const Eigen::VectorXd more = weighted_slope * divergence;
    for (unsigned int a = 0; a < n_v_; ++a) {
      rest_(element.component_to_system_index(c, a)) += more(a);
    }
    if (reynolds == 0.0) continue;
    for (int d = 0; d < dim; ++d) {  // convection by the change of u, and the grad-div term
      const Block turned =
          reynolds * weighted_phi.transpose() * slope[d].col(c).asDiagonal() * phi_ +
          weighted_slope * gradient_[d];
      for (unsigned int a = 0; a < n_v_; ++a) {
        for (unsigned int b = 0; b < n_v_; ++b) {
          block_(element.component_to_system_index(c, a),
                 element.component_to_system_index(d, b)) += turned(a, b);
        }
      }
    }
  }
}

/// f at the quadrature points, (q, component).
template <int dim>
typename FlowAssembler<dim>::Block FlowAssembler<dim>::forces() const {
  Block force = Block::Zero(n_q_, dim);
  if (!discrete_.problem.force) return force;
  for (unsigned int q = 0; q < n_q_; ++q) {
    const Vector<dim> f = discrete_.problem.force(plain(velocity_values_.quadrature_point(q)));
    for (int c = 0; c < dim; ++c) force(q, c) = f[c];
  }
  return force;
}

template GivenValues<2> find_given_values<2>(const FlowSolver<2>::Discrete&);
template GivenValues<3> find_given_values<3>(const FlowSolver<3>::Discrete&);
template class FlowAssembler<2>;
template class FlowAssembler<3>;

}  // namespace manoscope::navier_stokes

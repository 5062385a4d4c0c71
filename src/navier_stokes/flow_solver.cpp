#include "flow_solver.hpp"

#include <fmt/format.h>

#include <Eigen/Core>
#include <algorithm>
#include <cmath>

#include "discrete_flow.hpp"
#include "manoscope/core/error.hpp"

namespace manoscope::navier_stokes {
namespace {

constexpr const char* kWhere = "Navier-Stokes solver";

/// Weight of the grad-div term over the Reynolds number, where it is needed: ten times as much
/// moves the drop by as much as a coarse mesh does.
constexpr double kGradDiv = 0.01;

template <int dim>
Vector<dim> plain(const dealii::Point<dim>& point) {
  Vector<dim> result;
  for (int axis = 0; axis < dim; ++axis) result[axis] = point[axis];
  return result;
}

template <int dim>
void check(const FlowProblem<dim>& problem) {
  constexpr int kLeastOrder = 2, kLargestOrder = 4;
  if (problem.order < kLeastOrder || problem.order > kLargestOrder) {
    throw InputError(kWhere, fmt::format("elements of order {}", problem.order),
                     fmt::format("Choose an order from {} to {}", kLeastOrder, kLargestOrder));
  }
  for (const std::vector<double>& edges : problem.edges) {
    const bool ascending =
        std::adjacent_find(edges.begin(), edges.end(), std::greater_equal<>()) == edges.end();
    if (edges.size() >= 2 && ascending) continue;
    throw InputError(kWhere, "the edges of the cells do not ascend",
                     "Give at least one cell along each axis, and distinct positions");
  }
}

/// The given values of a problem.
struct GivenValues {
  std::vector<char> fixed;  ///< (degrees of freedom) 1 where a value is given
  std::vector<double> value;
};

template <int dim>
class BoundaryValues {
 public:
  using Discrete = typename FlowSolver<dim>::Discrete;
  using DofIndex = typename Discrete::DofIndex;

  explicit BoundaryValues(const Discrete& discrete)
      : discrete_(discrete),
        given_{std::vector<char>(discrete.dofs.n_dofs(), 0),
               std::vector<double>(discrete.dofs.n_dofs(), 0.0)},
        of_inlet_(discrete.dofs.n_dofs(), 0) {}

  GivenValues find() {
    // Where two sides meet, walls win: fluid that enters at a wall stands still there.
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
    return given_;
  }

 private:
  template <class Visit>
  void for_faces(const Visit& visit) {
    for (const auto& cell : discrete_.dofs.active_cell_iterators()) {
      for (const unsigned int face : cell->face_indices()) {
        if (cell->face(face)->at_boundary()) {
          visit(cell, face, static_cast<int>(cell->face(face)->boundary_id()));
        }
      }
    }
  }

  template <class Cell>
  SideCondition condition_of(const Cell& cell, unsigned int face, int side) const {
    const SideCondition condition = discrete_.problem.sides[side].condition;
    const bool before = cell->face(face)->center()[0] < discrete_.problem.slip_before;
    return before && condition == SideCondition::wall ? SideCondition::slip : condition;
  }

  template <class Cell>
  void fix(const Cell& cell, unsigned int face, int side, SideCondition condition) {
    const auto& element = discrete_.element;
    std::vector<DofIndex> local(element.n_dofs_per_cell());
    cell->get_dof_indices(local);
    for (unsigned int i = 0; i < local.size(); ++i) {
      const int component = static_cast<int>(element.system_to_component_index(i).first);
      if (component == dim || given_.fixed[local[i]] != 0) continue;
      if (!element.has_support_on_face(i, face)) continue;
      if (condition == SideCondition::slip && component != side / 2) continue;
      given_.fixed[local[i]] = 1;
      if (condition != SideCondition::velocity) continue;
      const auto place =
          discrete_.box.mapping.transform_unit_to_real_cell(cell, element.unit_support_point(i));
      given_.value[local[i]] = discrete_.problem.sides[side].velocity(plain(place))[component];
      if (side == SideName::inlet) of_inlet_[local[i]] = 1;
    }
  }

  void fix_one_pressure() {
    const auto& element = discrete_.element;
    std::vector<DofIndex> local(element.n_dofs_per_cell());
    discrete_.dofs.begin_active()->get_dof_indices(local);
    given_.fixed[local[element.component_to_system_index(dim, 0)]] = 1;
  }

  void scale_inlet(double wanted) {
    const dealii::QGauss<dim - 1> quadrature(discrete_.problem.order + 1);
    dealii::FEFaceValues<dim> values(discrete_.box.mapping, discrete_.velocity_element, quadrature,
                                     dealii::update_values | dealii::update_JxW_values);
    std::vector<DofIndex> local(discrete_.element.n_dofs_per_cell());
    double flow = 0.0;
    for_faces([&](const auto& cell, unsigned int face, int side) {
      if (side != SideName::inlet) return;
      cell->get_dof_indices(local);
      values.reinit(typename dealii::Triangulation<dim>::cell_iterator(cell), face);
      for (unsigned int a = 0; a < discrete_.velocity_element.n_dofs_per_cell(); ++a) {
        const double u = given_.value[local[discrete_.element.component_to_system_index(0, a)]];
        for (const unsigned int q : values.quadrature_point_indices()) {
          flow += u * values.shape_value(a, q) * values.JxW(q);
        }
      }
    });
    MANO_ASSERT(flow != 0.0);
    for (std::size_t i = 0; i < given_.value.size(); ++i) {
      if (of_inlet_[i] != 0) given_.value[i] *= wanted / flow;
    }
  }

  const Discrete& discrete_;
  GivenValues given_;
  std::vector<char> of_inlet_;
};

/// Assembles residual and derivative of the weak form.
template <int dim>
class Assembler {
 public:
  using Discrete = typename FlowSolver<dim>::Discrete;

  Assembler(const Discrete& discrete, const DofPattern& pattern)
      : discrete_(discrete),
        pattern_(pattern),
        quadrature_(discrete.problem.order + 2),
        velocity_values_(discrete.box.mapping, discrete.velocity_element, quadrature_,
                         dealii::update_values | dealii::update_gradients |
                             dealii::update_JxW_values | dealii::update_quadrature_points),
        pressure_values_(discrete.box.mapping, discrete.pressure_element, quadrature_,
                         dealii::update_values),
        n_q_(quadrature_.size()),
        n_v_(discrete.velocity_element.n_dofs_per_cell()),
        n_p_(discrete.pressure_element.n_dofs_per_cell()) {}

  void set_grad_div(double weight) { grad_div_ = weight; }

  /// The derivative into `matrix`; @return minus the residual, (unknowns).
  std::vector<double> assemble(double reynolds, SparseMatrix& matrix) {
    std::fill(matrix.value.begin(), matrix.value.end(), 0.0);
    std::vector<double> right(static_cast<std::size_t>(pattern_.n_free()), 0.0);
    std::vector<typename Discrete::DofIndex> indices(discrete_.element.n_dofs_per_cell());
    for (const auto& cell : discrete_.dofs.active_cell_iterators()) {
      cell->get_dof_indices(indices);
      take_shapes(cell);
      take_cell(reynolds, discrete_.local_state(indices));
      pattern_.add(indices, block_, matrix);
      for (std::size_t i = 0; i < indices.size(); ++i) {
        const int row = pattern_.free_index(indices[i]);
        if (row >= 0) right[row] -= rest_(static_cast<Eigen::Index>(i));
      }
    }
    return right;
  }

 private:
  using Matrix = Eigen::MatrixXd;

  template <class Cell>
  void take_shapes(const Cell& cell) {
    const typename dealii::Triangulation<dim>::cell_iterator plain_cell(cell);
    velocity_values_.reinit(plain_cell);
    pressure_values_.reinit(plain_cell);
    phi_.resize(n_q_, n_v_);
    psi_.resize(n_q_, n_p_);
    weight_.resize(n_q_);
    for (Matrix& gradient : gradient_) gradient.resize(n_q_, n_v_);
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
  void take_cell(double reynolds, const typename Discrete::Local& local) {
    const auto& element = discrete_.element;
    const auto n = static_cast<Eigen::Index>(element.n_dofs_per_cell());
    block_.setZero(n, n);
    rest_.setZero(n);
    const Matrix u = phi_ * local.velocity;  // (q, component)
    std::array<Matrix, dim> slope;           // [axis](q, component)
    Eigen::VectorXd divergence = Eigen::VectorXd::Zero(n_q_);
    Matrix carried = Matrix::Zero(n_q_, n_v_);  // u . grad of every shape
    for (int axis = 0; axis < dim; ++axis) {
      slope[axis] = gradient_[axis] * local.velocity;
      divergence += slope[axis].col(axis);
      carried += u.col(axis).asDiagonal() * gradient_[axis];
    }
    const Eigen::VectorXd p = psi_ * local.pressure;
    const Matrix weighted_phi = weight_.asDiagonal() * phi_;
    const Matrix weighted_psi = weight_.asDiagonal() * psi_;

    Matrix friction = reynolds * weighted_phi.transpose() * carried;  // and convection by u
    for (int axis = 0; axis < dim; ++axis) {
      friction += gradient_[axis].transpose() * weight_.asDiagonal() * gradient_[axis];
    }
    const double stiffness = grad_div_ * reynolds;
    const Matrix force = forces();
    const Eigen::VectorXd continuity = -weighted_psi.transpose() * divergence;
    for (unsigned int k = 0; k < n_p_; ++k) {
      rest_(element.component_to_system_index(dim, k)) = continuity(k);
    }
    for (int c = 0; c < dim; ++c) {
      const Eigen::VectorXd momentum = friction * local.velocity.col(c) -
                                       gradient_[c].transpose() * weight_.cwiseProduct(p) -
                                       weighted_phi.transpose() * force.col(c);
      const Matrix pressure = -gradient_[c].transpose() * weighted_psi;
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
      const Matrix weighted_slope = stiffness * gradient_[c].transpose() * weight_.asDiagonal();
      const Eigen::VectorXd more = weighted_slope * divergence;
      for (unsigned int a = 0; a < n_v_; ++a) {
        rest_(element.component_to_system_index(c, a)) += more(a);
      }
      if (reynolds == 0.0) continue;
      for (int d = 0; d < dim; ++d) {  // convection by the change of u, and the grad-div term
        const Matrix turned =
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
  Matrix forces() const {
    Matrix force = Matrix::Zero(n_q_, dim);
    if (!discrete_.problem.force) return force;
    for (unsigned int q = 0; q < n_q_; ++q) {
      const Vector<dim> f = discrete_.problem.force(plain(velocity_values_.quadrature_point(q)));
      for (int c = 0; c < dim; ++c) force(q, c) = f[c];
    }
    return force;
  }

  const Discrete& discrete_;
  const DofPattern& pattern_;
  dealii::QGauss<dim> quadrature_;
  dealii::FEValues<dim> velocity_values_, pressure_values_;
  unsigned int n_q_, n_v_, n_p_;
  Matrix phi_, psi_;                  // (q, node)
  std::array<Matrix, dim> gradient_;  // [axis](q, node)
  Eigen::VectorXd weight_;            // (q)
  Matrix block_;                      // (local, local)
  Eigen::VectorXd rest_;              // (local)
  double grad_div_ = 0.0;             // over the Reynolds number
};

/// Newton's iteration, Reynolds number by Reynolds number.
template <int dim>
class Newton {
 public:
  using Discrete = typename FlowSolver<dim>::Discrete;

  Newton(Discrete& discrete, const std::vector<char>& fixed, const Monitor& monitor)
      : discrete_(discrete),
        monitor_(monitor),
        pattern_(discrete.dofs, fixed,
                 [&element = discrete.element](unsigned int i, unsigned int j) {
                   return element.system_to_component_index(i).first < dim ||
                          element.system_to_component_index(j).first < dim;
                 }),
        assembler_(discrete, pattern_),
        matrix_(pattern_.matrix()),
        is_pressure_(discrete.dofs.n_dofs(), 0) {
    std::vector<typename Discrete::DofIndex> local(discrete.element.n_dofs_per_cell());
    for (const auto& cell : discrete.dofs.active_cell_iterators()) {
      cell->get_dof_indices(local);
      for (unsigned int i = 0; i < local.size(); ++i) {
        if (discrete.element.system_to_component_index(i).first == dim) is_pressure_[local[i]] = 1;
      }
    }
    discrete_.n_unknowns = pattern_.n_free();
  }

  void set_grad_div(double weight) { assembler_.set_grad_div(weight); }

  /// Raises the Reynolds number from that of Stokes flow, in steps that halve where the iteration
  /// fails; @return the share that is reached before they are smaller than `least_step`.
  double follow(const std::vector<double>& given, double least_step) {
    discrete_.state = given;
    converges(0.0);
    double reached = 0.0, step = 1.0;
    while (reached < 1.0 && step >= least_step && discrete_.problem.reynolds > 0.0) {
      const double target = std::min(1.0, reached + step);
      const std::vector<double> before = discrete_.state;
      if (converges(target * discrete_.problem.reynolds)) {
        reached = target;
        continue;
      }
      discrete_.state = before;
      step /= 2.0;
    }
    return discrete_.problem.reynolds > 0.0 ? reached : 1.0;
  }

 private:
  /// @return false if the iteration does not converge; the state is then of no use.
  bool converges(double reynolds) {
    constexpr int kMostSteps = 12;
    // Steps shrink quadratically: what is left behind the last is far smaller than it.
    constexpr double kSmall = 1e-8, kLost = 1e3;
    constexpr int kWandering = 5;  // steps by which a start that leads anywhere has come near
    double before = kLost;
    for (int i = 0; i < kMostSteps; ++i) {
      const double change = step(reynolds);
      if (reynolds == 0.0 || change <= kSmall) return true;  // Stokes flow is linear
      if (!(change < kLost) || (i >= kWandering && change > 0.5 * before)) return false;
      before = change;
    }
    return false;
  }

  /// One step; @return the larger of its parts in u and p, each of the largest value.
  double step(double reynolds) {
    monitor_.checkpoint();
    const std::vector<double> right = assembler_.assemble(reynolds, matrix_);
    const std::vector<double> change = solver_.solve(matrix_, right);
    discrete_.largest_residual = std::max(discrete_.largest_residual, solver_.residual());
    ++discrete_.n_newton_steps;
    std::array<double, 2> largest_change{}, largest_value{};
    for (std::size_t i = 0; i < discrete_.state.size(); ++i) {
      const int k = pattern_.free_index(static_cast<typename Discrete::DofIndex>(i));
      if (k >= 0) discrete_.state[i] += change[k];
      double& value = largest_value[is_pressure_[i]];
      value = std::max(value, std::abs(discrete_.state[i]));
      if (k < 0) continue;
      double& moved = largest_change[is_pressure_[i]];
      moved = std::max(moved, std::abs(change[k]));
    }
    double result = 0.0;
    for (int part = 0; part < 2; ++part) {
      if (largest_value[part] > 0.0) {
        result = std::max(result, largest_change[part] / largest_value[part]);
      }
    }
    return result;
  }

  Discrete& discrete_;
  const Monitor& monitor_;
  DofPattern pattern_;
  Assembler<dim> assembler_;
  SparseMatrix matrix_;
  SparseDirect solver_;
  std::vector<char> is_pressure_;
};

}  // namespace

template <int dim>
FlowSolver<dim>::FlowSolver(const FlowProblem<dim>& problem) {
  check(problem);
  discrete_ = std::make_unique<Discrete>(problem);
}

template <int dim>
FlowSolver<dim>::~FlowSolver() = default;
template <int dim>
FlowSolver<dim>::FlowSolver(FlowSolver&&) noexcept = default;

template <int dim>
void FlowSolver<dim>::solve(const Monitor& monitor) {
  const GivenValues given = BoundaryValues<dim>(*discrete_).find();
  Newton<dim> newton(*discrete_, given.fixed, monitor);
  constexpr double kAtOnce = 1.0, kLeastStep = 1.0 / 64.0;
  if (newton.follow(given.value, kAtOnce) == 1.0) return;
  newton.set_grad_div(kGradDiv);
  const double reached = newton.follow(given.value, kLeastStep);
  if (reached == 1.0) return;
  throw InputError(kWhere,
                   fmt::format("no steady flow is found beyond Re = {:.4g}, where Re = {:.4g} is "
                               "asked for",
                               reached * discrete_->problem.reynolds, discrete_->problem.reynolds),
                   "Take more cells; where that does not help, the flow separates or is "
                   "unsteady there: lower the flow rate");
}

template <int dim>
int FlowSolver<dim>::n_unknowns() const {
  return discrete_->n_unknowns;
}
template <int dim>
int FlowSolver<dim>::n_newton_steps() const {
  return discrete_->n_newton_steps;
}
template <int dim>
double FlowSolver<dim>::largest_residual() const {
  return discrete_->largest_residual;
}

template class FlowSolver<2>;
template class FlowSolver<3>;

}  // namespace manoscope::navier_stokes

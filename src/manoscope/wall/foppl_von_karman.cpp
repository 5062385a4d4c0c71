#include "manoscope/wall/foppl_von_karman.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <numbers>
#include <utility>

#include "manoscope/core/error.hpp"
#include "manoscope/wall/foppl_von_karman_grid.hpp"
#include "manoscope/wall/line_load.hpp"

namespace manoscope::wall {
namespace {

using Vector = Eigen::VectorXd;

constexpr const char* kWhere = "Foeppl-von Karman wall";

// Weight of the even part of the grid against its refinement at the edges. Any choice converges;
// with this one an S1-like wall of 40 x 14 cells is within 1e-4 of its limit at 10 kPa.
constexpr double kEvennessX = 1.0, kEvennessZ = 3.0;

HermiteAxis axis_x(const ClampedWall& wall, const FopplVonKarmanOptions& options, Index n_cells) {
  const double a = 0.5 * wall.width.si();
  const double layer = wall.edge_layer(options.design_pressure) / a;
  return HermiteAxis(
      graded_nodes(0.0, wall.length.si() / a, RefinedEnds::both, layer, kEvennessX, n_cells));
}

HermiteAxis axis_z(const ClampedWall& wall, const FopplVonKarmanOptions& options, Index n_cells) {
  const double layer = wall.edge_layer(options.design_pressure) / (0.5 * wall.width.si());
  if (options.symmetric) {
    return HermiteAxis(graded_nodes(0.0, 1.0, RefinedEnds::last, layer, kEvennessZ, n_cells));
  }
  return HermiteAxis(graded_nodes(-1.0, 1.0, RefinedEnds::both, layer, kEvennessZ, 2 * n_cells));
}

FvkCoefficients coefficients(const ClampedWall& wall) {
  const double nu = wall.poisson_ratio, slenderness = 0.5 * wall.width.si() / wall.thickness.si();
  const double square = slenderness * slenderness;
  return {nu, wall.prestress.si() * (1.0 - nu * nu) / wall.youngs_modulus.si() * square,
          wall.shear_correction * 0.5 * (1.0 - nu) * square, wall.sliding_edges};
}

/// Nodal values of the initial shape in units of t.
Vector shape_unknowns(const FvkModel& model, const ClampedWall& wall) {
  Vector made = Vector::Zero(model.n_unknowns());
  const double crest = wall.initial_shape.crest.si() / wall.thickness.si();
  if (crest == 0.0) return made;
  const double l = model.x().last(), reach = 2.0 / std::numbers::pi;
  const double lean = wall.initial_shape.lopsidedness / l;
  const auto rise = [&](double d) { return 1.0 - (1.0 + d / reach) * std::exp(-d / reach); };
  const auto steep = [&](double d) { return d / (reach * reach) * std::exp(-d / reach); };
  for (Index ix = 0; ix < model.x().n_nodes(); ++ix) {
    const double x = model.x().node(ix), tilt = 1.0 + lean * (x - 0.5 * l);
    const double ends = rise(x) * rise(l - x);
    const double ends_slope = steep(x) * rise(l - x) - rise(x) * steep(l - x);
    const double along[2] = {ends * tilt, ends_slope * tilt + ends * lean};
    for (Index iz = 0; iz < model.z().n_nodes(); ++iz) {
      const double z = model.z().node(iz), gap = 1.0 - z * z;
      const double across[2] = {gap * gap, -4.0 * z * gap};
      for (int kind = 0; kind < 4; ++kind) {
        const Index index = model.unknown(ix, iz, FvkModel::b, kind);
        if (index >= 0) made(index) = crest * along[kind / 2] * across[kind % 2];
      }
    }
  }
  return made;
}

}  // namespace

void FopplVonKarmanOptions::validate() const {
  const auto refuse = [](const std::string& found, const char* mend) {
    throw InputError(kWhere, found, mend);
  };
  if (n_cells_x < 4 || n_cells_x > 400 || n_cells_x % 2 != 0) {
    refuse(fmt::format("n_cells_x is {}", n_cells_x), "Give an even number from 4 to 400");
  }
  if (n_cells_z < 2 || n_cells_z > 100 || n_cells_z % 2 != 0) {
    refuse(fmt::format("n_cells_z is {}", n_cells_z), "Give an even number from 2 to 100");
  }
  if (!std::isfinite(design_pressure.si())) {
    refuse("design_pressure is not a number", "Give the highest pressure expected");
  }
  if (!(tolerance >= 1e-13 && tolerance <= 1e-3)) {
    refuse(fmt::format("tolerance is {:g}", tolerance), "Give a value from 1e-13 to 1e-3");
  }
  if (max_iterations < 1) {
    refuse(fmt::format("max_iterations is {}", max_iterations), "Give at least 1");
  }
}

WallState::Grid::Grid(const ClampedWall& wall, const FopplVonKarmanOptions& options,
                      Index n_cells_x, Index n_cells_z)
    : half_width(0.5 * wall.width.si()),
      thickness(wall.thickness.si()),
      pressure(wall.youngs_modulus.si() / (1.0 - wall.poisson_ratio * wall.poisson_ratio) *
               std::pow(thickness / half_width, 4)),
      energy(pressure * thickness * half_width * half_width),
      halves(options.symmetric ? 2.0 : 1.0),
      model(axis_x(wall, options, n_cells_x), axis_z(wall, options, n_cells_z), coefficients(wall),
            options.symmetric),
      norm(model) {
  model.set_initial_shape(shape_unknowns(model, wall));
}

double WallState::deflection(double x, double z) const {
  const FvkModel& model = grid_->model;
  const double a = grid_->half_width, at_x = x / a;
  const double at_z = model.symmetric() ? std::abs(z) / a : z / a;
  if (!(at_x > 0.0 && at_x < model.x().last() && std::abs(at_z) < 1.0)) return 0.0;
  return grid_->thickness * (model.evaluate(q_, FvkModel::b, at_x, at_z) +
                             model.evaluate(q_, FvkModel::s, at_x, at_z));
}

double WallState::average_deflection(double x) const {
  const FvkModel& model = grid_->model;
  const double at = x / grid_->half_width;
  if (!(at > 0.0 && at < model.x().last())) return 0.0;
  return grid_->thickness * 0.5 * grid_->halves *
         model.line_functional(sampling_weights(model.x(), at)).dot(q_);
}

Array1 WallState::average_deflection(const Array1& x) const {
  return x.unaryExpr([this](double at) { return average_deflection(at); });
}

double WallState::displacement_x(double x, double z) const {
  const double a = grid_->half_width, t = grid_->thickness;
  const double at = grid_->model.symmetric() ? std::abs(z) / a : z / a;
  return t * t / a * grid_->model.evaluate(q_, FvkModel::u, x / a, at);
}

double WallState::displacement_z(double x, double z) const {
  const double a = grid_->half_width, t = grid_->thickness;
  const bool mirrored = grid_->model.symmetric() && z < 0.0;
  return (mirrored ? -1.0 : 1.0) * t * t / a *
         grid_->model.evaluate(q_, FvkModel::v, x / a, mirrored ? -z / a : z / a);
}

double WallState::elastic_energy() const {
  return grid_->halves * grid_->energy * grid_->model.energy(q_);
}

double WallState::volume() const {
  const FvkModel& model = grid_->model;
  const Matrix whole = station_weights(model.x(), Array1::Zero(1));
  return grid_->halves * grid_->thickness * grid_->half_width * grid_->half_width *
         model.line_functional(whole.col(0)).dot(q_);
}

FopplVonKarman::FopplVonKarman(const ClampedWall& wall, const FopplVonKarmanOptions& options,
                               Monitor monitor)
    : wall_(wall), options_(options), monitor_(std::move(monitor)) {
  wall.validate();
  options.validate();
  const Index half_x = std::max<Index>(4, options.n_cells_x / 4 * 2);
  coarse_ = std::make_shared<const WallState::Grid>(wall, options, half_x,
                                                    std::max<Index>(2, options.n_cells_z / 2));
  fine_ =
      std::make_shared<const WallState::Grid>(wall, options, options.n_cells_x, options.n_cells_z);
}

Vector FopplVonKarman::scaled_load(const WallState::Grid& grid, const WallLoad& load) const {
  const FvkModel& model = grid.model;
  const double a = grid.half_width;
  // The preload is linear in x: two stations describe it.
  const Preload& held = wall_.preload;
  Array1 ends(2), inward(2);
  ends << 0.0, model.x().last();
  inward << 1.0 - 0.5 * held.lopsidedness, 1.0 + 0.5 * held.lopsidedness;
  Vector weights =
      station_weights(model.x(), ends) * (inward * (-held.load.si() / grid.pressure)).matrix();
  if (!load.field()) {
    weights +=
        station_weights(model.x(), load.x() / a) * (load.pressure() / grid.pressure).matrix();
    return model.line_functional(weights);
  }
  const auto pressure = [&](double x, double z) {
    const double value = load.field()(x * a, z * a);
    if (!std::isfinite(value)) {
      throw InputError(kWhere, fmt::format("p({:g} m, {:g} m) is not finite", x * a, z * a),
                       "Give a pressure on the whole wall");
    }
    if (model.symmetric()) {
      const double other = load.field()(x * a, -z * a);
      if (!(std::abs(value - other) <= 1e-9 * (std::abs(value) + std::abs(other)))) {
        throw InputError(kWhere,
                         fmt::format("at x = {:g} mm the load is {:g} Pa at z = {:g} mm but {:g} "
                                     "Pa at the opposite side",
                                     1e3 * x * a, value, 1e3 * z * a, other),
                         "Set symmetric = false for loads that are not even in z");
      }
    }
    return value / grid.pressure;
  };
  return model.line_functional(weights) + model.load(pressure);
}

WallState FopplVonKarman::state_at(const std::shared_ptr<const WallState::Grid>& grid) const {
  WallState state;
  state.grid_ = grid;
  state.q_ = grid->model.initial_shape();
  return state;
}

WallState FopplVonKarman::unloaded() const { return state_at(fine_); }

WallState FopplVonKarman::equilibrium(const WallLoad& load) const {
  // A share of the tension that stretching brings at the design pressure, lent and taken back.
  const double layer = wall_.edge_layer(options_.design_pressure) / fine_->half_width;
  const double tension = 1.0 / (12.0 * layer * layer);
  const Vector coarse_load = scaled_load(*coarse_, load), fine_load = scaled_load(*fine_, load);
  NewtonOptions rough, near;
  rough.tolerance = 1e-5;
  rough.max_iterations = options_.max_iterations;
  near.tolerance = options_.tolerance;
  near.max_iterations = std::min<Index>(10, options_.max_iterations);
  near.stable = false;

  const auto from_coarse = [&](double lent) {
    FvkModel model = coarse_->model;
    model.set_prestress(model.coefficients().prestress + lent);
    const Vector& shape = model.initial_shape();
    const Vector q = solve_equilibrium(model, coarse_->norm, coarse_load, shape, rough, monitor_).q;
    // The difference to the shape is sampled, so that the shape itself stays the fine grid's.
    return Vector(fine_->model.initial_shape() + fine_->model.prolong(model, q - shape));
  };
  const auto accept = [&](Equilibrium& solved, Index n_before) {
    WallState state = state_at(fine_);
    state.q_ = std::move(solved.q);
    state.residual_ = solved.residual;
    state.iterations_ = n_before + solved.iterations;
    return state;
  };
  const auto stands = [](const Equilibrium& solved) {
    return solved.converged && solved.tangent->n_negative() == 0;
  };

  WallState start = unloaded();
  start.q_ = from_coarse(0.0);
  Equilibrium found =
      solve_equilibrium(fine_->model, fine_->norm, fine_load, start.q_, near, monitor_);
  if (stands(found)) return accept(found, 0);
  if (wall_.prestress.si() >= 0.0) {
    // Sampled strains are off by more than the bending of a thin slack wall can bear, and its
    // tangent is then indefinite. Under lent tension it is not; the loan is paid back in steps.
    Index n_steps = found.iterations;
    near.max_iterations = std::min<Index>(30, options_.max_iterations);
    Vector q = from_coarse(0.3 * tension);
    FvkModel model = fine_->model;
    for (const double share : {0.3, 0.1, 0.03, 0.015, 0.007, 0.003, 0.0}) {
      model.set_prestress(fine_->model.coefficients().prestress + share * tension);
      found = solve_equilibrium(model, fine_->norm, fine_load, q, near, monitor_);
      if (!stands(found)) break;
      if (share == 0.0) return accept(found, n_steps);
      n_steps += found.iterations;
      q = found.q;
    }
  }
  return equilibrium(load, start);
}

WallState FopplVonKarman::equilibrium(const WallLoad& load, const WallState& start) const {
  MANO_ASSERT(start.q_.size() == fine_->model.n_unknowns());
  NewtonOptions newton;
  newton.tolerance = options_.tolerance;
  newton.max_iterations = options_.max_iterations;
  Equilibrium found = solve_equilibrium(fine_->model, fine_->norm, scaled_load(*fine_, load),
                                        start.q_, newton, monitor_);
  if (!found.converged) {
    throw InputError(
        kWhere,
        fmt::format("no equilibrium within {} steps: relative residual {:.2g}, wanted {:.2g}",
                    options_.max_iterations, found.residual, options_.tolerance),
        "Raise the load in smaller steps, add cells, or check prestress and thickness");
  }
  WallState state = start;
  state.q_ = std::move(found.q);
  state.residual_ = found.residual;
  state.iterations_ = found.iterations;
  state.n_unstable_ = found.tangent->n_negative();
  return state;
}

}  // namespace manoscope::wall

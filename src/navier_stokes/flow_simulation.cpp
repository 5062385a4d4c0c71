#include "flow_simulation.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <array>
#include <cmath>
#include <cstdint>
#include <utility>
#include <vector>

#include "duct_profile.hpp"
#include "flow_mesh.hpp"
#include "flow_solver.hpp"
#include "manoscope/core/error.hpp"
#include "manoscope/flow/laminar.hpp"
#include "mesh_pair.hpp"
#include "roof_misfit.hpp"
#include "vtu_file.hpp"

namespace manoscope::navier_stokes {
namespace {

constexpr const char* kWhere = "Navier-Stokes simulation";

/// Units of a FlowProblem: lengths in the height, velocities in the mean one below it.
struct Scales {
  explicit Scales(const SimulatedChannel& given)
      : length(given.channel.height.si()),
        velocity(given.flow_rate.si() / (length * given.channel.width.si())),
        pressure(given.fluid.viscosity.si() * velocity / length),
        reynolds(given.fluid.density.si() * velocity * length / given.fluid.viscosity.si()) {}
  double length, velocity, pressure, reynolds;
};

/// Number of cells of one mesh.
struct Cells {
  int along, up, across;

  Cells coarser() const { return {coarser_cells(along), coarser_cells(up), coarser_cells(across)}; }
};

/// What both meshes make of a difference between them, as a standard uncertainty over it.
template <int dim>
double uncertainty_between(const Cells& fine, const Cells& coarse) {
  std::vector<std::pair<int, int>> axes{{fine.along, coarse.along}, {fine.up, coarse.up}};
  if constexpr (dim == 3) axes.emplace_back(fine.across, coarse.across);
  return uncertainty_of_difference(axes);
}

Cells cells_of(const SimulatedChannel& given, const MeshOptions& mesh) {
  const double gaps = given.channel.length / given.channel.height;
  const bool plane = mesh.dim == 2;
  const int least = plane ? 60 : 36, most = plane ? 600 : 200;
  const int along =
      std::clamp(static_cast<int>(std::lround((plane ? 1.35 : 0.41) * gaps)), least, most);
  return {mesh.cells_along > 0 ? mesh.cells_along : along,
          mesh.cells_up > 0 ? mesh.cells_up : (plane ? 8 : 5),
          mesh.cells_across > 0 ? mesh.cells_across : 8};
}

void check(const SimulatedChannel& given, const Array1& stations, const MeshOptions& mesh) {
  mesh.validate();
  given.channel.validate(kWhere);
  given.fluid.validate(kWhere);
  if (!(given.flow_rate > FlowRate{}) || !std::isfinite(given.flow_rate.si())) {
    throw InputError(kWhere, fmt::format("the flow rate is {:g} m3/s", given.flow_rate.si()),
                     "Give a positive flow rate");
  }
  const double length = given.channel.length.si();
  for (Index i = 0; i < stations.size(); ++i) {
    if (stations[i] >= 0.0 && stations[i] <= length * (1.0 + 1e-12)) continue;
    throw InputError(kWhere, fmt::format("station {} at x = {:g} m", i + 1, stations[i]),
                     fmt::format("Choose stations from 0 to {:g} m", length));
  }
}

/// Roof of the channel free of units: h/height at x/height, z/height.
class ScaledGap {
 public:
  ScaledGap(const SimulatedChannel& given, int dim) : given_(&given), dim_(dim) {}

  double operator()(double x, double z) const {
    const double height = given_->channel.height.si(), length = given_->channel.length.si();
    const double place = x * height;
    // Both ends belong to the channel: its roof may start with a step in slope, not in height.
    constexpr double kRounding = 1e-9;
    if (place < -kRounding * length || place > (1.0 + kRounding) * length) return 1.0;
    const double across = std::min(z * height, 0.5 * given_->channel.width.si());
    const double gap = 1.0 + given_->zeta(std::clamp(place, 0.0, length), across) / height;
    if (!(gap > 0.0)) {
      throw InputError(
          kWhere,
          fmt::format("the gap is {:.4g} um at x = {:.4g} mm{}", gap * height * 1e6, place * 1e3,
                      dim_ == 3 ? fmt::format(", z = {:.4g} mm", across * 1e3) : std::string()),
          "The gap must stay open; check the sign of zeta and the height");
    }
    return gap;
  }

 private:
  const SimulatedChannel* given_;
  int dim_;
};

template <int dim>
std::array<std::vector<double>, dim> edges(const SimulatedChannel& given, const Cells& cells) {
  const double height = given.channel.height.si();
  std::array<std::vector<double>, dim> result;
  result[0] = edges_along(given.channel.length.si() / height, given.lead_in.si() / height,
                          given.lead_out.si() / height, cells.along);
  result[1] = edges_up(cells.up);
  if constexpr (dim == 3) {
    result[2] = edges_across(0.5 * given.channel.width.si() / height, cells.across);
  }
  return result;
}

/// Velocity at the inlet, up to a factor.
template <int dim>
std::function<Vector<dim>(const Vector<dim>&)> inlet_velocity(const SimulatedChannel& given,
                                                              const FlowProblem<dim>& problem) {
  if (given.inlet == flow::InletProfile::uniform) {
    return [](const Vector<dim>&) { return Vector<dim>{1.0}; };
  }
  const double start = problem.edges[0].front();
  const auto gap = [gap = ScaledGap(given, dim), start](double z) { return gap(start, z); };
  if constexpr (dim == 2) {
    return [h = gap(0.0)](const Vector<2>& place) {
      const double t = place[1] / h;
      return Vector<2>{t * (1.0 - t), 0.0};
    };
  } else {
    const auto profile = duct_profile(problem.edges[2], problem.edges[1], gap, problem.order);
    return [gap, profile](const Vector<3>& place) {
      return Vector<3>{profile(place[1] / gap(place[2]), place[2]), 0.0, 0.0};
    };
  }
}

/// Factors of a plane flow grow hardly faster than its unknowns; those of some 100,000 in three
/// dimensions take 4 GB.
SolverKind solver_of(const MeshOptions& mesh, const Cells& cells) {
  constexpr std::int64_t kMostCells = 5000;
  const std::int64_t n = std::int64_t{1} * cells.along * cells.up * cells.across;
  const bool large = mesh.dim == 3 && n > kMostCells;
  return mesh.solver == "iterative" || (mesh.solver == "auto" && large) ? SolverKind::iterative
                                                                        : SolverKind::direct;
}

/// Flow between plates as far apart as the gap is at each place, which carries `flow` through every
/// section: u = 6 t (1 - t) flow h^2 / (integral of h^3 across), along lines of constant t.
template <int dim>
Vector<dim> near_flow(const ScaledGap& gap, const std::vector<double>& z_edges, double flow,
                      const Vector<dim>& chart) {
  const double x = chart[0], t = chart[1];
  double h = gap(x, 0.0), conductance = h * h * h;
  if constexpr (dim == 3) {
    h = gap(x, chart[2]);
    conductance = 0.0;
    for (std::size_t i = 1; i < z_edges.size(); ++i) {
      const double middle = gap(x, 0.5 * (z_edges[i - 1] + z_edges[i]));
      conductance += (z_edges[i] - z_edges[i - 1]) * middle * middle * middle;
    }
  }
  Vector<dim> velocity{};
  velocity[0] = 6.0 * t * (1.0 - t) * flow * h * h / conductance;
  return velocity;
}

/// Of the mesh with these ends of cells.
template <int dim>
RoofMisfit misfit_of(const SimulatedChannel& given,
                     const std::array<std::vector<double>, dim>& ends, int order) {
  std::vector<double> across;
  if constexpr (dim == 3) across = ends[2];
  return roof_misfit(ScaledGap(given, dim), ends[0], across, order);
}

/// A flow below another roof is none of this channel's, however fine its drop.
void require_resolved(const RoofMisfit& misfit, double height) {
  constexpr double kMost = 0.05;
  if (misfit.share <= kMost) return;
  throw InputError(
      kWhere,
      fmt::format("the roof is too steep for its cells: they miss it by {:.2g} % of the gap at x = "
                  "{:.4g} mm, z = {:.4g} mm",
                  100.0 * misfit.share, misfit.x * height * 1e3, misfit.z * height * 1e3),
      "Take more cells (--cells-along, --cells-across), or give a smoother shape");
}

/// Reynolds number, of the height and the mean velocity, up to which the grad-div term grows: where
/// friction rules, it helps nobody, and on both meshes hides the error of the coarser one.
constexpr double kInertiaRules = 500.0;

template <int dim>
FlowProblem<dim> problem_of(const SimulatedChannel& given, const Cells& cells,
                            const MeshOptions& mesh) {
  FlowProblem<dim> problem;
  problem.edges = edges<dim>(given, cells);
  problem.place = below_roof<dim>(ScaledGap(given, dim));
  require_resolved(misfit_of<dim>(given, problem.edges, mesh.order), given.channel.height.si());
  problem.reynolds = Scales(given).reynolds;
  problem.order = mesh.order;
  problem.solver = solver_of(mesh, cells);
  problem.grad_div = kGradDiv * std::min(1.0, problem.reynolds / kInertiaRules);
  problem.sides[SideName::inlet] = {SideCondition::velocity, inlet_velocity<dim>(given, problem)};
  problem.sides[SideName::outlet].condition = SideCondition::open;
  problem.inlet_flow = 1.0;
  if constexpr (dim == 3) {
    problem.sides[SideName::centre].condition = SideCondition::slip;
    problem.inlet_flow = 0.5 * given.channel.width / given.channel.height;
  }
  if (given.lead_in_slips) problem.slip_before = 0.0;
  problem.start = [gap = ScaledGap(given, dim), z = problem.edges[dim - 1],
                   flow = *problem.inlet_flow](const Vector<dim>& chart) {
    return near_flow<dim>(gap, z, flow, chart);
  };
  return problem;
}

/// Pressures and shears at the stations, in SI, 0 mean pressure at the channel's end.
struct Readings {
  Array1 mean_pressure, wall_pressure, floor_pressure, wall_shear, floor_shear;
  double drop = 0.0;
};

template <int dim>
Readings read(const FlowSolver<dim>& solver, const SimulatedChannel& given,
              const Array1& stations) {
  const Scales scales(given);
  const Index n = stations.size();
  std::vector<double> places(stations.begin(), stations.end());
  places.push_back(0.0);
  places.push_back(given.channel.length.si());
  for (double& place : places) place /= scales.length;
  const std::vector<FlowSection> sections = solver.sections(places);
  const double outlet = sections.back().mean_pressure;
  Readings readings;
  for (Array1* values : {&readings.mean_pressure, &readings.wall_pressure, &readings.floor_pressure,
                         &readings.wall_shear, &readings.floor_shear}) {
    values->resize(n);
  }
  for (Index i = 0; i < n; ++i) {
    const FlowSection& section = sections[static_cast<std::size_t>(i)];
    readings.mean_pressure[i] = scales.pressure * (section.mean_pressure - outlet);
    readings.wall_pressure[i] = scales.pressure * (section.roof_pressure - outlet);
    readings.floor_pressure[i] = scales.pressure * (section.floor_pressure - outlet);
    readings.wall_shear[i] = scales.pressure * section.roof_shear;
    readings.floor_shear[i] = scales.pressure * section.floor_shear;
  }
  readings.drop = scales.pressure * (sections[sections.size() - 2].mean_pressure - outlet);
  return readings;
}

/// Costs of both meshes; unknowns are those of the finer.
FlowCosts together(const FlowCosts& coarse, const FlowCosts& fine) {
  FlowCosts sum = fine;
  sum.n_newton_steps += coarse.n_newton_steps;
  sum.n_iterations += coarse.n_iterations;
  sum.largest_residual = std::max(sum.largest_residual, coarse.largest_residual);
  sum.grad_div = fine.grad_div || coarse.grad_div;
  return sum;
}

template <int dim>
SimulatedFlow simulate_in(const SimulatedChannel& given, const Array1& stations,
                          const MeshOptions& mesh, const SimulationFiles& files,
                          const Monitor& monitor) {
  const Cells fine = cells_of(given, mesh);
  std::filesystem::path coarse_checkpoint = files.checkpoint;
  if (!coarse_checkpoint.empty()) coarse_checkpoint += ".coarse";
  SimulatedFlow result;
  Readings coarse_readings;
  {
    FlowSolver<dim> coarse(problem_of<dim>(given, fine.coarser(), mesh));
    coarse.solve(monitor, coarse_checkpoint);
    coarse_readings = read(coarse, given, stations);
    result.costs = coarse.costs();
  }
  monitor.report("flow on the coarser mesh", 1.0);
  FlowSolver<dim> solver(problem_of<dim>(given, fine, mesh));
  solver.solve(monitor, files.checkpoint);
  monitor.report("flow on the finer mesh", 1.0);
  const Readings readings = read(solver, given, stations);

  const double factor = uncertainty_between<dim>(fine, fine.coarser());
  result.dim = dim;
  result.reynolds = flow::duct_reynolds(given.channel, given.fluid, given.flow_rate);
  result.roof_misfit = misfit_of<dim>(given, edges<dim>(given, fine), mesh.order).share;
  result.x = stations;
  result.gap = stations;
  const ScaledGap gap(given, dim);
  for (double& value : result.gap) {
    value = given.channel.height.si() * gap(value / given.channel.height.si(), 0.0);
  }
  result.mean_pressure = readings.mean_pressure;
  result.coarse_mean_pressure = coarse_readings.mean_pressure;
  result.wall_pressure = readings.wall_pressure;
  result.floor_pressure = readings.floor_pressure;
  result.wall_shear = readings.wall_shear;
  result.floor_shear = readings.floor_shear;
  result.mean_pressure_uncertainty =
      factor * (readings.mean_pressure - coarse_readings.mean_pressure).abs();
  result.wall_pressure_uncertainty =
      factor * (readings.wall_pressure - coarse_readings.wall_pressure).abs();
  result.drop = readings.drop;
  result.coarse_drop = coarse_readings.drop;
  result.drop_uncertainty = factor * std::abs(readings.drop - coarse_readings.drop);
  result.converged = result.drop_uncertainty <= mesh.tolerance * std::abs(result.drop);
  result.costs = together(result.costs, solver.costs());
  if (!files.vtu.empty()) {
    const Scales scales(given);
    const double outlet = solver.section(given.channel.length.si() / scales.length).mean_pressure;
    write_vtu<dim>(files.vtu, solver, {scales.length, scales.velocity, scales.pressure, outlet});
  }
  return result;
}

}  // namespace

SimulatedFlow simulate(const SimulatedChannel& channel, const Array1& stations,
                       const MeshOptions& mesh, const SimulationFiles& files,
                       const Monitor& monitor) {
  check(channel, stations, mesh);
  return mesh.dim == 2 ? simulate_in<2>(channel, stations, mesh, files, monitor)
                       : simulate_in<3>(channel, stations, mesh, files, monitor);
}

}  // namespace manoscope::navier_stokes

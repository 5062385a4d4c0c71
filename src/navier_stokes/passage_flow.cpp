#include "passage_flow.hpp"

#include <algorithm>
#include <cmath>
#include <numbers>

#include "manoscope/core/error.hpp"
#include "manoscope/flow/duct_resistance.hpp"
#include "mesh_pair.hpp"
#include "passage_mesh.hpp"
#include "vtu_file.hpp"

namespace manoscope::navier_stokes {
namespace {

/// Developed velocity in a rectangle, 0 to `a` by 0 to `b`, up to a factor; b = 0: between plates.
///
/// Source: e.g. H. Bruus, Theoretical Microfluidics (2008), eq. (3.48): sum over odd n of
/// (1 - cosh(n pi z/h)/cosh(n pi w/(2 h))) sin(n pi y/h)/n^3 with h the shorter side; the terms
/// left out are below 1e-5 of the largest velocity.
double developed(double at_a, double a, double at_b, double b) {
  if (b == 0.0) return at_a * (a - at_a);
  if (a > b) return developed(at_b, b, at_a, a);
  constexpr int kTerms = 151;
  double sum = 0.0;
  for (int n = 1; n <= kTerms; n += 2) {
    const double k = n * std::numbers::pi / a;
    const double inner = k * std::abs(at_b - 0.5 * b), outer = k * 0.5 * b;
    const double ratio =
        std::exp(inner - outer) * (1.0 + std::exp(-2.0 * inner)) / (1.0 + std::exp(-2.0 * outer));
    sum += (1.0 - ratio) * std::sin(k * at_a) / (static_cast<double>(n) * n * n);
  }
  return sum;
}

/// Along s, y and z: where cells end in any case, and where they are small.
struct Grading {
  std::vector<double> breaks;
  std::vector<FineSpot> spots;
};

/// Is there an edge that the flow goes round?
bool has_edges(const SimulatedPassage& given) {
  return given.port > Length{} || given.beyond_height > Length{} ||
         given.passage.height != given.channel.height || given.passage.width != given.channel.width;
}

/// Sizes of cells, in heights of the channel.
struct CellSizes {
  double edge, wall, side, largest;  ///< at an edge of a step, floor and roof, side walls
  double growth;                     ///< from cell to cell
};

/// At an edge the pressure goes as r^-0.46: cells shrink towards it until the mean over the section
/// there is told.
CellSizes sizes_in(int dim) {
  if (dim == 2) return {1.0 / 400.0, 1.0 / 16.0, 1.0, 0.75, 0.25};
  return {1.0 / 40.0, 0.2, 0.4, 2.5, 0.6};
}

Grading grading_along(const PassageGeometry& geometry, const CellSizes& sizes) {
  Grading along;
  for (const FluidBox& box : geometry.boxes) {
    along.breaks.insert(along.breaks.end(), {box.s_low, box.s_high});
  }
  const FluidBox& channel = geometry.boxes[0];
  const FluidBox& passage = geometry.boxes[1];
  const bool step = channel.y_high != passage.y_high || channel.z_high != passage.z_high;
  along.spots.push_back({0.0, step ? sizes.edge : sizes.largest});
  if (geometry.boxes.size() > 2) {
    const FluidBox& beyond = geometry.boxes[2];
    along.spots.push_back({beyond.s_low, sizes.edge});
    if (geometry.far_axis != 0) along.spots.push_back({beyond.s_high, sizes.wall});
  }
  return along;
}

/// Walls at the ends of the boxes, and edges where one of two boxes that meet ends before the
/// other.
Grading grading_of(const PassageGeometry& geometry, double FluidBox::*low, double FluidBox::*high,
                   bool beyond_along, double wall, double edge) {
  Grading grading;
  const auto& boxes = geometry.boxes;
  for (std::size_t i = 0; i < boxes.size(); ++i) {
    grading.breaks.insert(grading.breaks.end(), {boxes[i].*low, boxes[i].*high});
    grading.spots.push_back({boxes[i].*low, wall});
    if (i < 2 || beyond_along) grading.spots.push_back({boxes[i].*high, wall});
    if (i == 0) continue;
    const double inner = std::min(boxes[i].*high, boxes[i - 1].*high);
    if (inner < std::max(boxes[i].*high, boxes[i - 1].*high)) {
      grading.spots.push_back({inner, edge});
    }
  }
  return grading;
}

Grading grading_up(const PassageGeometry& geometry, const CellSizes& sizes) {
  return grading_of(geometry, &FluidBox::y_low, &FluidBox::y_high, geometry.far_axis != 1,
                    sizes.wall, sizes.edge);
}

Grading grading_across(const PassageGeometry& geometry, const CellSizes& sizes) {
  Grading across = grading_of(geometry, &FluidBox::z_low, &FluidBox::z_high, geometry.far_axis != 2,
                              sizes.side, sizes.side / 4.0);
  if (geometry.whole_width) return across;
  std::erase_if(across.breaks, [](double z) { return z < 0.0; });
  std::erase_if(across.spots, [](const FineSpot& spot) { return spot.place < 0.0; });
  across.breaks.push_back(0.0);
  return across;
}

/// From s to x and back.
double sign_of(const SimulatedPassage& given) {
  return given.end == PassageEnd::inlet ? -1.0 : 1.0;
}

/// Side of the lattice where the far end opens.
int far_side(const SimulatedPassage& given, const PassageGeometry& geometry) {
  constexpr int kSides[] = {SideName::inlet, SideName::roof, SideName::flank};
  if (geometry.far_axis > 0) return kSides[geometry.far_axis];
  return given.end == PassageEnd::inlet ? SideName::inlet : SideName::outlet;
}

int channel_side(const SimulatedPassage& given) {
  return given.end == PassageEnd::inlet ? SideName::outlet : SideName::inlet;
}

/// Velocity of developed flow through an end of a box that faces along `axis`, up to a factor.
template <int dim>
std::function<Vector<dim>(const Vector<dim>&)> entering(const FluidBox& box, int axis,
                                                        double sign) {
  const double low[] = {box.s_low, box.y_low, box.z_low};
  const double size[] = {box.s_high - box.s_low, box.y_high - box.y_low, box.z_high - box.z_low};
  const int a = axis == 1 ? 0 : 1, b = axis == 2 ? 0 : 2;
  return [=, start = std::array{low[a], low[b]},
          sides = std::array{size[a], size[b]}](const Vector<dim>& place) {
    const auto at = [&](int along) {
      if (along >= dim) return 0.0;
      return along == 0 ? sign * place[0] : place[along];
    };
    const bool plane = dim == 2;
    Vector<dim> velocity{};
    velocity[axis] = (axis == 0 ? 1.0 : -1.0) * developed(at(a) - start[0], sides[0],
                                                          plane ? 0.0 : at(b) - start[1],
                                                          plane ? 0.0 : sides[1]);
    return velocity;
  };
}

/// Cells with fluid.
template <int dim>
int n_cells(const FlowProblem<dim>& problem) {
  int n = 0;
  std::array<std::size_t, dim> cell{};
  for (std::size_t axis = 0; axis < dim;) {
    Vector<dim> middle;
    for (int a = 0; a < dim; ++a) {
      middle[a] = 0.5 * (problem.edges[a][cell[a]] + problem.edges[a][cell[a] + 1]);
    }
    if (!problem.solid(middle)) ++n;
    for (axis = 0; axis < dim && ++cell[axis] + 1 == problem.edges[axis].size(); ++axis) {
      cell[axis] = 0;
    }
  }
  return n;
}

/// Drop of developed flow, Pa; in the plane between plates that are `gap` apart.
double duct_drop(const SimulatedPassage& given, const flow::RigidPassage& duct, Length gap,
                 int dim) {
  if (duct.length == Length{}) return 0.0;
  if (dim == 3) return flow::passage_drop(given.fluid.viscosity, given.flow_rate, duct).si();
  return 12.0 * given.fluid.viscosity.si() * given.flow_rate.si() * duct.length.si() /
         (given.channel.width.si() * std::pow(gap.si(), 3));
}

/// Over the far section's length that is solved.
double far_friction(const SimulatedPassage& given, const PassageGeometry& geometry, int dim) {
  const flow::RigidPassage& far = geometry.far;
  return duct_drop(given, far, geometry.far_axis == 1 ? far.width : far.height, dim);
}

/// What a jet into a wider section may give back of its pressure behind the end of the mesh, Pa.
///
/// At most the share of the length that is not solved of what it gives back in all, by momentum:
/// 2 beta a (1 - a) rho U^2/2, a the ratio of both areas, beta of developed flow, 1.2 between
/// plates and up to 1.38 in a square.
double unseen_recovery(const SimulatedPassage& given, const PassageGeometry& geometry, int dim) {
  if (geometry.missing == 0.0) return 0.0;
  const double beta = dim == 2 ? 1.2 : 1.38;
  const Length width = dim == 2 ? given.channel.width : given.passage.width;
  const Length wider = dim == 2 ? given.channel.width : given.beyond_width;
  const double area = (width * given.passage.height).si();
  const double ratio = area / (wider * given.beyond_height).si();
  const double speed = given.flow_rate.si() / area;
  return geometry.missing * beta * ratio * (1.0 - ratio) * given.fluid.density.si() * speed * speed;
}

/// Of those that the flow passes, m^2.
double narrowest_section(const SimulatedPassage& given, int dim) {
  const Length width = dim == 3 ? given.passage.width : given.channel.width;
  double area = std::min((given.channel.width * given.channel.height).si(),
                         (width * given.passage.height).si());
  if (given.port > Length{}) {
    const Length other = given.port_side == PortSide::top ? width : given.passage.height;
    area = std::min(area, (given.port * other).si());
  }
  return area;
}

/// Pressures in a passage with edges: its drop, or its friction and rho U^2/2 in the narrowest
/// section where these are more. Behind an expansion they cancel in the drop, errors do not.
double pressure_scale(const SimulatedPassage& given, double drop, int dim) {
  const double speed = given.flow_rate.si() / narrowest_section(given, dim);
  const double friction = duct_drop(given, given.passage, given.passage.height, dim);
  return std::max(std::abs(drop), friction + 0.5 * given.fluid.density.si() * speed * speed);
}

/// Over the channel's section at its end. On the edge of the lattice itself that of the passage
/// would have its part.
template <int dim>
double channel_end_pressure(const FlowSolver<dim>& solver, const SimulatedPassage& given) {
  constexpr double kInside = 1e-9;  // heights: in the first cells of the channel
  return solver.section(-sign_of(given) * kInside).mean_pressure;
}

template <int dim>
double drop_of(const FlowSolver<dim>& solver, const SimulatedPassage& given) {
  const PassageGeometry geometry(given, dim);
  const double sign = sign_of(given);
  const double channel = channel_end_pressure(solver, given);
  const double far = solver.side(far_side(given, geometry)).mean_pressure;
  const double height = given.channel.height.si();
  const double speed = given.flow_rate.si() / (height * given.channel.width.si());
  const double scale = given.fluid.viscosity.si() * speed / height;
  return -sign * (far - channel) * scale - far_friction(given, geometry, dim);
}

template <int dim>
PassageFlow simulate_in(const SimulatedPassage& given, const MeshOptions& mesh,
                        const SimulationFiles& files, const Monitor& monitor) {
  PassageFlow result;
  result.dim = dim;
  {
    FlowSolver<dim> coarse(passage_problem<dim>(given, mesh, true));
    std::filesystem::path checkpoint = files.checkpoint;
    if (!checkpoint.empty()) checkpoint += ".coarse";
    coarse.solve(monitor, checkpoint);
    result.coarse_drop = drop_of(coarse, given);
    result.costs = coarse.costs();
  }
  monitor.report("passage on the coarser mesh", 1.0);
  FlowSolver<dim> solver(passage_problem<dim>(given, mesh, false));
  solver.solve(monitor, files.checkpoint);
  monitor.report("passage on the finer mesh", 1.0);
  result.drop = drop_of(solver, given);
  constexpr double kEdges = 2e-3;
  const double factor = uncertainty_of_difference({{3, 2}});  // of graded_edges(), at least
  result.drop_uncertainty = factor * std::abs(result.drop - result.coarse_drop);
  double scale = std::abs(result.drop);
  if (has_edges(given)) {
    scale = pressure_scale(given, result.drop, dim);
    const double unseen = unseen_recovery(given, PassageGeometry(given, dim), dim);
    result.drop_uncertainty = std::hypot(std::max(result.drop_uncertainty, kEdges * scale), unseen);
  }
  result.converged = result.drop_uncertainty <= mesh.tolerance * scale;
  const FlowCosts fine = solver.costs();
  result.costs.n_unknowns = fine.n_unknowns;
  result.costs.n_newton_steps += fine.n_newton_steps;
  result.costs.n_iterations += fine.n_iterations;
  result.costs.largest_residual = std::max(result.costs.largest_residual, fine.largest_residual);
  result.costs.grad_div = result.costs.grad_div || fine.grad_div;
  if (!files.vtu.empty()) {
    const double height = given.channel.height.si();
    const double speed = given.flow_rate.si() / (height * given.channel.width.si());
    write_vtu<dim>(files.vtu, solver,
                   {height, speed, given.fluid.viscosity.si() * speed / height,
                    channel_end_pressure(solver, given)});
  }
  return result;
}

}  // namespace

template <int dim>
FlowProblem<dim> passage_problem(const SimulatedPassage& given, const MeshOptions& mesh,
                                 bool coarse) {
  const PassageGeometry geometry(given, dim);
  const double sign = sign_of(given);
  constexpr bool kPlane = dim == 2;
  FlowProblem<dim> problem;
  const CellSizes sizes = sizes_in(dim);
  const auto edges = [&](const Grading& grading) {
    return graded_edges(grading.breaks, grading.spots, sizes.growth, sizes.largest, coarse);
  };
  problem.edges[0] = edges(grading_along(geometry, sizes));
  problem.edges[1] = edges(grading_up(geometry, sizes));
  if constexpr (!kPlane) problem.edges[2] = edges(grading_across(geometry, sizes));
  if (sign < 0.0) {
    for (double& x : problem.edges[0]) x = -x;
    std::reverse(problem.edges[0].begin(), problem.edges[0].end());
  }
  problem.place = [](const Vector<dim>& chart) { return chart; };
  problem.solid = [geometry, sign](const Vector<dim>& chart) {
    double z = 0.0;
    if constexpr (!kPlane) z = chart[2];
    return !geometry.contains(sign * chart[0], chart[1], z);
  };
  const double speed = given.flow_rate.si() / (given.channel.height * given.channel.width).si();
  problem.reynolds = speed * given.channel.height.si() / given.fluid.kinematic_viscosity().si();
  problem.order = mesh.order;
  constexpr int kMostCells = 5000;  // as simulate(): the factors of more would take some 4 GB
  const bool large = !kPlane && mesh.solver == "auto" && n_cells(problem) > kMostCells;
  problem.solver = large || mesh.solver == "iterative" ? SolverKind::iterative : SolverKind::direct;
  const int far = far_side(given, geometry), near = channel_side(given);
  const bool inward = given.end == PassageEnd::inlet;
  problem.sides[inward ? far : near] = {
      SideCondition::velocity, inward
                                   ? entering<dim>(geometry.boxes.back(), geometry.far_axis, sign)
                                   : entering<dim>(geometry.boxes.front(), 0, sign)};
  problem.sides[inward ? near : far].condition = SideCondition::open;
  problem.inlet_flow = 1.0;
  if constexpr (!kPlane) {
    problem.inlet_flow = given.channel.width / given.channel.height;
    if (!geometry.whole_width) {
      problem.sides[SideName::centre].condition = SideCondition::slip;
      problem.inlet_flow = 0.5 * *problem.inlet_flow;
    }
  }
  return problem;
}

template FlowProblem<2> passage_problem<2>(const SimulatedPassage&, const MeshOptions&, bool);
template FlowProblem<3> passage_problem<3>(const SimulatedPassage&, const MeshOptions&, bool);

PassageFlow simulate_passage(const SimulatedPassage& given, const MeshOptions& mesh,
                             const SimulationFiles& files, const Monitor& monitor) {
  mesh.validate();
  return mesh.dim == 2 ? simulate_in<2>(given, mesh, files, monitor)
                       : simulate_in<3>(given, mesh, files, monitor);
}

}  // namespace manoscope::navier_stokes

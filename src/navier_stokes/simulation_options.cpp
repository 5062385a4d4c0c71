#include "simulation_options.hpp"

#include <fmt/format.h>
#include <fmt/ranges.h>

#include <algorithm>
#include <charconv>
#include <cmath>
#include <iterator>
#include <utility>
#include <vector>

#include "manoscope/core/error.hpp"
#include "mesh_pair.hpp"

namespace manoscope::navier_stokes {
namespace {

void check_integer(const char* name, int value, int least, int most) {
  if (value >= least && value <= most) return;
  throw InputError(fmt::format("--{}", name), fmt::format("{} is out of range", value),
                   fmt::format("Give a number from {} to {}", least, most));
}

void check_positive(const char* name, double value, const char* example) {
  if (value > 0.0 && std::isfinite(value)) return;
  throw InputError(
      fmt::format("--{}", name),
      value == 0.0 ? std::string("is missing") : fmt::format("{:g} is not positive", value),
      fmt::format("Give it with its unit, e.g. --{} \"{}\"", name, example));
}

void check_cells(const char* name, int value, int least) {
  constexpr int kMostCells = 10000;
  if (value != 0) check_integer(name, value, least, kMostCells);
}

}  // namespace

void MeshOptions::validate() const {
  check_integer("dim", dim, 2, 3);
  check_integer("order", order, 2, 4);
  check_cells("cells-along", cells_along, 6);
  check_cells("cells-up", cells_up, kFewestCells);
  check_cells("cells-across", cells_across, kFewestCells);
  constexpr const char* kSolvers[] = {"auto", "direct", "iterative"};
  if (std::find(std::begin(kSolvers), std::end(kSolvers), solver) == std::end(kSolvers)) {
    throw InputError("--solver", fmt::format("\"{}\" is none", solver),
                     "Choose direct, iterative or auto");
  }
  if (!(tolerance > 0.0 && tolerance < 1.0)) {
    throw InputError("--tolerance", fmt::format("{:g} is out of range", tolerance),
                     "Give a part of the drop between 0 and 1, e.g. 0.005");
  }
}

void SimulationOptions::validate() const {
  check_positive("height", height.si(), "175 um");
  check_positive("width", width.si(), "1.7 mm");
  check_positive("flow-rate", flow_rate.si(), "70 mL/min");
  check_positive("viscosity", viscosity.si(), "1 mPa s");
  check_positive("density", density.si(), "998 kg/m3");
  validate_solution();
}

void SimulationOptions::validate_solution() const {
  constexpr const char* kInlets[] = {"auto", "developed", "uniform", "both"};
  if (std::find(std::begin(kInlets), std::end(kInlets), inlet) == std::end(kInlets)) {
    throw InputError("--inlet", fmt::format("\"{}\" is no profile", inlet),
                     "Choose developed, uniform, both or auto");
  }
  static_cast<void>(wall_shape_of(*this));
  for (const auto& [name, length] :
       {std::pair{"lead-in", lead_in}, std::pair{"lead-out", lead_out}}) {
    if (length >= Length{} && std::isfinite(length.si())) continue;
    throw InputError(fmt::format("--{}", name), fmt::format("{:g} m is out of range", length.si()),
                     "Give a length, or 0um for none");
  }
  constexpr int kMostStations = 100000;
  check_integer("stations", stations, 2, kMostStations);
  mesh.validate();
}

bool leaves_wall_shape(const SimulationOptions& options) {
  constexpr const char* kOpen[] = {"auto", "map", "response"};
  return std::find(std::begin(kOpen), std::end(kOpen), options.wall_shape) != std::end(kOpen);
}

flow::WallShape wall_shape_of(const SimulationOptions& options) {
  if (leaves_wall_shape(options) || options.wall_shape == "parabola") {
    return flow::WallShape::parabola();
  }
  constexpr std::size_t kMost = 12;
  std::vector<double> coefficients;
  const char* at = options.wall_shape.data();
  const char* const end = at + options.wall_shape.size();
  while (at < end && coefficients.size() <= kMost) {
    double value = 0.0;
    const auto [next, fault] = std::from_chars(at, end, value);
    if (fault != std::errc() || !std::isfinite(value) || (next != end && *next != ',')) break;
    coefficients.push_back(value);
    at = next == end ? end : next + 1;
  }
  if (at != end || coefficients.empty() || options.wall_shape.back() == ',') {
    throw InputError("--wall-shape", fmt::format("\"{}\" is no shape", options.wall_shape),
                     "Give map, parabola, or up to 12 numbers with commas, as 1,-2,1");
  }
  return flow::WallShape(std::move(coefficients));
}

std::string wall_shape_text(const flow::WallShape& shape) {
  return fmt::format("{}", fmt::join(shape.coefficients(), ","));
}

}  // namespace manoscope::navier_stokes

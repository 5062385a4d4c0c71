#include "given_wall.hpp"

#include <fmt/format.h>

#include "manoscope/core/error.hpp"

namespace manoscope::navier_stokes {

GivenWall::GivenWall(const ShapeTable& table, const SimulationOptions& options) {
  constexpr const char* kOption = "--wall-shape";
  if (options.wall_shape == "response") {
    throw InputError(kOption, "the response is that of an experiment's maps",
                     "Choose map, parabola, or coefficients");
  }
  if (!table.is_map()) {
    if (options.wall_shape == "map") {
      throw InputError(kOption, "the table holds no map, only x and zeta",
                       "Add a column z, or choose another shape");
    }
    profile_.emplace(table.x, Array1(table.zeta.col(0)));
    return;
  }
  if (!leaves_wall_shape(options)) {
    throw InputError(kOption, fmt::format("\"{}\" stands beside a map", options.wall_shape),
                     "Leave it out, or the column z of the table");
  }
  map_.emplace(table, options.width);
  require_open_gap(*map_, options.height);
}

std::function<double(double x, double z)> GivenWall::zeta(const SimulationOptions& options) const {
  const double start = along().x()[0];
  if (options.mesh.dim == 2) {
    return [this, start](double x, double) { return along().value(start + x); };
  }
  if (map_) return [this, start](double x, double z) { return map_->even(start + x, z); };
  return [this, start, shape = wall_shape_of(options), side = 0.5 * options.width.si()](
             double x, double z) { return along().value(start + x) * shape.value(z / side); };
}

RoofNote GivenWall::note(const SimulationOptions& options) const {
  if (options.mesh.dim == 2) return {};
  if (!map_) return {"shape", 0.0};
  constexpr double kRoundOff = 1e-12;  // m, of a symmetric map
  const double odd = map_->odd();
  return {"map", odd < kRoundOff ? 0.0 : odd};
}

}  // namespace manoscope::navier_stokes

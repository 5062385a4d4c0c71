#include "manoscope/flow/marching.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>

#include "manoscope/core/error.hpp"

namespace manoscope::flow {

MarchGrid march_grid(const Array1& x, InletProfile inlet, double development_length) {
  if (x.size() < 2) {
    throw InputError("marching flow model", fmt::format("{} station(s)", x.size()),
                     "Give at least two, from the inlet to the outlet");
  }
  for (Index i = 0; i < x.size(); ++i) {
    if (std::isfinite(x(i)) && (i == 0 || x(i) > x(i - 1))) continue;
    throw InputError(
        "marching flow model",
        fmt::format("station {} at x = {:.6g} mm does not follow the one before it", i, x(i) * 1e3),
        "Sort the stations along the flow and drop duplicates");
  }
  std::vector<double> places{0.0};
  MarchGrid grid;
  grid.stations.push_back(0);
  const double spacing = x(1) - x(0);
  if (inlet == InletProfile::uniform) {
    double step = std::min(1e-6 * development_length, 0.1 * spacing);
    double at = step;
    while (at + 0.5 * step < spacing) {
      places.push_back(at / spacing);
      step *= 1.25;
      at += step;
    }
  }
  for (Index i = 1; i < x.size(); ++i) {
    grid.stations.push_back(static_cast<Index>(places.size()));
    places.push_back(static_cast<double>(i));
  }
  grid.place = Eigen::Map<const Array1>(places.data(), static_cast<Index>(places.size()));
  grid.x = on_grid(grid, x);
  return grid;
}

Array1 on_grid(const MarchGrid& grid, const Array1& values) {
  Array1 result(grid.place.size());
  for (Index i = 0; i < result.size(); ++i) {
    const double place = grid.place(i);
    const Index left = std::min(static_cast<Index>(place), values.size() - 2);
    const double part = place - static_cast<double>(left);
    result(i) =
        part == 1.0 ? values(left + 1) : values(left) + part * (values(left + 1) - values(left));
  }
  return result;
}

void flag_downstream(Flags1& flags) {
  bool met = false;
  for (Index i = 0; i < flags.size(); ++i) {
    if (met) flags(i) |= MarchFlag::after_separation;
    met = met || (flags(i) & MarchFlag::separated) != 0;
  }
}

}  // namespace manoscope::flow

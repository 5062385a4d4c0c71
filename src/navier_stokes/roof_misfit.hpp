#pragma once

#include <functional>
#include <vector>

namespace manoscope::navier_stokes {

/// How far the roof of a mesh lies from the one that it is made for.
struct RoofMisfit {
  double share = 0.0;       ///< of the gap, at the worst place
  double x = 0.0, z = 0.0;  ///< of it, in the unit of the edges
};

/// The worst of a grid of places between the nodes of a mesh of cells whose roof is a polynomial of
/// the given order, through Gauss and Lobatto's points in every cell.
///
/// A roof that is too steep or too wrinkled for its cells shows here before any flow is solved.
/// @param gap      h(x, z).
/// @param edges_x  ends of the cells, ascending.
/// @param edges_z  the same across; empty: the roof is asked at z = 0 alone.
/// @param order    2 to 4.
/// @throws what `gap` throws.
RoofMisfit roof_misfit(const std::function<double(double x, double z)>& gap,
                       const std::vector<double>& edges_x, const std::vector<double>& edges_z,
                       int order);

}  // namespace manoscope::navier_stokes

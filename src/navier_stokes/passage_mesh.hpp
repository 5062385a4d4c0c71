#pragma once

#include <vector>

namespace manoscope::navier_stokes {

/// Where cells are small: `size` at `place`, growing away from it.
struct FineSpot {
  double place = 0.0, size = 1.0;
};

/// Ends of the cells along one axis, graded.
///
/// The size asked for at x is the smallest of size + growth |x - place| over all spots, and not
/// above `largest`. Between two breaks lie the integral of 1/size cells, rounded up to 3, 5, 6, 8,
/// 9 or so on, each with an equal share of it: the coarser mesh has at most two thirds of them.
/// @param breaks  ends of cells in any case; two or more, in any order, repeats within round-off.
/// @param spots   at least one, sizes > 0.
/// @param growth  > 0.
/// @param largest > 0.
/// @param coarse  two thirds of the cells of each stretch, or somewhat fewer: a second mesh.
std::vector<double> graded_edges(std::vector<double> breaks, const std::vector<FineSpot>& spots,
                                 double growth, double largest, bool coarse);

}  // namespace manoscope::navier_stokes

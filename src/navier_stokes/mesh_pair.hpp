#pragma once

#include <utility>
#include <vector>

namespace manoscope::navier_stokes {

/// Fewest cells along an axis, or a stretch of one, of which a coarser mesh has fewer but not one.
constexpr int kFewestCells = 3;

/// Cells of the coarser of two meshes where the finer has n >= kFewestCells: two thirds, rounded.
int coarser_cells(int n);

/// Standard uncertainty of a value over its difference d on two meshes.
///
/// Richardson's estimate (e.g. P. J. Roache, J. Fluids Eng. 116 (1994) 405) as if the error fell
/// with the first power of the size of the cells, u = |d| / (r - 1), r the smallest ratio of the
/// numbers of cells over all axes: where errors of all axes have one sign, d holds at least r - 1
/// times each.
/// @param cells  of the finer and of the coarser mesh along each axis, the first larger.
double uncertainty_of_difference(const std::vector<std::pair<int, int>>& cells);

}  // namespace manoscope::navier_stokes

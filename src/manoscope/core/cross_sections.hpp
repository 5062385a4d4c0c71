#pragma once

#include <vector>

#include "manoscope/core/arrays.hpp"

namespace manoscope {

/// Deflection of one map in cells: stretches along the flow by bins across the width.
///
/// Arrays have shape (n_z, n_x). A cell counts only where `flags` is 0; values elsewhere are 0 and
/// mean nothing. Empty where a map shows too few pixels across the width for it.
struct CrossSections {
  Array1 x;      ///< (n_x) m, middle of each stretch, from the inlet edge
  Array1 z;      ///< (n_z) m, middle of each bin, from the middle of the wall in this map
  Array2 zeta;   ///< m, mean over the cell
  Array2 sigma;  ///< m, standard uncertainty from pixel noise, independent from cell to cell
  Flags2 flags;  ///< bits of PixelFlag; 0 = good

  bool empty() const { return x.size() == 0; }
};

/// Mean of repeats of the same state, cell by cell over those that count; x is the mean of theirs.
/// @param repeats  of the same cells; at least one. Empty ones are left out.
CrossSections mean_sections(const std::vector<CrossSections>& repeats);

}  // namespace manoscope

#pragma once

#include <optional>
#include <vector>

namespace manoscope::maps {

/// A shift (m) or an angle (rad) of one map and its standard uncertainty.
struct OneShift {
  double value = 0.0, uncertainty = 0.0;
};

struct CombinedShifts {
  std::vector<std::optional<OneShift>> shifts;  ///< one a map, counted as those of the edges
  bool agree = true;  ///< false: the texture contradicts the edges and was left out
};

/// Puts together what the wall's edges and the frame's texture say of the maps' shifts.
///
///   edge_i = s_i + noise,   texture_i = s_i + c + noise
///
/// Both by inverse variance; c, the place of the texture's map of reference, from the differences:
///
///   c = sum_i (texture_i - edge_i) / (u_e^2 + u_t^2) / sum_i 1 / (u_e^2 + u_t^2)
///
/// which are not correlated with the weighted mean of edge_i and texture_i - c, so that
/// u^2 = 1 / (u_e^-2 + u_t^-2) + (u_e^2 / (u_e^2 + u_t^2))^2 u_c^2. A map without edges gets
/// texture_i - c, one without texture keeps its edge.
///
/// The edges are the wall's own and win: a map whose two shifts lie more than four standard
/// uncertainties of their difference apart keeps its edge; if more than a quarter of the maps do,
/// or fewer than three are left to compare, no texture counts. For what is in every map and never
/// moves, such as marks on the instrument's mirror, is a texture, too.
///
/// Source: our own; least squares for s_i and c.
/// @param edges, texture  of the same maps.
CombinedShifts combine_shifts(const std::vector<std::optional<OneShift>>& edges,
                              const std::vector<std::optional<OneShift>>& texture);

}  // namespace manoscope::maps

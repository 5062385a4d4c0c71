#pragma once

#include "manoscope/core/cross_sections.hpp"
#include "manoscope/core/deflection_map.hpp"
#include "manoscope/maps/centre_line.hpp"

namespace manoscope::maps {

/// Cuts a deflection map into the cells of CrossSections.
///
/// Stretches are an eighth of the width long, or one column; there are at most 16 bins across, none
/// narrower than three pixels. They leave out 2 % of the width, or 1.5 pixels, at either side,
/// where the wall has its kink. Every map of one camera and channel gives the same cells.
///
/// The mean across is that of the straight lines between pixels, so that it does not hang on where
/// pixels lie in a bin. Single pixels that stand off their row by ten deviations of the noise are
/// left out: along the flow a wall is smooth, where across despiking must spare its bend. They and
/// missing pixels are bridged along the flow by straight lines, up to a tenth of the width (2.5
/// pixels at least); a cell with a wider gap is flagged.
///
/// Uncertainty: pixel noise, and what the bridges miss of the wall's curvature along the flow.
///
/// @param noise   standard deviation of one pixel.
/// @param centre  where the middle of the wall runs in this map: bins count from there.
/// @return empty where fewer than 8 bins fit.
CrossSections cut_sections(const DeflectionMap& map, Length channel_length, Length channel_width,
                           Length noise, const CentreLine& centre);

}  // namespace manoscope::maps

#pragma once

#include <vector>

#include "manoscope/core/units.hpp"
#include "manoscope/maps/channel_map.hpp"
#include "manoscope/maps/fringe_jumps.hpp"

namespace manoscope::maps {

/// What was done about patches of a false fringe order.
struct FringePatches {
  int mended = 0;   ///< patches lifted to their surroundings
  int flagged = 0;  ///< patches that are no plain jump, flagged PixelFlag::fringe_order
  Index mended_pixels = 0, flagged_pixels = 0;
  int outlined = 0;  ///< patches that mend_fringe_islands() left to mend_outlined_islands()
};

/// Mends patches that the wall on both sides of them, along the flow, tells from itself.
///
/// Along the flow a wall changes slowly. A patch begins on a row with a jump by a whole number of
/// half wavelengths and ends, within 24 pixels, with the same jump back or in missing pixels; rows
/// that touch, or lie up to six apart (where missing pixels hide its ends), make one patch. Each of
/// its pixels, and those two pixels around, is then held against the wall's course along its row: a
/// straight line and the mean courses of the rows next above and below the patch, each with a
/// factor, fitted to the good pixels within fifteen on either side. Those a whole number of half
/// wavelengths off it are lifted, those near it stay, others are flagged. A patch whose
/// surroundings do not follow such a course is left alone.
///
/// So a patch is found that lies across the clamped side, on a steep flank, where the map's own
/// bend across the flow hides a part of its border, or near an end, where the wall bends along the
/// flow.
///
/// Source: our own. Validity: noise below an eighth of the wavelength; patches up to 24 pixels long
/// along the flow and four pixels large.
/// @param jumps  of find_fringe_jumps().
/// @param noise  standard deviation of one pixel.
FringePatches mend_fringe_islands(ChannelMap& map, const std::vector<FringeJump>& jumps,
                                  Length noise, Length wavelength);

/// Mends what nothing else did: patches that jumps on both sides along the flow outline on nearly
/// every one of five rows or more, whatever the surroundings. What such a row holds is lifted; a
/// row or two at the rim of a patch, whose few pixels show no jumps, may stay.
///
/// Such patches lie between a flank and an end: their rows bend along the flow, and no two alike.
/// @param found  gets what was mended.
void mend_outlined_islands(ChannelMap& map, const std::vector<FringeJump>& jumps, Length noise,
                           Length wavelength, FringePatches& found);

}  // namespace manoscope::maps

#pragma once

#include <optional>

#include "manoscope/core/units.hpp"
#include "manoscope/maps/channel_map.hpp"
#include "manoscope/maps/fringe_islands.hpp"

namespace manoscope::maps {

/// Finds patches that stand off their surroundings by a sharp step, as an interferometer leaves
/// them where it miscounts fringes, and mends them.
///
/// A step between two neighbouring pixels is a jump if it lies farther than a quarter of the
/// wavelength (without one: 50 nm, or eight deviations of the noise if that is more) outside the
/// range of the steps before and behind it on the same line, and exceeds twice their own
/// changes: so neither slopes nor bends nor the kink at a clamped edge count. Jumps cut the map
/// into patches. From the largest patch outwards each is lifted by the whole number of half
/// wavelengths nearest to the mean of the jumps along its border; without a wavelength by that mean
/// itself. A patch whose jumps do not agree within the noise, or with no whole number, is flagged.
/// So is one below four pixels: noise, or a spike that flag_spikes() overlooks. Where the
/// wavelength is known, patches that show along the flow are mended first (mend_fringe_islands()).
///
/// Source: our own. Validity: noise below an eighth of the wavelength (else nothing is done); steps
/// sharp within one pixel. A patch whose border shows a gap is not found here: so it may be where
/// the wall itself rises by more than the jump from pixel to pixel and bends.
/// @param noise       standard deviation of one pixel.
/// @param wavelength  of the interferometer, if known.
FringePatches mend_fringe_patches(ChannelMap& map, Length noise, std::optional<Length> wavelength);

}  // namespace manoscope::maps

#pragma once

#include "manoscope/core/units.hpp"
#include "manoscope/maps/channel_map.hpp"

namespace manoscope::maps {

/// Flags pixels that stand alone against their neighbours, never changing a height.
///
/// A pixel's step along an axis is its distance from the mean of its two neighbours at +-1 or of
/// those at +-2, whichever is smaller; its step is the smaller of those along x and along z. So
/// neither the slope of a bulge nor the kink at its clamped edge counts, nor a spike next door. A
/// pixel is a spike if its step exceeds both `threshold` times the noise and `threshold` / 1.3
/// times the upper decile of the steps of the 7 x 7 pixels around it, so that a curved wall on a
/// coarse camera stays unflagged. Without noise (well below 20 nm) a pixel at a clamped corner may
/// still be flagged. Two spikes side by side show half their size; patches wider than
/// two pixels are not found, nor pixels with fewer than two good neighbours along either axis, nor
/// one of two spikes two pixels apart along an axis, if the other is twice as high: where
/// mend_fringe_patches() follows it flags these.
/// @param noise      standard deviation of one pixel, > 0.
/// @param threshold  about 6: one false alarm in 10^9 normal pixels or fewer.
/// @return number of pixels newly flagged.
Index flag_spikes(ChannelMap& map, Length noise, double threshold);

}  // namespace manoscope::maps

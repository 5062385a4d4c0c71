#pragma once

#include <optional>
#include <string>
#include <vector>

#include "manoscope/core/profile.hpp"
#include "manoscope/core/units.hpp"

namespace manoscope::maps {

/// How far a wall has moved along the flow in one map, against the frame.
struct MapShift {
  Length shift{};        ///< the wall of this map lies so much further downstream
  Length uncertainty{};  ///< standard
};

/// Shifts of the maps of one experiment.
struct Registration {
  /// One a map, without the offset; none where the map does not show enough of a rising wall.
  std::vector<std::optional<MapShift>> hydrostatic, flow;
  /// Where the middle between the wall's two ends lies against that of the frame, over the
  /// hydrostatic maps: a frame placed rightly, and a wall clamped alike at both ends, give 0.
  std::optional<MapShift> offset;
};

/// Shifts along the flow from the ends of the wall, where it begins to move.
///
/// From each end a profile is brought to the form y = (zeta - b x)/A, A + b x the straight line
/// through it between 0.7 and 1.3 widths from the end, so that a pressure gradient changes y only
/// to second order. y passes the fractions f = 0.1 ... 0.5 at the distances e(f).
///
/// - Hydrostatic maps: both ends stand under the same pressure, so that a wall clamped alike at
///   both has the same e(f) from both, and half their difference is the shift, extrapolated to
///   f = 0 by a straight line in f. Half their sum is the wall's own inset s(f; A).
/// - Flow maps: the end under the higher pressure alone, e(f) - s(f; A) with s between those of
///   the hydrostatic maps, extrapolated likewise: what the gradient still does to y falls with f.
///
/// The offset common to all hydrostatic maps is told apart: it belongs to the frame. Uncertainties
/// hold the noise of the profiles, eight times what the straight lines in f leave over (what
/// non-uniform pressure does that they do not describe) and 0.1 um.
///
/// Source: our own. Accuracy on walls of the kind of the paper's S1, S3 and S5 (pixels of 16 um,
/// flow up to the largest rate): hydrostatic maps 0.1 um, flow maps 0.4 um; thick short walls such
/// as S4 3 um, and said so by the uncertainty. Validity: walls longer than 3 widths, profiles in
/// the channel's frame to within 5 pixels; pressures that bend little within 1.3 widths of the
/// end.
///
/// @param hydrostatic, flow  profiles on the same stations.
/// @throws InputError if length or width is not positive.
Registration register_profiles(const std::vector<const Profile*>& hydrostatic,
                               const std::vector<const Profile*>& flow, Length length,
                               Length width);

/// The profile as a map without the shift would have shown it: zeta(x + shift) by the cubic through
/// four stations, a straight line where one of the outer two is bad; no_data where it is not known.
/// The error mode "shift of NAME" is scaled to the new uncertainty.
/// @param assumed  the standard uncertainty that the mode holds so far.
void move_profile(Profile& profile, const MapShift& shift, const std::string& name, Length assumed);

}  // namespace manoscope::maps

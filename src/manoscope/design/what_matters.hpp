#pragma once

#include <functional>
#include <optional>
#include <string>
#include <vector>

#include "manoscope/design/place_levels.hpp"
#include "manoscope/wall/clamped_wall.hpp"

namespace manoscope::design {

/// What may be improved about an experiment besides its levels.
enum class Lever {
  gauge_noise,
  pixel_noise,
  map_position,
  flow_maps,
  gauge_zero,
  gauge_gain,
  wall_stiffness,
};

/// All of them that this apparatus has: an error of zero cannot be made smaller.
std::vector<Lever> levers(const Apparatus& apparatus);

/// The apparatus with a lever at a share of its present size; flow maps grow by its inverse. A wall
/// of less stiffness deflects as far at that share of the pressure: what its maps show is worth as
/// much less noise as it answers more, at half the highest pressure; levels are left where they
/// are.
Apparatus improved(const Apparatus& apparatus, Lever lever, double share);

/// "gauge noise", and its present value, "10 Pa".
std::string lever_name(Lever lever);
std::string lever_value(const Apparatus& apparatus, Lever lever);

/// The largest share of a lever's size with which levels do; none if nothing above a fiftieth does.
///
/// @param enough  whether a apparatus does; that a better one does too is taken for granted.
std::optional<double> needed_share(const Apparatus& apparatus, Lever lever,
                                   const std::function<bool(const Apparatus&)>& enough);

/// Whether a wall whose stiffness is a share of this one's would still be within its theory.
bool still_bears(const PlacementTask& task, const wall::ClampedWall& wall, double share);

/// Levels as they are, with something about the experiment improved.
struct Improvement {
  std::string name;
  RangeUncertainty over;
  double drop = 0.0;  ///< Pa, uncertainty of the drop over the range
};

/// Every lever halved, flow maps fourfold, and every level twice.
std::vector<Improvement> find_improvements(const PlacementTask& task,
                                           const std::vector<double>& levels,
                                           const wall::ClampedWall& wall);

}  // namespace manoscope::design

#pragma once

#include <array>
#include <optional>
#include <string>
#include <vector>

#include "manoscope/core/frame.hpp"
#include "manoscope/core/height_map.hpp"

namespace manoscope::maps {

/// What is already known of the channel's place; what is absent is found.
struct KnownPlace {
  Length length{}, width{};
  std::optional<std::array<Length, 2>> origin;
  std::optional<FlowDirection> flow;
  std::optional<Angle> rotation;
  std::optional<Outward> outward;

  /// Nothing but the side across is left to settle: without an origin the rotation is found, with
  /// one it is 0 unless given.
  bool complete() const { return origin && flow && outward; }
};

/// The wall's answer to pressure, pixel by pixel, and where the channel was found in it.
struct FoundPlace {
  ChannelFrame frame;
  /// Distance between the two ends (sides) at which the wall begins to move, minus the stated
  /// length (width): should be near 0. NaN where the place was given.
  double length_misfit = 0.0, width_misfit = 0.0;  ///< m
  /// Where the origin was given: the middle between the wall's ends (sides) minus that of the
  /// frame, along the flow (across it, towards growing z). NaN where it was found, or no wall is
  /// made out.
  double along_misfit = 0.0, across_misfit = 0.0;  ///< m
};

/// Two states of the wall whose difference shows it: a low and a high pressure, and, if there is
/// one, a state under flow.
struct RegionMaps {
  const HeightMap* low = nullptr;
  const HeightMap* high = nullptr;
  const HeightMap* flowing = nullptr;  ///< may be absent
};

/// Finds what is not known of the channel's place from the pixels that answer to pressure.
///
/// The response high - low is leveled on the border of the map (the outermost 4 %), its sign gives
/// `outward`, its longer side the axis, the points where its row and column means rise from zero
/// the ends and sides, whose middle places the rectangle of the stated length and width; the drift
/// of the middle line along the channel gives the rotation, kept only where it is above 1 mrad. The
/// half with the larger share of the static deflection under flow is the inlet's. Where the origin
/// is given but not the side to which the channel extends from it, the side that lies within the
/// map is taken, and the side of larger response where both do; likewise for the direction of the
/// flow where no map shows it. A rotation is only looked for together with the origin.
///
/// @throws InputError if nothing in the maps answers to pressure, or the channel does not fit in
/// them.
FoundPlace find_place(const RegionMaps& maps, const KnownPlace& known, const std::string& name);

}  // namespace manoscope::maps

#pragma once

#include <optional>
#include <string>

#include "manoscope/core/deflection_map.hpp"
#include "manoscope/core/frame.hpp"
#include "manoscope/core/height_map.hpp"
#include "manoscope/core/profile.hpp"
#include "manoscope/maps/noise.hpp"
#include "manoscope/maps/width_average.hpp"

namespace manoscope::maps {

struct ReduceOptions {
  double spike_threshold = 6.0;  ///< in standard deviations of one pixel
  /// Auto: the larger of 3 pixels and 2 % of the width, at most half the rim on its widest side.
  std::optional<Length> rim_margin;
  /// Standard uncertainty of each map's own position along the flow. Auto: 0.29 pixel, a shift
  /// anywhere within half a pixel, which is what unregistered maps of one mount show.
  std::optional<Length> shift_uncertainty;
  WidthAverageOptions width;

  template <class Visitor>
  void describe(Visitor&& visit) {
    visit("spike-threshold", spike_threshold, "spikes stand out by this many noise deviations");
    visit("rim-margin", rim_margin, "distance from the channel at which the rigid rim begins");
    visit("shift-uncertainty", shift_uncertainty,
          "standard uncertainty of each map's position along the flow");
    width.describe(visit);
  }
  /// @throws InputError naming the option out of range.
  void validate() const;
};

/// What a map was like: for the report, and for eyes that look for trouble.
struct MapCondition {
  std::string name;
  double tilt_x = 0.0, tilt_z = 0.0;  ///< m/m, of the rim's plane
  PixelNoise noise;                   ///< as measured on the rim
  double missing = 0.0;               ///< share of pixels without data
  double spikes = 0.0;                ///< share of pixels flagged as spikes
};

/// One map reduced to its profile.
struct ReducedMap {
  Profile profile;
  MapCondition condition;
  double crest = 0.0;              ///< m, deflection at mid-channel on the centre line; NaN if bad
  double crest_uncertainty = 0.0;  ///< m, standard
};

/// The deflection map of a height map: channel frame, rim's plane, spikes, noise.
struct LeveledMap {
  DeflectionMap deflection;
  RimPlane plane;
  MapCondition condition;
};

/// Height map -> deflection map from the plane of the rigid rim.
///
/// @param height_noise  standard deviation of one pixel if known; else it is measured on the rim.
/// @throws InputError naming the map, e.g. where it shows no rigid rim.
LeveledMap level_map(const HeightMap& map, const ChannelFrame& frame,
                     std::optional<Length> height_noise, const std::string& name,
                     const ReduceOptions& options = {});

/// Height map -> width-averaged profile zeta(x), with noise, leveling and position errors.
///
/// The position error is a shared mode ("shift of NAME", source "registration") with effect
/// dzeta/dx times `shift_uncertainty`.
ReducedMap reduce_map(const HeightMap& map, const ChannelFrame& frame,
                      std::optional<Length> height_noise, const std::string& name,
                      const ReduceOptions& options = {});

/// The map minus the instrument's own flat reference (a map of a flat mirror on the same pixels).
///
/// Only ever done when the user names such a map: the map at zero pressure is no reference, for a
/// buckled wall is not flat.
/// @throws InputError if the grids differ.
HeightMap subtract_reference(const HeightMap& map, const HeightMap& reference,
                             const std::string& name);

}  // namespace manoscope::maps

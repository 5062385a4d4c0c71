#pragma once

#include <optional>
#include <string>

#include "manoscope/core/cross_sections.hpp"
#include "manoscope/core/deflection_map.hpp"
#include "manoscope/core/frame.hpp"
#include "manoscope/core/height_map.hpp"
#include "manoscope/core/map_picture.hpp"
#include "manoscope/core/profile.hpp"
#include "manoscope/maps/centre_line.hpp"
#include "manoscope/maps/frame_texture.hpp"
#include "manoscope/maps/fringe_order.hpp"
#include "manoscope/maps/noise.hpp"
#include "manoscope/maps/registration.hpp"
#include "manoscope/maps/rim_bend.hpp"
#include "manoscope/maps/width_average.hpp"

namespace manoscope::maps {

struct ReduceOptions {
  double spike_threshold = 6.0;  ///< in standard deviations of one pixel
  /// Auto: the larger of 3 pixels and 2 % of the width, at most half the rim on its widest side.
  std::optional<Length> rim_margin;
  /// Standard uncertainty of each map's own position along the flow. Auto: 0.29 pixel, a shift
  /// anywhere within half a pixel, which is what unregistered maps of one mount show.
  std::optional<Length> shift_uncertainty;
  /// Find each map's position from the wall's own ends (register_profiles()) and from the texture
  /// of the frame, if it has one (find_texture_shift()); off where a
  /// shift_uncertainty is stated.
  bool registration = true;
  /// Order of the surface through the rim that zeta counts from: 1, a plane; 2 where the frame
  /// bends from map to map.
  int level_order = 1;
  /// Mend patches of a false fringe order (mend_fringe_patches()).
  bool fringe_order = true;
  WidthAverageOptions width;

  template <class Visitor>
  void describe(Visitor&& visit) {
    visit("spike-threshold", spike_threshold, "spikes stand out by this many noise deviations");
    visit("rim-margin", rim_margin, "distance from the channel at which the rigid rim begins");
    visit("shift-uncertainty", shift_uncertainty,
          "standard uncertainty of each map's position along the flow");
    visit("registration", registration,
          "shift each map along the flow until the ends of its wall lie where they should");
    visit("level-order", level_order,
          "order of the surface through the rigid rim: 1, a plane; 2 if the frame bends");
    visit("fringe-order", fringe_order, "find and mend patches of a false fringe order");
    width.describe(visit);
  }
  /// @throws InputError naming the option out of range.
  void validate() const;
};

/// Distance from the channel at which its rim begins: the larger of 3 pixels and 2 % of the width,
/// but no more than half the rim that the map shows on its widest side.
Length auto_rim_margin(const ChannelGrid& grid, const ChannelFrame& frame);

/// What a map was like: for the report, and for eyes that look for trouble.
struct MapCondition {
  std::string name;
  double tilt_x = 0.0, tilt_z = 0.0;  ///< m/m, of the rim's plane
  PixelNoise noise;                   ///< as measured on the rim
  double missing = 0.0;               ///< share of pixels without data
  double spikes = 0.0;                ///< share of pixels flagged as spikes
  /// How far the wall had moved along the flow, taken back, and what is left of doubt about it.
  MapShift shift{};
  FringePatches fringe;
  RimBend bend;  ///< of the rim beyond its plane, subtracted only with level_order = 2
  std::optional<CentreLine> centre;     ///< of the wall, against the frame's axis; if it shows
  CentreLine placement;                 ///< what of it was taken back
  std::optional<TextureShift> texture;  ///< of the frame, against the map of reference
  bool texture_contradicts = false;     ///< the ends of the walls: left out in all maps
};

/// What is known of a map besides its heights.
struct MapKnowledge {
  std::optional<Length> height_noise{};   ///< standard deviation of one pixel; else from the rim
  std::optional<Length> wavelength{};     ///< of the interferometer
  CentreLine placement{};                 ///< where the wall's middle runs in this map
  const FrameTexture* texture = nullptr;  ///< of the map of reference; null: not looked for
  Index picture_cells = 0;                ///< of ReducedMap::picture, at most; 0: no picture
};

/// One map reduced to its profile.
struct ReducedMap {
  Profile profile;
  CrossSections sections;  ///< from the wall's own middle where it shows, else the placement
  MapCondition condition;
  double crest = 0.0;              ///< m, deflection at mid-channel on the centre line; NaN if bad
  double crest_uncertainty = 0.0;  ///< m, standard
  MapPicture picture;              ///< empty unless asked for
};

/// The deflection map of a height map: channel frame, rim's plane, spikes, noise.
struct LeveledMap {
  DeflectionMap deflection;
  RimPlane plane;
  MapCondition condition;
};

/// Height map -> deflection map from the plane of the rigid rim.
///
/// @throws InputError naming the map, e.g. where it shows no rigid rim.
LeveledMap level_map(const HeightMap& map, const ChannelFrame& frame, const MapKnowledge& known,
                     const std::string& name, const ReduceOptions& options = {});

/// Height map -> width-averaged profile zeta(x), with noise, leveling and position errors.
///
/// The position error is a shared mode ("shift of NAME", source "registration") with effect
/// dzeta/dx times `shift_uncertainty`, until register_maps() knows better.
ReducedMap reduce_map(const HeightMap& map, const ChannelFrame& frame, const MapKnowledge& known,
                      const std::string& name, const ReduceOptions& options = {});

/// The rim's texture of the map that the others are registered against.
FrameTexture texture_of_reference(const HeightMap& map, const ChannelFrame& frame,
                                  const MapKnowledge& known, const std::string& name,
                                  const ReduceOptions& options = {});

/// The first of the maps is the reference: it has not moved, as well as that is known (the median
/// of the others' uncertainties over root 2: of the noise of two maps its own). Nothing where no
/// map shows a texture.
void place_reference(std::vector<ReducedMap>& reduced);

/// Where the walls of maps lie across the flow and at which angle.
struct Placements {
  /// Median over the hydrostatic maps that show it: what belongs to the frame.
  std::optional<CentreLine> common;
  /// One a map, against the common line: zero where the wall lies as in the others, or does not
  /// show.
  std::vector<CentreLine> own;
};

/// From the sides of the wall and, where the frame has one, from its texture (combine_shifts()). A
/// map counts as moved if its wall's middle lies farther than 0.3 pixels from the others'
/// anywhere and by more than four standard uncertainties.
///
/// What remains of shift and rotation is no line of the budget, for the wall is clamped at both
/// sides: an average whose window lies off by d loses 3 (d / w)^2 of a membrane, which is a
/// parabola across, and less of a plate, whose sides begin level. At 0.3 pixels and 40 pixels
/// across the width that is 1.7e-4 of it, 2.2 nm of 13 um, where white noise of 20 nm a pixel
/// leaves 3.2 nm in the same average; with more pixels it falls as the square of their number,
/// noise as its root.
Placements find_placements(const std::vector<ReducedMap>& reduced, std::size_t n_hydrostatic,
                           Length length, Length pitch_z);

/// Finds the shift of every map by register_profiles() and from the frame's texture
/// (combine_shifts()) and takes it back, with all that
/// move_profile() says. A map whose shift is not found, or less well than it was supposed to be
/// known, stays as it is. Does nothing if the options say so.
///
/// @param largest_offset  count x from the ends of the wall itself, not of the frame, if both lie
/// no
///                        farther apart than this and that is known as well as one map's position:
///                        every map is moved by it, and gets the error mode "place of the frame"
///                        that all share (0.02 % of the width at least: walls are not quite
///                        symmetric).
/// @return where the middle of the wall lies against that of the frame, if the maps tell: 0 where
///         it was taken back.
std::optional<MapShift> register_maps(std::vector<ReducedMap>& hydrostatic,
                                      std::vector<ReducedMap>& flow, Length length, Length width,
                                      const ReduceOptions& options, Length largest_offset = {});

/// The map minus the instrument's own flat reference (a map of a flat mirror on the same pixels).
///
/// Only ever done when the user names such a map: the map at zero pressure is no reference, for a
/// buckled wall is not flat.
/// @throws InputError if the grids differ.
HeightMap subtract_reference(const HeightMap& map, const HeightMap& reference,
                             const std::string& name);

}  // namespace manoscope::maps

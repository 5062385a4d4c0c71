#pragma once

#include <string>

#include "manoscope/core/deflection_map.hpp"
#include "manoscope/core/profile.hpp"
#include "manoscope/maps/centre_line.hpp"
#include "manoscope/maps/level.hpp"
#include "manoscope/maps/rim_bend.hpp"

namespace manoscope::maps {

struct WidthAverageOptions {
  double largest_gap = 0.1;        ///< widest gap between good pixels, as a share of the width
  double smallest_coverage = 0.5;  ///< least share of good pixels across the width

  template <class Visitor>
  void describe(Visitor&& visit) {
    visit("largest-gap", largest_gap,
          "widest gap between good pixels across the channel, as a share of its width");
    visit("smallest-coverage", smallest_coverage,
          "least share of good pixels across the channel for a station to count");
  }
  /// @throws InputError naming the option out of range.
  void validate() const;
};

/// Width-averaged deflection
///
///   zeta(x) = (1/w) int_{-w/2}^{w/2} zeta(x, z) dz
///
/// at every column of the map inside the channel. Source: Ozsun et al. 2013, eq. (3), by
/// integration, no cross-section assumed: trapezoid rule over the good pixels of a column, the
/// first pixel outside either clamped edge included, or the edge itself with zeta = 0 where that
/// pixel, or the first inside, is missing. A regular column of pitch d errs by
/// about d^2 / 12 times the difference of the edge slopes over w, below 2 nm for 130 pixels across
/// and 50 um; the same for equal shapes, so that it cancels in a pressure reading.
///
/// Uncertainty: pixel noise of the column (independent from column to column), plus, where pixels
/// are missing, the sag of a parabola across each gap. Errors of the rim's plane are shared modes
/// ("level plane of NAME, k", source "leveling").
///
/// A column counts if its good pixels cover `smallest_coverage` of the width with no gap wider than
/// `largest_gap`; else it is flagged no_data.
/// @param plane  the plane that was subtracted; its covariance (already enlarged for correlated
/// noise)
///               becomes the shared modes.
/// @param centre  where the middle of the wall runs in this map: z counts from there.
/// @param bend    the surface of second order that was subtracted after the plane, if one was: its
///               covariance takes the place of the plane's.
Profile width_average(const DeflectionMap& map, const RimPlane& plane, Length channel_length,
                      Length channel_width, const std::string& name,
                      const WidthAverageOptions& options = {}, const CentreLine& centre = {},
                      const RimBend* bend = nullptr);

/// Adds the error modes that the stations of a map share: quadrature across the width, and the
/// rim's plane.
/// @param measured  (n) share of the weights that pixels carry, 0 at a station that does not count
/// @param mean_z    (n) m, sum of the pixels' weights times z
void add_shared_modes(Profile& profile, const RimPlane& plane, const Array1& measured,
                      const Array1& mean_z, double pitch_over_width, const std::string& name);

}  // namespace manoscope::maps

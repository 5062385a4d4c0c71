#pragma once

#include <optional>
#include <vector>

#include "manoscope/calibration/levels.hpp"
#include "manoscope/core/profile.hpp"
#include "manoscope/core/units.hpp"

namespace manoscope::inversion {

/// One point where the profile under flow crosses the static profile of a level.
struct Intersection {
  Length x{};
  Length x_uncertainty{};  ///< standard, from all errors of both profiles; the label's is apart
  Pressure pressure{};     ///< of the level
  Pressure pressure_uncertainty{};
};

struct IntersectionOptions {
  std::optional<Length> window;  ///< auto: a tenth of the width

  template <class Visitor>
  void describe(Visitor&& visit) {
    visit("crossing-window", window, "length along x over which a crossing is fitted by a line");
  }
  /// @throws InputError naming the first option out of range.
  void validate() const;
};

/// The paper's own reading: p at the crossings of the flow profile with each static profile.
///
/// Source: Ozsun et al. 2013, fig. 3(a-c): "we determine the positions where the dynamic profiles
/// intersect with the static profiles and read out the pressure values for each intersection
/// position". The difference of two noisy profiles changes sign many times about one crossing: each
/// cluster of changes closer than `window` is one crossing, at the zero of the line fitted to the
/// difference over the window, and counts only where that line stands clear of zero slope by 3
/// standard errors.
///
/// @param levels  ascending, on the stations of `state`.
/// @return by level, then by x.
/// @throws InputError if an option is out of range.
std::vector<Intersection> find_intersections(const std::vector<calibration::Level>& levels,
                                             const Profile& state, Length channel_width,
                                             const IntersectionOptions& options = {});

}  // namespace manoscope::inversion

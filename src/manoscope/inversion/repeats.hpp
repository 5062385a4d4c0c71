#pragma once

#include <optional>
#include <vector>

#include "manoscope/core/profile.hpp"
#include "manoscope/core/units.hpp"
#include "manoscope/inversion/test_section.hpp"

namespace manoscope::inversion {

/// One of several maps of the same state.
struct RepeatedMap {
  const Profile* profile;
  Pressure label_uncertainty{};  ///< standard, of a hydrostatic map's own reading
};

/// Whether maps of one state agree within their bars.
struct RepeatAgreement {
  double scatter = 0.0;  ///< Pa, standard deviation of the maps' mean pressures about their mean
  double chi_square = 0.0;
  double dof = 0.0;
};

/// Compares maps of one state by two numbers each: the pressure, mean over the stretch, and the
/// drop, mean over its first third minus that over its last. Deflections become pressures by the
/// compliance, errors of the curves cancel. Errors: noise, plane and position of each map, and its
/// label's; what all maps share cancels, too.
///
/// @param maps        on the same stations.
/// @param compliance  (n_x) m/Pa; stations where it is not above 0 do not count.
/// @return dof = 2 (maps - 1); none for fewer than two maps or six stations, or without any
///         uncertainty.
std::optional<RepeatAgreement> compare_repeats(const std::vector<RepeatedMap>& maps,
                                               const Array1& compliance, const Stretch& stretch);

}  // namespace manoscope::inversion

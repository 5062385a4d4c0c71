#pragma once

#include <vector>

#include "manoscope/calibration/constitutive_curves.hpp"
#include "manoscope/core/profile.hpp"
#include "manoscope/inversion/read_pressure.hpp"
#include "manoscope/inversion/test_section.hpp"

// What costs the square of the stations, or a flow model at each, is done at some of them.

namespace manoscope::inversion {

/// Every few stations of a stretch, about `n`, the first and the last among them.
std::vector<Index> some_stations(const Array1& x, const Stretch& stretch, Index n);

/// The same at some of the stations, with the errors there.
Profile thinned(const Profile& profile, const std::vector<Index>& stations);
PressureReading thinned(const PressureReading& reading, const std::vector<Index>& stations);
calibration::ConstitutiveCurves thinned(const calibration::ConstitutiveCurves& curves,
                                        const std::vector<Index>& stations);

}  // namespace manoscope::inversion

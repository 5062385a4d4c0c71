#pragma once

#include <vector>

#include "manoscope/core/profile.hpp"
#include "manoscope/inversion/test_section.hpp"

namespace manoscope::inversion {

/// Every few stations of a stretch, about `n`, the first and the last among them.
std::vector<Index> some_stations(const Array1& x, const Stretch& stretch, Index n);

/// The profile at some of its stations.
Profile thinned(const Profile& profile, const std::vector<Index>& stations);

}  // namespace manoscope::inversion

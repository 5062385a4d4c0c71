#include "manoscope/core/profile.hpp"

#include <algorithm>

#include "manoscope/core/error.hpp"
#include "manoscope/core/flags.hpp"

namespace manoscope {

Profile mean_profile(const std::vector<Profile>& profiles) {
  MANO_ASSERT(!profiles.empty());
  if (profiles.size() == 1) return profiles.front();
  const Index n = profiles.front().x.size();
  Profile mean;
  mean.x = profiles.front().x;
  mean.zeta = Array1::Zero(n);
  mean.flags = Flags1::Zero(n);
  Array1 count = Array1::Zero(n), variance = Array1::Zero(n);
  for (const Profile& profile : profiles) {
    MANO_ASSERT(profile.x.size() == n);
    for (Index i = 0; i < n; ++i) {
      if (profile.flags[i] != 0) continue;
      count[i] += 1.0;
      mean.zeta[i] += profile.zeta[i];
      variance[i] += profile.uncertainty.independent[i] * profile.uncertainty.independent[i];
    }
  }
  for (Index i = 0; i < n; ++i) {
    if (count[i] == 0.0) mean.flags[i] = StationFlag::no_data;
  }
  const Array1 weight = (count > 0.0).select(1.0 / count.max(1.0), 0.0);
  mean.zeta *= weight;
  mean.uncertainty.independent = variance.sqrt() * weight;
  for (const Profile& profile : profiles) {
    for (const ErrorMode& mode : profile.uncertainty.modes) {
      Array1 effect = mode.effect * weight;
      for (Index i = 0; i < n; ++i) {
        if (profile.flags[i] != 0) effect[i] = 0.0;
      }
      // An error that several repeats share stays one error: its effects add up.
      auto& modes = mean.uncertainty.modes;
      const auto same = std::find_if(modes.begin(), modes.end(), [&](const ErrorMode& other) {
        return other.variable == mode.variable;
      });
      if (same != modes.end()) {
        same->effect += effect;
      } else {
        modes.push_back({mode.variable, mode.source, std::move(effect)});
      }
    }
  }
  return mean;
}

}  // namespace manoscope

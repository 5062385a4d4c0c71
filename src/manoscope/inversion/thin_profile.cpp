#include "manoscope/inversion/thin_profile.hpp"

#include <type_traits>

namespace manoscope::inversion {

std::vector<Index> some_stations(const Array1& x, const Stretch& stretch, Index n) {
  std::vector<Index> inside;
  for (Index ix = 0; ix < x.size(); ++ix) {
    if (x[ix] >= stretch.start.si() && x[ix] <= stretch.end.si()) inside.push_back(ix);
  }
  const auto n_inside = static_cast<Index>(inside.size());
  if (n_inside <= n) return inside;
  std::vector<Index> some;
  for (Index i = 0; i < n; ++i) {
    some.push_back(inside[static_cast<std::size_t>(i * (n_inside - 1) / (n - 1))]);
  }
  return some;
}

Profile thinned(const Profile& profile, const std::vector<Index>& stations) {
  const auto n = static_cast<Index>(stations.size());
  const auto pick = [&](const auto& values) {
    using Values = std::decay_t<decltype(values)>;
    Values picked(n);
    for (Index i = 0; i < n; ++i) picked[i] = values[stations[static_cast<std::size_t>(i)]];
    return picked;
  };
  Profile result;
  result.x = pick(profile.x);
  result.zeta = pick(profile.zeta);
  result.flags = pick(profile.flags);
  result.uncertainty.independent = pick(profile.uncertainty.independent);
  for (const ErrorMode& mode : profile.uncertainty.modes) {
    result.uncertainty.modes.push_back({mode.variable, mode.source, pick(mode.effect)});
  }
  return result;
}

}  // namespace manoscope::inversion

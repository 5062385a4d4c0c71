#include "manoscope/inversion/thinned.hpp"

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

namespace {

template <class Values>
Values picked(const Values& values, const std::vector<Index>& stations) {
  Values some(static_cast<Index>(stations.size()));
  for (Index i = 0; i < some.size(); ++i) some[i] = values[stations[static_cast<std::size_t>(i)]];
  return some;
}

Uncertainty picked(const Uncertainty& uncertainty, const std::vector<Index>& stations) {
  Uncertainty some;
  some.independent = picked(uncertainty.independent, stations);
  for (const ErrorMode& mode : uncertainty.modes) {
    some.modes.push_back({mode.variable, mode.source, picked(mode.effect, stations)});
  }
  return some;
}

}  // namespace

Profile thinned(const Profile& profile, const std::vector<Index>& stations) {
  return {picked(profile.x, stations), picked(profile.zeta, stations),
          picked(profile.uncertainty, stations), picked(profile.flags, stations)};
}

PressureReading thinned(const PressureReading& reading, const std::vector<Index>& stations) {
  return {picked(reading.x, stations),           picked(reading.pressure, stations),
          picked(reading.uncertainty, stations), picked(reading.lower, stations),
          picked(reading.upper, stations),       picked(reading.slope, stations),
          picked(reading.flags, stations)};
}

calibration::ConstitutiveCurves thinned(const calibration::ConstitutiveCurves& curves,
                                        const std::vector<Index>& stations) {
  calibration::ConstitutiveCurves some = curves;
  some.x = picked(curves.x, stations);
  for (calibration::Level& level : some.levels) level.profile = thinned(level.profile, stations);
  some.curves.clear();
  for (const Index ix : stations) {
    some.curves.push_back(curves.curves[static_cast<std::size_t>(ix)]);
  }
  return some;
}

}  // namespace manoscope::inversion

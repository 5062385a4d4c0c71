#include "manoscope/validation/error_split.hpp"

#include <algorithm>
#include <cmath>

#include "manoscope/core/error.hpp"

namespace manoscope::validation {
namespace {

/// The pressure of a deflection on a fitted curve, if it has one and only one.
std::optional<double> read(const calibration::ConstitutiveCurves& curves, Index ix, double zeta) {
  const auto& curve = curves.curves[static_cast<std::size_t>(ix)];
  if (!curve) return std::nullopt;
  const std::vector<double> solutions = curve->pressures(zeta);
  if (solutions.size() != 1) return std::nullopt;
  return solutions.front();
}

PartSummary summarise_part(const Array1& part, const Flags1& counts) {
  PartSummary summary;
  double squares = 0.0, n = 0.0;
  for (Index i = 0; i < part.size(); ++i) {
    if (counts[i] == 0) continue;
    n += 1.0;
    summary.mean += part[i];
    squares += part[i] * part[i];
    summary.largest = std::max(summary.largest, std::abs(part[i]));
  }
  if (n == 0.0) return summary;
  summary.mean /= n;
  summary.rms = std::sqrt(squares / n);
  return summary;
}

}  // namespace

ErrorSplit split_error(const SplitInput& run, const SplitCurves& curves) {
  const Index n = run.answered.size();
  for (const auto* fitted : {&curves.measured, &curves.relabelled, &curves.true_curves}) {
    MANO_ASSERT(static_cast<Index>(fitted->curves.size()) == n);
  }
  MANO_ASSERT(curves.exact.empty() || static_cast<Index>(curves.exact.size()) == n);
  MANO_ASSERT(run.pressure.size() == n && run.deflection.size() == n);
  MANO_ASSERT(run.local_pressure.size() == n);
  MANO_ASSERT(run.true_pressure.size() == n && run.true_deflection.size() == n);
  const bool is_exact = !curves.exact.empty();
  ErrorSplit result;
  result.split = Flags1::Zero(n);
  result.neighbourhood = result.labels = result.maps = Array1::Zero(n);
  result.curve_shape_and_locality = Array1::Zero(n);
  if (is_exact) result.curve_shape = result.locality = Array1::Zero(n);
  for (Index ix = 0; ix < n; ++ix) {
    if (run.answered[ix] == 0) continue;
    const auto again = read(curves.measured, ix, run.deflection[ix]);
    const auto relabelled = read(curves.relabelled, ix, run.deflection[ix]);
    const auto ideal = read(curves.true_curves, ix, run.true_deflection[ix]);
    if (!again || !relabelled || !ideal) continue;
    if (std::abs(*again - run.local_pressure[ix]) > kSameReading) continue;
    if (is_exact) {
      const auto still =
          curves.exact[static_cast<std::size_t>(ix)].pressure(run.true_deflection[ix]);
      if (!still) continue;
      result.curve_shape[ix] = *ideal - *still;
      result.locality[ix] = *still - run.true_pressure[ix];
    }
    result.split[ix] = 1;
    result.neighbourhood[ix] = run.pressure[ix] - run.local_pressure[ix];
    result.labels[ix] = run.local_pressure[ix] - *relabelled;
    result.maps[ix] = *relabelled - *ideal;
    result.curve_shape_and_locality[ix] = *ideal - run.true_pressure[ix];
  }
  return result;
}

SplitSummary summarise(const ErrorSplit& split, const Flags1& inside, const Flags1& answered) {
  const Index n = split.split.size();
  MANO_ASSERT(inside.size() == n && answered.size() == n);
  Flags1 counts = Flags1::Zero(n);
  SplitSummary summary;
  for (Index i = 0; i < n; ++i) {
    if (inside[i] == 0 || answered[i] == 0) continue;
    counts[i] = split.split[i];
    ++(split.split[i] != 0 ? summary.n_split : summary.n_left_out);
  }
  summary.neighbourhood = summarise_part(split.neighbourhood, counts);
  summary.labels = summarise_part(split.labels, counts);
  summary.maps = summarise_part(split.maps, counts);
  summary.curve_shape_and_locality = summarise_part(split.curve_shape_and_locality, counts);
  summary.total = summarise_part(
      split.neighbourhood + split.labels + split.maps + split.curve_shape_and_locality, counts);
  if (split.locality.size() > 0) {
    summary.curve_shape = summarise_part(split.curve_shape, counts);
    summary.locality = summarise_part(split.locality, counts);
  }
  return summary;
}

}  // namespace manoscope::validation

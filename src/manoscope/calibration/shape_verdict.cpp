#include "manoscope/calibration/shape_verdict.hpp"

#include <algorithm>
#include <cmath>

#include "manoscope/numerics/chi_square.hpp"

namespace manoscope::calibration {

ShapeVerdict shape_verdict(const ShapeMisfit& misfit, const Array1& x, double start, double end) {
  constexpr double kBeside = 1e-3;  // chance of a stretch that belongs to the worst one
  const Index n = x.size();
  const double half = n > 1 ? 0.5 * (x[n - 1] - x[0]) / static_cast<double>(n - 1) : 0.0;
  Array1 chance = Array1::Ones(n);
  ShapeVerdict verdict;
  double n_compared = 0.0;
  Index worst = -1;
  for (Index j = 0; j < n; ++j) {
    if (x[j] < start || x[j] > end || std::isnan(misfit.chi_square[j])) continue;
    chance[j] = numerics::chi_square_tail(misfit.chi_square[j], misfit.dof[j]);
    verdict.chi_square += misfit.chi_square[j];
    verdict.dof += misfit.dof[j];
    n_compared += 1.0;
    const auto beyond = [&](Index at) { return misfit.chi_square[at] / misfit.dof[at]; };
    // Far out every chance is 0: then the larger share counts.
    const bool worse = worst < 0 || chance[j] < chance[worst] ||
                       (chance[j] == chance[worst] && beyond(j) > beyond(worst));
    if (worse) worst = j;
  }
  if (worst < 0) return verdict;
  const double of_sum = numerics::chi_square_tail(verdict.chi_square, verdict.dof);
  const double of_worst = numerics::smallest_of(chance[worst], n_compared);
  verdict.p_value = std::min(1.0, 2.0 * std::min(of_sum, of_worst));
  Index first = worst, last = worst;
  while (first > 0 && chance[first - 1] < kBeside) --first;
  while (last + 1 < n && chance[last + 1] < kBeside) ++last;
  verdict.worst_start = x[first] - half;
  verdict.worst_end = x[last] + half;
  for (Index j = first; j <= last; ++j) {
    if (std::isfinite(misfit.reading_shift[j])) {
      verdict.reading_shift = std::max(verdict.reading_shift, misfit.reading_shift[j]);
    }
  }
  return verdict;
}

}  // namespace manoscope::calibration

#include "manoscope/wall/choose_law.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <cstddef>
#include <utility>

#include "manoscope/core/error.hpp"

namespace manoscope::wall {

LawChoice choose_law(const std::vector<LawKind>& candidates, const WallSection& start,
                     const HydrostaticData& data, const FitLawOptions& options) {
  constexpr const char* kWhere = "choice of a wall law";
  if (candidates.empty()) {
    throw InputError(kWhere, "there are no candidates", "Name at least one law");
  }
  data.validate();
  LawChoice choice;
  for (const LawKind kind : candidates) {
    try {
      LawFit fit = fit_law(kind, start, data, options);
      if (std::isfinite(fit.aicc)) {
        choice.fits.push_back(std::move(fit));
      } else {
        choice.refused.push_back({kind, "too few pressures for AICc"});
      }
    } catch (const InputError& error) {
      choice.refused.push_back({kind, error.what()});
    }
  }
  if (choice.fits.empty()) {
    throw InputError(kWhere,
                     fmt::format("none of {} laws could be fitted; {}: {}", candidates.size(),
                                 name(choice.refused.front().kind), choice.refused.front().reason),
                     "Measure at more pressures, fix parameters, or choose other laws");
  }
  std::stable_sort(choice.fits.begin(), choice.fits.end(),
                   [](const LawFit& a, const LawFit& b) { return a.aicc < b.aicc; });
  choice.weights.resize(static_cast<Index>(choice.fits.size()));
  for (Index i = 0; i < choice.weights.size(); ++i) {
    const double behind = choice.fits[static_cast<std::size_t>(i)].aicc - choice.best().aicc;
    choice.weights(i) = behind < 1000.0 ? std::exp(-0.5 * behind) : 0.0;
  }
  choice.weights /= choice.weights.sum();
  choice.adequate = choice.best().probability > 1e-3;
  return choice;
}

}  // namespace manoscope::wall

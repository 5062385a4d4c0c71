#pragma once

#include <string>
#include <vector>

#include "manoscope/wall/fit_law.hpp"

namespace manoscope::wall {

/// Several wall laws fitted to the same data, best first.
struct LawChoice {
  struct Refusal {
    LawKind kind;
    std::string reason;  ///< why the law could not be fitted
  };
  std::vector<LawFit> fits;  ///< by ascending AICc
  Array1 weights;            ///< (fits) Akaike weights, sum 1
  std::vector<Refusal> refused;
  /// The best law leaves residuals that its sigmas explain: probability of its chi2 above 1e-3.
  /// False: none of these laws holds (or the sigmas are too small); do not trust its parameters.
  bool adequate = false;

  const LawFit& best() const { return fits.front(); }
};

/// Chooses among wall laws by their residuals.
///
/// Ranked by AICc = chi2 + 2 k + 2 k (k + 1)/(n - k - 1): the sigmas are given, so chi2 is -2 ln
/// likelihood but for a constant that all laws share, and AIC adds its price per parameter: chi2 is
/// n - k on average for the fitted data and n + k for new ones, so that 2 k is what a fit gains
/// by its parameters. The third term belongs to sigmas that are estimated from the same data; here
/// it is caution, against laws of many parameters where there are few pressures (n of 10 to 30). An
/// information criterion rather than a chi2 test because the laws are not nested. Weights are
/// exp(-(AICc - least)/2), normalised: laws within 2 of the best are not told apart. Laws that tie
/// exactly keep the order of `candidates`. Source: Burnham & Anderson, Model Selection and
/// Multimodel Inference, 2nd ed., sec. 2.4 and 2.9.
///
/// @throws InputError if no candidate is given or none can be fitted (n >= k + 2 is needed).
LawChoice choose_law(const std::vector<LawKind>& candidates, const WallSection& start,
                     const HydrostaticData& data, const FitLawOptions& options = {});

}  // namespace manoscope::wall

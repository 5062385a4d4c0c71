#pragma once

#include <optional>
#include <string>

#include "manoscope/results/measurement.hpp"

namespace manoscope::report {

/// What to improve first: the source of uncertainty that the bars hang on most.
struct Advice {
  std::string source;
  double share = 0.0;   ///< of the variance, in the median
  double shrink = 0.0;  ///< by how much the bars would shrink were the source's own halved
  std::string hint;     ///< what to do about it
};

/// Of p(x): by the shares of every source at the stations of all test sections; the median of each
/// over all of them, runs counting alike.
///
///   shrink = 1 - sqrt(1 - 3/4 share)
///
/// @return none where no station has a variance.
std::optional<Advice> advice_on_pressure(const results::Measurement& measurement);
/// Of the extracted drops: the median over the runs.
std::optional<Advice> advice_on_drop(const results::Measurement& measurement);

/// "Improve first: pressure labels, 71 % of the variance of p(x); halved, its bars shrink by 32 %:
/// a better gauge, repeats or more levels." One or two sentences, "" where there is nothing to say.
std::string advice_text(const results::Measurement& measurement);

/// What to do about a source of uncertainty, as a clause.
std::string hint_for(const std::string& source);

}  // namespace manoscope::report

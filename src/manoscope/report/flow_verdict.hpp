#pragma once

#include <string_view>

#include "manoscope/results/measurement.hpp"

namespace manoscope::report {

/// What the comparison of a flow model with the reading of one run amounts to.
enum class FlowVerdict {
  agrees,     ///< the drop, and p(x) along x
  only_drop,  ///< the drop alone: errors of the model that cancel look like this
  differs,    ///< not even the drop
  none,       ///< nothing can be said
};

/// A p(x) that chance puts as far off as this less often than once in so many is no chance.
inline constexpr double kLeastChance = 0.01;
/// A flow model whose stated error is a larger share of the drop is not valid there.
inline constexpr double kMostStatedError = 0.02;

/// The one rule of all tables and figures:
///
///   none       E_n is NaN
///   differs    E_n > 1
///   agrees     E_n <= 1 and the p value of p(x) along x is at least kLeastChance
///   only_drop  else
FlowVerdict flow_verdict(double en_number, double p_value);
/// Of model `model` (row of flow_model) and a run; `none` for a row that is not there (-1).
FlowVerdict flow_verdict(const results::Measurement& measurement, Index model, Index run);

/// Whether the section march has no drop for a run that the other models have one for.
bool march_broke_down(const results::Measurement& measurement, Index run);

/// "agrees", "only the drop", "differs", "no verdict".
const char* verdict_word(FlowVerdict verdict);

/// Row of a name in flow_model; -1 if it is not there.
Index flow_model_row(const results::Measurement& measurement, std::string_view name);

/// A flow model as figures call and draw it: words and colour are ours, whatever the file holds.
struct ModelStyle {
  const char* words;
  const char* colour;
};
/// Style of a name in flow_model; "another model" in grey for a name that we do not know.
ModelStyle model_style(std::string_view name);

}  // namespace manoscope::report

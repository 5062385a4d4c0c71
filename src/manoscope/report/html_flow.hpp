#pragma once

#include <string>

#include "manoscope/results/measurement.hpp"

namespace manoscope::report {

// What the flow says of the reading, as HTML fragments; "" where there is nothing to show.

/// In how many runs the verdict's model agrees, in one sentence.
std::string verdict_sentence(const results::Measurement& measurement);

/// The part of the page on flow models: what they take for granted, which of them agrees, the
/// verdicts in words, what each effect adds to the drop, the flow rate from the deflection alone,
/// the drop between the ends of the channel.
std::string flow_part(const results::Measurement& measurement);

}  // namespace manoscope::report

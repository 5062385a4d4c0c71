#pragma once

#include <string>

#include "manoscope/results/measurement.hpp"

namespace manoscope::report {

// Tables of the part on flow models, each an HTML fragment; "" where there is nothing to show.

/// Flow rate and viscosity from the deflection alone, one row a run.
std::string inferred_table(const results::Measurement& measurement);
/// Drop between the ends of the channel, one row a run: transducer, what the passages cost by part,
/// the rest, and the drop predicted.
std::string channel_drops_table(const results::Measurement& measurement);

}  // namespace manoscope::report

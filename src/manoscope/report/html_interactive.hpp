#pragma once

#include <string>

#include "manoscope/results/measurement.hpp"

namespace manoscope::report {

/// What report.html needs in its head to run the script that it holds and nothing else: the policy
/// that forbids every request and every other script, and the script's style.
std::string interactive_head();

/// Where the interactive views appear, in their place a sentence for readers without scripts, and
/// the numbers and the script, which need not wait for the rest of the page.
std::string interactive_place(const results::Measurement& measurement);

/// The maps, for the end of the body.
std::string interactive_tail(const results::Measurement& measurement);

}  // namespace manoscope::report

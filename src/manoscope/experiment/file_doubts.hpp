#pragma once

#include <string>
#include <vector>

#include "manoscope/experiment/experiment.hpp"

namespace manoscope::experiment {

/// What the file says, or leaves out, of the uncertainty of the pressure labels, where that makes
/// the error bars too small. In words; empty if every label that is not vented has an uncertainty
/// above 0.
std::vector<std::string> label_doubts(const Experiment& experiment);

/// What the uncertainty of QR lacks, if there are maps under flow: that of the gap. In words.
std::vector<std::string> flow_doubts(const Experiment& experiment);

/// Every doubt that the file alone raises, before any map is read: label_doubts() and
/// flow_doubts(). No faults: the experiment can be measured as it stands.
std::vector<std::string> file_doubts(const Experiment& experiment);

}  // namespace manoscope::experiment

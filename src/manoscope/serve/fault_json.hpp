#pragma once

#include <nlohmann/json_fwd.hpp>

#include "manoscope/core/error.hpp"
#include "manoscope/experiment/form.hpp"
#include "manoscope/serve/experiment_files.hpp"

namespace manoscope::serve {

/// A fault of an experiment with the place in the form that it belongs to, as far as it has one:
/// {"file", "line", "key", "row", "column", "found", "mend", "text"}.
/// @param form  of the draft; nullptr if its text is no TOML.
nlohmann::json fault_json(const Folder& folder, const ExperimentDraft& draft,
                          const experiment::Form* form, const InputError& fault);

}  // namespace manoscope::serve

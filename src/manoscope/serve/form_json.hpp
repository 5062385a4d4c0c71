#pragma once

#include <nlohmann/json_fwd.hpp>
#include <string>

#include "manoscope/experiment/form.hpp"

namespace manoscope::serve {

/// A form as the page gets it: every key of every section, null where it is absent.
nlohmann::json form_json(const experiment::Form& form, const std::string& toml);

/// The form in a request; keys that it leaves out count as absent.
/// @throws ApiError 400 if it is no form, or names a key that no form has.
experiment::Form form_from(const nlohmann::json& object);

}  // namespace manoscope::serve

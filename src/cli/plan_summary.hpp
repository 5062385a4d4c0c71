#pragma once

#include <filesystem>
#include <string>

#include "manoscope/design/plan.hpp"

namespace manoscope::cli {

/// A plan as a terminal shows it; the short one has levels, uncertainties and verdicts alone.
std::string plan_text(const design::Plan& plan, bool in_short);
/// The same as JSON, SI units; `written` is the scenario file, empty if there is none.
std::string plan_json(const design::Plan& plan, const std::filesystem::path& written);
/// What stands in front of the scenario file of a plan.
std::string plan_comment(const design::Plan& plan);

}  // namespace manoscope::cli

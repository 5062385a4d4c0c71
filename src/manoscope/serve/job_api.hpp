#pragma once

#include "manoscope/serve/folder.hpp"
#include "manoscope/serve/jobs.hpp"
#include "manoscope/serve/message.hpp"

namespace manoscope::serve {

/// The order in a request: the command that a user would type, as the words of a process.
/// @param program  path of this program.
/// @throws ApiError, InputError for an option that is unknown or out of range.
JobOrder order_from(const Folder& folder, const std::string& program, const std::string& body);

/// The options of a measurement and of its report, with their defaults.
Reply options_reply();

}  // namespace manoscope::serve

#pragma once

#include <string>

#include "manoscope/serve/folder.hpp"
#include "manoscope/serve/message.hpp"

namespace manoscope::serve {

/// Where the channel lies in the maps of a draft, whatever else is at fault in it.
/// @throws ApiError; InputError if sizes or levels are missing, or nothing answers to pressure.
Reply place_reply(const Folder& folder, const std::string& body);

}  // namespace manoscope::serve

#pragma once

#include "manoscope/serve/folder.hpp"
#include "manoscope/serve/message.hpp"

namespace manoscope::serve {

/// What a map file holds, with a picture of it or of its difference to another.
/// @throws ApiError, InputError.
Reply map_reply(const Folder& folder, const Address& address);

}  // namespace manoscope::serve

#pragma once

#include "manoscope/serve/folder.hpp"
#include "manoscope/serve/message.hpp"

namespace manoscope::serve {

/// A file of a result, as it stands on the disk; a page in an origin of its own.
/// @throws ApiError 404.
Reply result_file_reply(const Folder& folder, const Address& address);

/// What `manoscope measure --json` prints, off result.nc, and p(x) of every run.
/// @throws ApiError 404; InputError if the file is no result.
Reply result_reply(const Folder& folder, const Address& address);

}  // namespace manoscope::serve

#pragma once

#include <filesystem>

namespace manoscope::io {

/// A map as a user names it: a file, or `FILE#n` for the n-th page, frame or channel of one that
/// holds several.
struct MapAddress {
  std::filesystem::path file;
  int page = 0;  ///< from 1; 0 = the name gives none
};

/// Takes `#n` off a name. A file that is there under the whole name keeps it.
MapAddress map_address(const std::filesystem::path& name);

}  // namespace manoscope::io

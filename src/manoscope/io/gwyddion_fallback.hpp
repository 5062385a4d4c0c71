#pragma once

#include <optional>
#include <string>

#include "manoscope/io/reader.hpp"

namespace manoscope::io {

/// The program Gwyddion, for files that no reader here knows: the one that the environment variable
/// MANOSCOPE_GWYDDION names, else `gwyddion` on PATH; nullopt where there is none, or where the
/// variable says "off".
std::optional<std::string> find_gwyddion();

/// What to do about a file that no reader knows, if Gwyddion cannot help: "... is not installed".
std::string gwyddion_absence(const ReadOptions& options);

/// Has Gwyddion convert a file to its own format, in a process with a limit of time, and reads
/// that. Every channel says that Gwyddion read it. Not in the table of readers: it knows no file by
/// its bytes.
const Reader& gwyddion_fallback();

}  // namespace manoscope::io

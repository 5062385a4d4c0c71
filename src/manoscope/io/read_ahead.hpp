#pragma once

#include <filesystem>

namespace manoscope::io {

/// Asks the system to fetch a file from the disk while the caller computes; does not wait.
///
/// A hint: what cannot be opened is passed over, whoever reads it then says why.
void read_ahead(const std::filesystem::path& path);

}  // namespace manoscope::io

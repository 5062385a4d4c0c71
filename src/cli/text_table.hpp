#pragma once

#include <string>
#include <vector>

namespace manoscope::cli {

/// Rows of cells, at least one, as a table aligned to the right.
std::string text_table(const std::vector<std::vector<std::string>>& rows);

}  // namespace manoscope::cli

#pragma once

#include <string>
#include <vector>

namespace manoscope::cli {

/// Rows of cells, at least one, as a table aligned to the right.
std::string text_table(const std::vector<std::vector<std::string>>& rows);

/// "12287 ± 21": a value with its expanded uncertainty (k = 2) to two digits; without one, to the
/// unit; a dash where there is no value.
std::string value_text(double value, double standard_uncertainty);

}  // namespace manoscope::cli

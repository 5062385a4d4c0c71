#pragma once

// Tables of the shared practice data: comma-separated numbers below comments and one line of names.

#include <filesystem>
#include <fstream>
#include <sstream>
#include <string>
#include <vector>

#include "tests/support/paths.hpp"

namespace manoscope {

/// Path of a shared reference file; it may be absent, then a test skips.
inline std::filesystem::path shared_file(const std::string& name) {
  return std::filesystem::path(test_paths::shared) / name;
}

/// Rows of numbers; comments (#) and the line of names are left out.
inline std::vector<std::vector<double>> read_table(const std::filesystem::path& path) {
  std::ifstream file(path);
  std::vector<std::vector<double>> rows;
  for (std::string line; std::getline(file, line);) {
    const bool number =
        !line.empty() && std::string("0123456789-+.").find(line[0]) != std::string::npos;
    if (!number) continue;
    std::istringstream cells(line);
    rows.emplace_back();
    for (std::string cell; std::getline(cells, cell, ',');) rows.back().push_back(std::stod(cell));
  }
  return rows;
}

}  // namespace manoscope

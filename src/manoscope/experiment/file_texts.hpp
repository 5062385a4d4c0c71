#pragma once

#include <filesystem>
#include <map>
#include <string>

namespace manoscope::experiment {

/// Texts that stand in for files, by path in normal form: a draft is checked before it is written.
using FileTexts = std::map<std::filesystem::path, std::string>;

}  // namespace manoscope::experiment

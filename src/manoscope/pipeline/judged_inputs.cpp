#include "manoscope/pipeline/judged_inputs.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <set>
#include <sstream>
#include <string>
#include <utility>
#include <vector>

#include "manoscope/core/error.hpp"

namespace manoscope::pipeline {
namespace {

struct InputMap {
  std::string name, hash;
};

/// Lines "name  sha256"; the name may hold blanks.
std::vector<InputMap> maps_of(const std::string& inputs) {
  std::vector<InputMap> maps;
  std::istringstream lines(inputs);
  for (std::string line; std::getline(lines, line);) {
    const auto gap = line.rfind("  ");
    if (gap != std::string::npos) maps.push_back({line.substr(0, gap), line.substr(gap + 2)});
  }
  return maps;
}

}  // namespace

void check_same_inputs(const results::Measurement& measurement, const twin::Truth& truth) {
  const std::vector<InputMap> known = maps_of(truth.inputs), measured = maps_of(measurement.inputs);
  if (known.empty() || measured.empty()) return;
  std::set<std::string> hashes;
  for (const InputMap& map : known) hashes.insert(map.hash);
  std::vector<std::string> others;
  for (const InputMap& map : measured) {
    if (hashes.count(map.hash) == 0) others.push_back(map.name);
  }
  if (others.empty()) return;
  throw InputError(
      "truth",
      fmt::format("it belongs to other maps: {} of the {} maps of the result \"{}\" are not those "
                  "of \"{}\", {} first",
                  others.size(), measured.size(), measurement.title, truth.name, others.front()),
      "Give the truth of the same experiment and seed, or --other-maps if the maps were changed on "
      "purpose");
}

}  // namespace manoscope::pipeline

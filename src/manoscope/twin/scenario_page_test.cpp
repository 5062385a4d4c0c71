// What docs/virtual-experiments.md says of the keys of a scenario.
#include <gtest/gtest.h>

#include <map>
#include <sstream>
#include <string>
#include <vector>

#include "manoscope/core/options.hpp"
#include "manoscope/core/provenance.hpp"
#include "manoscope/twin/scenario.hpp"
#include "tests/support/paths.hpp"

namespace manoscope::twin {
namespace {

/// Texts between a pair of backquotes.
std::vector<std::string> code_words(const std::string& cell) {
  std::vector<std::string> texts;
  for (std::size_t at = cell.find('`'); at != std::string::npos; at = cell.find('`', at + 1)) {
    const std::size_t end = cell.find('`', at + 1);
    if (end == std::string::npos) break;
    texts.push_back(cell.substr(at + 1, end - at - 1));
    at = end;
  }
  return texts;
}

/// Defaults by key, of the tables behind a place of the page up to the next section of keys.
std::map<std::string, std::string> defaults_after(const std::string& start) {
  const std::string page =
      read_file(std::string(test_paths::source) + "/docs/virtual-experiments.md");
  const std::size_t from = page.find(start);
  EXPECT_NE(from, std::string::npos) << start;
  std::map<std::string, std::string> defaults;
  std::istringstream lines(page.substr(from + start.size()));
  for (std::string line; std::getline(lines, line);) {
    if (line.find("**`[") != std::string::npos || line.rfind("## ", 0) == 0) break;
    if (line.rfind("| `", 0) != 0) continue;
    std::vector<std::string> cells;
    std::istringstream row(line);
    for (std::string cell; std::getline(row, cell, '|');) cells.push_back(cell);
    const std::vector<std::string> keys = code_words(cells.at(1)), values = code_words(cells.at(3));
    for (std::size_t i = 0; i < keys.size(); ++i) {
      if (!values.empty()) defaults[keys[i]] = values.at(values.size() == 1 ? 0 : i);
    }
  }
  return defaults;
}

/// Every option stands on the page with its default.
template <class Options>
void expect_told(const std::string& start) {
  const auto told = defaults_after(start);
  const std::vector<OptionInfo> options = list_options(Options{});
  for (const OptionInfo& option : options) {
    const auto found = told.find(option.name);
    if (found == told.end()) {
      ADD_FAILURE() << option.name << " is not told after " << start;
      continue;
    }
    Options changed;
    std::string value = found->second;
    if (value.front() == '"') value = value.substr(1, value.size() - 2);  // a text of TOML
    set_option(changed, option.name, value, "the page");
    const std::vector<OptionInfo> now = list_options(changed);
    for (std::size_t i = 0; i < now.size(); ++i) {
      EXPECT_EQ(now[i].value, options[i].value) << option.name << " = " << found->second;
    }
  }
}

TEST(ScenarioPage, TellsEveryOptionWithItsDefault) {
  expect_told<InterferometerOptions>("## Errors of the camera");
  expect_told<GaugeOptions>("**`[gauge]`**");
  expect_told<PumpOptions>("**`[pump]`**");
  expect_told<CoupledOptions>("**`[solver]`**");
  expect_told<WallGrid>("**`[wall]`**");
}

}  // namespace
}  // namespace manoscope::twin

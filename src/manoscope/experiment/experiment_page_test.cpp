// What docs/experiment-file.md shows of the experiment file.
#include <gtest/gtest.h>

#include <set>
#include <string>
#include <vector>

#include "manoscope/core/provenance.hpp"
#include "manoscope/experiment/experiment.hpp"
#include "manoscope/experiment/test_folder.hpp"
#include "manoscope/io/csv_table.hpp"
#include "manoscope/io/toml_document.hpp"
#include "tests/support/paths.hpp"

namespace manoscope::experiment {
namespace {

std::string page() {
  return read_file(std::string(test_paths::source) + "/docs/experiment-file.md");
}

/// The blocks of code of a language, one after another.
std::vector<std::string> blocks(const std::string& text, const std::string& language) {
  const std::string fence = "```" + language + "\n";
  std::vector<std::string> found;
  for (auto at = text.find(fence); at != std::string::npos; at = text.find(fence, at)) {
    at += fence.size();
    found.push_back(text.substr(at, text.find("```", at) - at));
  }
  return found;
}

/// "channel.height", of tables in lists and in tables too.
void collect_keys(const io::TomlValue& value, const std::string& path,
                  std::set<std::string>& keys) {
  for (std::size_t i = 0; i < value.items.size(); ++i) {
    const bool named = value.kind == io::TomlValue::Kind::table;
    const std::string key = named ? path + (path.empty() ? "" : ".") + value.keys[i] : path;
    if (named) keys.insert(key);
    collect_keys(value.items[i], key, keys);
  }
}

TEST(ExperimentPage, ShowsAnExperimentThatReads) {
  const TestFolder folder;
  write_full_example(folder);
  folder.write("experiment.toml", blocks(page(), "toml").at(0));
  const Experiment e = read_experiment(folder.path());
  EXPECT_EQ(e.name, "S1");
  EXPECT_FALSE(e.rigid.simulated.empty());
}

TEST(ExperimentPage, ShowsEveryKey) {
  std::set<std::string> shown, known;
  collect_keys(io::parse_toml(blocks(page(), "toml").at(0), "page"), "", shown);
  collect_keys(io::parse_toml(kFullToml, "full"), "", known);
  EXPECT_GT(known.size(), 50u);  // as many as there are, or none was collected
  for (const std::string& key : known) EXPECT_TRUE(shown.contains(key)) << key;
}

TEST(ExperimentPage, ShowsEveryColumn) {
  const std::vector<std::string> shown = blocks(page(), "csv");
  const std::string known[] = {kFullHydrostatic, kFullFlow};
  ASSERT_EQ(shown.size(), 2u);
  for (std::size_t i = 0; i < 2; ++i) {
    const auto shown_table = io::parse_csv_table(shown[i], "page");
    for (const io::CsvColumn& column : io::parse_csv_table(known[i], "full").columns) {
      EXPECT_TRUE(shown_table.column(column.name)) << column.name;
    }
  }
}

}  // namespace
}  // namespace manoscope::experiment

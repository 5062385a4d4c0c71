#include "manoscope/io/toml_document.hpp"

#include <gtest/gtest.h>

#include "manoscope/core/error.hpp"

namespace manoscope::io {
namespace {

TEST(TomlDocument, EveryValueKnowsItsLine) {
  const TomlValue root = parse_toml(
      "manoscope = 1\n\n[channel]\nlength = \"1 mm\"\norigin = [\n  \"0 mm\",\n  \"1 mm\",\n]\n"
      "[rigid]\ninlet = {length = \"5 mm\"}\n[flow]\nmaps = [\n {map = \"a\"},\n {map = \"b\"}]\n",
      "experiment.toml");
  EXPECT_EQ(root.find("manoscope")->line, 1);
  EXPECT_EQ(root.find("manoscope")->number, 1.0);
  EXPECT_EQ(root.find("channel")->line, 3);
  EXPECT_EQ(root.find("channel")->find("length")->line, 4);
  EXPECT_EQ(root.find("channel")->find("origin")->line, 5);
  EXPECT_EQ(root.find("channel")->find("origin")->items[1].line, 7);
  EXPECT_EQ(root.find("rigid")->find("inlet")->line, 10);
  EXPECT_EQ(root.find("flow")->find("maps")->items[1].line, 14);
  EXPECT_EQ(root.find("wall"), nullptr);
}

TEST(TomlDocument, KeysStayInTheOrderOfTheFile) {
  const TomlValue root = parse_toml("z = 1\na = 2\nm = 3\n", "experiment.toml");
  EXPECT_EQ(root.keys, (std::vector<std::string>{"z", "a", "m"}));
}

TEST(TomlDocument, ASyntaxErrorShowsItsLine) {
  try {
    parse_toml("manoscope = 1\n[channel]\nlength = 15.5 mm\n", "experiment.toml");
    FAIL();
  } catch (const InputError& error) {
    EXPECT_EQ(error.where(), "experiment.toml:3");
    EXPECT_NE(error.found().find("\"length = 15.5 mm\""), std::string::npos) << error.found();
    EXPECT_NE(error.mend().find("length = \"15.5 mm\""), std::string::npos) << error.mend();
  }
}

TEST(TomlDocument, RefusesDocumentsMadeToExhaustTheStack) {
  std::string key;
  for (int i = 0; i < 100000; ++i) key += "a.";
  EXPECT_THROW(parse_toml(key + "a = 1\n", "experiment.toml"), InputError);
  EXPECT_THROW(parse_toml("a = " + std::string(100000, '[') + "\n", "experiment.toml"), InputError);
  EXPECT_THROW(parse_toml(std::string(5u << 20, '#'), "experiment.toml"), InputError);
}

}  // namespace
}  // namespace manoscope::io

#include "manoscope/io/toml_edit.hpp"

#include <gtest/gtest.h>

#include "manoscope/core/error.hpp"
#include "manoscope/io/toml_document.hpp"

namespace manoscope::io {
namespace {

const std::string kText =
    "# µ before everything\n"
    "manoscope = 1\n"
    "\n"
    "[channel]   # a head\n"
    "length = \"15.5 mm\"  # µ: l, along the flow\n"
    "origin = [\n"
    "  \"0.4 mm\",  # columns\n"
    "  \"0.4 mm\"]\n"
    "# between\n"
    "\n"
    "[rigid]\n"
    "inlet = {length = \"5 mm\"}  # a tube\n"
    "[empty]\n"
    "# nothing yet";

std::string value_of(const std::string& text, const std::string& section, const std::string& key) {
  const TomlValue root = parse_toml(text, "a.toml");
  const TomlValue* table = section.empty() ? &root : root.find(section);
  const TomlValue* value = table == nullptr ? nullptr : table->find(key);
  return value == nullptr ? "absent" : value->text;
}

TEST(TomlEdit, ReplacesAValueAndNothingElse) {
  const std::string changed = with_toml_value(kText, "channel", "length", "\"16 µm\"");
  std::string wanted = kText;
  wanted.replace(wanted.find("\"15.5 mm\""), 9, "\"16 µm\"");
  EXPECT_EQ(changed, wanted);
}

TEST(TomlEdit, ReplacesAValueOfSeveralLines) {
  const std::string changed = with_toml_value(kText, "channel", "origin", "[\"1 mm\", \"2 mm\"]");
  EXPECT_NE(changed.find("origin = [\"1 mm\", \"2 mm\"]\n# between"), std::string::npos) << changed;
}

TEST(TomlEdit, PutsANewKeyBehindTheLastOfItsSection) {
  EXPECT_NE(with_toml_value(kText, "channel", "flow", "\"+rows\"")
                .find("  \"0.4 mm\"]\nflow = \"+rows\"\n# between"),
            std::string::npos);
  EXPECT_NE(with_toml_value(kText, "", "name", "\"S1\"").find("manoscope = 1\nname = \"S1\"\n\n["),
            std::string::npos);
  EXPECT_NE(with_toml_value(kText, "empty", "a", "1").find("[empty]\na = 1\n# nothing yet"),
            std::string::npos);
  EXPECT_TRUE(
      with_toml_value(kText, "fluid", "name", "\"w\"").ends_with("yet\n\n[fluid]\nname = \"w\"\n"));
  EXPECT_EQ(with_toml_value("", "", "manoscope", "1"), "manoscope = 1\n");
}

TEST(TomlEdit, KeepsTheLineEndsOfWindows) {
  EXPECT_EQ(with_toml_value("[a]\r\nb = 1\r\n", "a", "c", "2"), "[a]\r\nb = 1\r\nc = 2\r\n");
  EXPECT_EQ(with_toml_value("[a]\r\nb = 1\r\n", "c", "d", "[\n  1]"),
            "[a]\r\nb = 1\r\n\r\n[c]\r\nd = [\r\n  1]\r\n");
  EXPECT_EQ(with_toml_value("[a]\r\nb = 1\r\n\r\n", "c", "d", "2"),
            "[a]\r\nb = 1\r\n\r\n[c]\r\nd = 2\r\n");
}

TEST(TomlEdit, WritesIntoAnInlineSection) {
  EXPECT_EQ(with_toml_value("a = {b = 1} # x\n", "a", "c", "2"), "a = {b = 1, c = 2} # x\n");
  EXPECT_EQ(with_toml_value("a = {}\n", "a", "c", "2"), "a = {c = 2}\n");
}

TEST(TomlEdit, TakesKeysAndSectionsOut) {
  std::string text = without_toml_key(kText, "channel", "origin");
  EXPECT_EQ(value_of(text, "channel", "origin"), "absent");
  EXPECT_EQ(without_toml_key(kText, "channel", "no"), kText);
  EXPECT_EQ(without_toml_section(kText, "no"), kText);
}

TEST(TomlEdit, CommentsOfWhatIsTakenOutStayAsLines) {
  EXPECT_NE(
      without_toml_section(kText, "channel")
          .find("manoscope = 1\n\n# a head\n# µ: l, along the flow\n# columns\n# between\n\n["),
      std::string::npos);
  const std::string text = without_toml_key(kText, "channel", "origin");
  EXPECT_NE(text.find("along the flow\n# columns\n# between"), std::string::npos) << text;
  const std::string quoted = "[a]\nb = [\"# no\", '#\"', \"\"\"\n# no\\\"\"\"\"\"]  # yes\nc = 1\n";
  EXPECT_EQ(without_toml_key(quoted, "a", "b"), "[a]\n# b =  # yes\nc = 1\n");
}

TEST(TomlEdit, AKeyComesBackToThePlaceOfItsComment) {
  // A field that is emptied and filled again leaves the text as it was.
  const std::string without = without_toml_key(kText, "channel", "length");
  EXPECT_NE(without.find("# a head\n# length =  # µ: l, along the flow\norigin"), std::string::npos)
      << without;
  EXPECT_EQ(toml_comments(without).count("channel.length"), 0u);
  EXPECT_EQ(with_toml_value(without, "channel", "length", "\"15.5 mm\""), kText);
  const std::string indented = "a = 1 # top\r\n[s]\r\n\tb = 2# c\r\n\td = 3";
  std::string text = without_toml_key(without_toml_key(indented, "s", "b"), "", "a");
  EXPECT_EQ(text, "# a = # top\r\n[s]\r\n\t# b =# c\r\n\td = 3");
  text = with_toml_value(with_toml_value(text, "s", "b", "2"), "", "a", "1");
  EXPECT_EQ(text, indented);
}

TEST(TomlEdit, AnExampleInACommentIsNoPlaceForAKey) {
  // Only what was kept by without_toml_key() makes room; a value behind the mark is the author's.
  EXPECT_EQ(
      with_toml_value("[a]\nx = 1\n# b = 2  # example\n# b =\n[c]\n# b = # other\n", "a", "b", "3"),
      "[a]\nx = 1\nb = 3\n# b = 2  # example\n# b =\n[c]\n# b = # other\n");
}

TEST(TomlEdit, RefusesWhatItCannotTakeApart) {
  EXPECT_THROW(with_toml_value("a.b = 1\n[c]\n", "a", "d", "2"), InputError);
  EXPECT_THROW(without_toml_key("a = {b = 1, c = 2}\n", "a", "b"), InputError);
  EXPECT_THROW(without_toml_section("[a]\n[a.b]\nc = 1\n", "a"), InputError);
  EXPECT_THROW(with_toml_value("a = 1\n", "a", "b", "2"), InputError);
  EXPECT_THROW(with_toml_value("a = \n", "", "b", "2"), InputError);
}

TEST(TomlEdit, FindsTheCommentsBehindKeys) {
  const std::map<std::string, std::string> wanted{{"channel.length", "µ: l, along the flow"},
                                                  {"rigid.inlet", "a tube"}};
  EXPECT_EQ(toml_comments(kText), wanted);
}

TEST(TomlEdit, QuotesAnyText) {
  const std::string odd = "a \"b\" \\ \n\t\x7F µ";
  EXPECT_EQ(value_of("x = " + toml_quoted(odd) + "\n", "", "x"), odd);
}

}  // namespace
}  // namespace manoscope::io

#include "manoscope/experiment/form_list.hpp"

#include <gtest/gtest.h>

#include "manoscope/core/error.hpp"

namespace manoscope::experiment {
namespace {

const std::string kText =
    "# CONFIRM 100 Pa\n"
    "map,pressure [Pa],sequence\n"
    "\"a,b.gsf\", 0 ,0\n"
    "# a spare\n"
    "h01.gsf,100,1\n";

FormList wanted_of(const std::string& text) { return read_csv_form(text, "h.csv"); }

TEST(FormList, ShowsHeadsAndCellsAsTheyAreWritten) {
  const FormList list = wanted_of(kText);
  EXPECT_EQ(list.locked, "");
  EXPECT_EQ(list.columns, (std::vector<std::string>{"map", "pressure [Pa]", "sequence"}));
  ASSERT_EQ(list.rows.size(), 2u);
  EXPECT_EQ(list.rows[0], (std::vector<std::string>{"a,b.gsf", "0", "0"}));
  EXPECT_EQ(list.lines, (std::vector<int>{3, 5}));
}

TEST(FormList, ChangesTheLinesOfChangedRowsAlone) {
  FormList list = wanted_of(kText);
  EXPECT_EQ(edit_csv_list(kText, list), kText);
  list.rows[1][1] = "2,5";
  list.rows.push_back({"h02.gsf", "", "2"});
  EXPECT_EQ(edit_csv_list(kText, list),
            "# CONFIRM 100 Pa\nmap,pressure [Pa],sequence\n\"a,b.gsf\", 0 ,0\n# a spare\n"
            "h01.gsf,\"2,5\",1\nh02.gsf,,2\n");
  list.rows.resize(1);
  EXPECT_EQ(edit_csv_list(kText, list),
            "# CONFIRM 100 Pa\nmap,pressure [Pa],sequence\n\"a,b.gsf\", 0 ,0\n# a spare\n");
  list.rows.clear();
  EXPECT_EQ(edit_csv_list(kText, list),
            "# CONFIRM 100 Pa\nmap,pressure [Pa],sequence\n# a spare\n");
}

TEST(FormList, CommentsStayAtTheirRowsWhereverARowIsTakenOutOrPutIn) {
  const std::string text =
      "map,pressure [Pa]\na.gsf,0\n# of b\nb.gsf,1\n# of c: dust\nc.gsf, 2\n# of d\nd.gsf,3\n";
  FormList list = wanted_of(text);
  list.rows.erase(list.rows.begin() + 1);
  EXPECT_EQ(edit_csv_list(text, list),
            "map,pressure [Pa]\na.gsf,0\n# of b\n# of c: dust\nc.gsf, 2\n# of d\nd.gsf,3\n");
  list.rows[1][1] = "2.5";
  list.rows.insert(list.rows.begin(), {"new.gsf", "9"});
  EXPECT_EQ(edit_csv_list(text, list),
            "map,pressure [Pa]\nnew.gsf,9\na.gsf,0\n# of b\n# of c: dust\nc.gsf,2.5\n# of "
            "d\nd.gsf,3\n");
  list = wanted_of(text);
  list.rows[2][0] = "c2.gsf";  // another map of the same row
  list.rows.pop_back();
  EXPECT_EQ(edit_csv_list(text, list),
            "map,pressure [Pa]\na.gsf,0\n# of b\nb.gsf,1\n# of c: dust\nc2.gsf,2\n# of d\n");
}

TEST(FormList, RowsThatChangePlacesAndColumnsAreRead) {
  FormList list = wanted_of(kText);
  std::swap(list.rows[0], list.rows[1]);
  EXPECT_TRUE(same_table(wanted_of(edit_csv_list(kText, list)), list));
  list.columns = {"pressure [Pa]", "run"};
  list.rows = {{"1", "x"}, {"2", "y"}, {"3", "z"}};
  EXPECT_TRUE(same_table(wanted_of(edit_csv_list(kText, list)), list));
}

TEST(FormList, OfThousandsOfRowsOneIsTakenOut) {
  FormList list;
  list.columns = {"map", "pressure [Pa]"};
  for (int i = 0; i < 5000; ++i) list.rows.push_back({std::to_string(i) + ".gsf", "0"});
  const std::string text = edit_csv_list("", list) + "# end\n";
  list.rows.erase(list.rows.begin() + 2500);
  std::string wanted = text;
  wanted.erase(wanted.find("2500.gsf"), std::string("2500.gsf,0\n").size());
  EXPECT_EQ(edit_csv_list(text, list), wanted);
}

TEST(FormList, ChangesColumnsAndKeepsDelimiterLineEndsAndComments) {
  const std::string text = "# top\r\nmap;pressure [Pa]\r\na.gsf;1,5";
  FormList list = wanted_of(text);
  list.columns = {"map", "pressure [mbar]", "direction"};
  list.rows[0] = {"a.gsf", "0,015", "up"};
  EXPECT_EQ(edit_csv_list(text, list),
            "# top\r\nmap;pressure [mbar];direction\r\na.gsf;0,015;up\r\n");
}

TEST(FormList, WritesATableIntoAnEmptyText) {
  FormList list;
  list.columns = {"map", "flow_rate [mL/min]"};
  list.rows = {{"f.gsf", "5"}};
  EXPECT_EQ(edit_csv_list("", list), "map,flow_rate [mL/min]\nf.gsf,5\n");
}

TEST(FormList, KnowsCellsOfSeveralLinesFromComments) {
  const std::string text = "# top\nmap,run\n\"a\n# no comment\",x\n# of c\nc,y\n";
  FormList list = wanted_of(text);
  ASSERT_EQ(list.rows.size(), 2u);
  list.rows[0][1] = "z";
  const std::string changed = edit_csv_list(text, list);
  EXPECT_EQ(changed, "# top\nmap,run\n\"a\n# no comment\",z\n# of c\nc,y\n");
  list.rows.erase(list.rows.begin());
  EXPECT_EQ(edit_csv_list(changed, list), "# top\nmap,run\n# of c\nc,y\n");
}

TEST(FormList, TakesLineEndsOfOldMachines) {
  const std::string text = "# top\rmap,run\ra,x\r# of b\rb,y";
  FormList list = wanted_of(text);
  list.rows[0][1] = "z";
  EXPECT_EQ(edit_csv_list(text, list), "# top\rmap,run\ra,z\n# of b\rb,y\n");
  // Within quotes a carriage return alone ends no line: nothing is lost all the same.
  const std::string odd = "# top\nmap,run\n\"a\rb\",x\n# of c\nc,y\n";
  list = wanted_of(odd);
  list.rows[1][1] = "z";
  const std::string changed = edit_csv_list(odd, list);
  EXPECT_TRUE(same_table(wanted_of(changed), list)) << changed;
  EXPECT_NE(changed.find("# of c\n"), std::string::npos);
}

TEST(FormList, LocksWhatIsNoTable) {
  EXPECT_NE(wanted_of("map,run\na\n").locked, "");
  EXPECT_NE(wanted_of("map [Pa,run\n").locked, "");
  EXPECT_THROW(edit_csv_list("map,run\na\n", FormList{"h.csv", {"map"}, {{"a"}}, {}, ""}),
               InputError);
}

TEST(FormList, RefusesWhatATableCannotHold) {
  FormList list = wanted_of(kText);
  list.rows[0].pop_back();
  EXPECT_THROW(edit_csv_list(kText, list), InputError);
  list = wanted_of(kText);
  list.rows[0] = {"", "", ""};  // a reader drops such rows: nothing is lost in silence
  EXPECT_THROW(edit_csv_list(kText, list), InputError);
}

}  // namespace
}  // namespace manoscope::experiment

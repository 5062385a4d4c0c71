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

TEST(FormList, WritesCellsOfSeveralLinesAnew) {
  const std::string text = "map,run\n\"a\nb\",x\nc,y\n";
  FormList list = wanted_of(text);
  ASSERT_EQ(list.rows.size(), 2u);
  list.rows[0][1] = "z";
  const std::string changed = edit_csv_list(text, list);
  EXPECT_TRUE(same_table(wanted_of(changed), list)) << changed;
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

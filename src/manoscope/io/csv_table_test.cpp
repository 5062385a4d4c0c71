#include "manoscope/io/csv_table.hpp"

#include <gtest/gtest.h>

#include <filesystem>
#include <string>

#include "manoscope/core/error.hpp"

namespace manoscope::io {
namespace {

CsvTable parse(const std::string& text) { return parse_csv_table(text, "list.csv"); }

/// The message of the fault in `text`, or "" if there is none.
std::string fault_of(const std::string& text) {
  try {
    parse(text);
    return "";
  } catch (const InputError& error) {
    return error.what();
  }
}

TEST(CsvTable, SeparatesNamesFromUnits) {
  const CsvTable table = parse("map,pressure [Pa],flow_rate [ mL/min ] ,run\nh00.gsf,0,5,Q5\n");
  ASSERT_EQ(table.columns.size(), 4u);
  EXPECT_EQ(table.columns[0].unit, "");
  EXPECT_EQ(table.columns[1].name, "pressure");
  EXPECT_EQ(table.columns[1].unit, "Pa");
  EXPECT_EQ(table.columns[2].unit, "mL/min");
  EXPECT_EQ(table.column("run"), 3u);
  EXPECT_EQ(table.column("time"), std::nullopt);
}

TEST(CsvTable, KeepsTheLineOfEveryRow) {
  const CsvTable table =
      parse("# made by hand\n\nmap,pressure [Pa]\n# up\nh00.gsf,0\n\nh01.gsf,1\n");
  ASSERT_EQ(table.rows.size(), 2u);
  EXPECT_EQ(table.rows[0].line, 5);
  EXPECT_EQ(table.rows[1].line, 7);
}

TEST(CsvTable, ReadsTheSameTableFromEveryDialect) {
  for (const char* text : {
           "map,pressure [Pa],run\nh 0.gsf,1.5,\nh1.gsf,-2e3,b\n",
           "map;pressure [Pa];run\nh 0.gsf;1,5;\nh1.gsf;-2e3;b\n",
           "map;pressure [Pa];run\nh 0.gsf;1.5;\nh1.gsf;-2000;b\n",
           "map\tpressure [Pa]\trun\nh 0.gsf\t1,5\t\nh1.gsf\t-2000\tb\n",
           "\xEF\xBB\xBFmap,pressure [Pa],run\r\nh 0.gsf,1.5,\r\nh1.gsf,-2000,b\r\n",
           "map,pressure [Pa],run\rh 0.gsf,1.5,\rh1.gsf,-2000,b",
           "\"map\", \"pressure [Pa]\" ,run\n\"h 0.gsf\",\"1.5\",\"\"\n h1.gsf , -2000 , b \n",
           "map,pressure [Pa],run,,\nh 0.gsf,1.5,,,\nh1.gsf,-2000,b,,\n,,,,\n",
       }) {
    const CsvTable table = parse(text);
    ASSERT_EQ(table.columns.size(), 3u) << text;
    EXPECT_EQ(table.columns[1].unit, "Pa") << text;
    ASSERT_EQ(table.rows.size(), 2u) << text;
    EXPECT_EQ(table.rows[0].cells[0], "h 0.gsf") << text;
    EXPECT_EQ(table.rows[0].cells[2], "") << text;
    EXPECT_EQ(table.cell_number(table.rows[0], 1), 1.5) << text;
    EXPECT_EQ(table.cell_number(table.rows[1], 1), -2000.0) << text;
  }
}

TEST(CsvTable, QuotedCellsHoldDelimitersQuotesAndLineEnds) {
  const CsvTable table = parse("map,run\n\"a,b.gsf\",\"say \"\"Q5\"\"\"\n\"two\nlines\",x\nc,d\n");
  ASSERT_EQ(table.rows.size(), 3u);
  EXPECT_EQ(table.rows[0].cells[0], "a,b.gsf");
  EXPECT_EQ(table.rows[0].cells[1], "say \"Q5\"");
  EXPECT_EQ(table.rows[1].cells[0], "two\nlines");
  EXPECT_EQ(table.rows[2].line, 5);
}

TEST(CsvTable, ADecimalCommaIsNoNumberWhereTheCommaSeparatesCells) {
  const CsvTable table = parse("map,pressure [Pa]\na,\"1,5\"\nb,x\nc,\n");
  for (const CsvRow& row : table.rows) EXPECT_EQ(table.cell_number(row, 1), std::nullopt);
  const CsvTable grouped = parse("map;pressure [Pa]\na;1.234,5\n");
  EXPECT_EQ(grouped.cell_number(grouped.rows[0], 1), std::nullopt);
}

TEST(CsvTable, SaysWhatIsWrongAndWhere) {
  struct Case {
    std::string text, message;
  };
  for (const Case& c : {
           Case{"", "list.csv: the file is empty"},
           Case{"\n# only this\n\n", "list.csv: there is no header line"},
           Case{",,\na,b,c\n", "list.csv: the header line names no column"},
           Case{"map,,run\na,b,c\n", "list.csv:1: column 2 has no name"},
           Case{"map,run,map\na,b,c\n", "list.csv:1: column \"map\" stands there twice"},
           Case{"map,pressure [Pa\na,b\n", "list.csv:1: column head \"pressure [Pa\""},
           Case{"map,run\na,b\nc\n", "list.csv:3: 1 cells under 2 columns"},
           Case{"map,pressure [Pa]\na,1,5\n",
                "list.csv:2: 3 cells under 2 columns. "
                "Give every row as many cells as the header; with "
                "decimal commas"},
           Case{"map,run\na,\"b\nc,d\n", "list.csv:2: a quote \" that is never closed"},
           Case{"map,run\na,\xB5m\n", "list.csv:2: byte 0xB5 is not UTF-8 text"},
           Case{"\xFF\xFEm", "list.csv: the text is UTF-16"},
           Case{std::string("map,run\na\0,b\n", 13), "list.csv:2: a zero byte"},
       }) {
    EXPECT_EQ(fault_of(c.text).substr(0, c.message.size()), c.message) << c.text;
  }
}

TEST(CsvTable, TellsEveryRowAtFaultWhenAsked) {
  std::vector<CsvRowFault> faults;
  const CsvTable table = parse_csv_table("map,run\na\nb,c\nd,e,f\n", "list.csv", faults);
  ASSERT_EQ(table.rows.size(), 1u);
  EXPECT_EQ(table.rows[0].cells[0], "b");
  ASSERT_EQ(faults.size(), 2u);
  EXPECT_EQ(faults[0].line, 2);
  EXPECT_EQ(faults[1].line, 4);
}

TEST(CsvTable, RefusesAFolderAndAMissingFile) {
  EXPECT_THROW(read_csv_table(std::filesystem::temp_directory_path()), InputError);
  EXPECT_THROW(read_csv_table("no-such-folder/list.csv"), InputError);
}

}  // namespace
}  // namespace manoscope::io

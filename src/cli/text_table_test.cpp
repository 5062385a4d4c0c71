#include "text_table.hpp"

#include <gtest/gtest.h>

#include <cmath>

namespace manoscope::cli {
namespace {

TEST(TextTable, AlignsNumbersAndTheirBarsByTheDecimalPoint) {
  EXPECT_EQ(text_table({{"run", "dp ± U [Pa]", "word"},
                        {"Q5", "12287 ± 21", "agrees"},
                        {"Q10_again", "95.25 ± 0.71", "-"},
                        {"Q20", "-", "differs"}},
                       {Align::left, Align::point, Align::left}),
            "run             dp ± U [Pa]  word\n"
            "Q5         12287    ± 21     agrees\n"
            "Q10_again     95.25 ±  0.71  -\n"
            "Q20            -             differs\n");
}

TEST(TextTable, LeavesSeveralHeadsToTheRight) {
  EXPECT_EQ(text_table({{"Q", "E_n"}, {"[mL/min]", ""}, {"2.5", "0.10"}, {"70", "-"}},
                       {Align::point, Align::point}, 2),
            "       Q   E_n\n"
            "[mL/min]\n"
            "     2.5  0.10\n"
            "    70    -\n");
}

TEST(TextTable, ANarrowTerminalLosesTheHighestRankFirst) {
  std::vector<Column> columns{
      {{"run"}, Align::left}, {{"long head"}, Align::right, 1}, {{"other"}, Align::right, 2}};
  add_row(columns, {"Q5", "1", "2"});
  Screen screen;
  screen.columns = 5;
  EXPECT_EQ(text_table(columns, screen), "run  long head  other\nQ5           1      2\n");
  screen.terminal = true;
  screen.columns = 20;
  EXPECT_EQ(text_table(columns, screen), "run  long head\nQ5           1\n");
  for (const int narrow : {13, 2}) {  // the last column stays, whatever the screen
    screen.columns = narrow;
    EXPECT_EQ(text_table(columns, screen), "run\nQ5\n");
  }
}

TEST(TextTable, ColoursTakeNoRoom) {
  EXPECT_EQ(shown_width("\033[32mdp ± U\033[0m"), 6U);
  EXPECT_EQ(text_table({{"\033[31mab\033[0m", "c"}, {"abc", "d"}}),
            " \033[31mab\033[0m  c\nabc  d\n");
}

TEST(TextTable, BreaksLongLinesAloneAndNoWord) {
  EXPECT_EQ(wrapped("a  short line\none two three four\nunbreakable", 13),
            "a  short line\none two three\n  four\nunbreakable\n");
  EXPECT_EQ(wrapped("dp ± U", 6), "dp ± U\n");
  EXPECT_EQ(wrapped("dp ± U", 5), "dp ±\n  U\n");
  EXPECT_EQ(wrapped("", 10), "");
}

TEST(TextTable, WritesValuesToTwoDigitsOfTheirBar) {
  EXPECT_EQ(value_text(12287.4, 10.4), "12287 ± 21");
  EXPECT_EQ(value_text(1.2345, 0.0355), "1.234 ± 0.071");
  EXPECT_EQ(value_text(12.3, 0.0), "12");
  EXPECT_EQ(value_text(std::nan(""), 1.0), "-");
  EXPECT_EQ(fixed(0.126, 2), "0.13");
  EXPECT_EQ(fixed(std::nan(""), 2), "-");
  EXPECT_EQ(flow_rate_text(12.5 * mL_per_min), "12.5");
}

}  // namespace
}  // namespace manoscope::cli

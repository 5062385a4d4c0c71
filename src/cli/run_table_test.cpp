#include "run_table.hpp"

#include <gtest/gtest.h>

#include <algorithm>
#include <initializer_list>
#include <limits>
#include <string>

#include "manoscope/core/arrays.hpp"
#include "text_table.hpp"

namespace manoscope::cli {
namespace {

constexpr double kNone = std::numeric_limits<double>::quiet_NaN();

Array1 of(std::initializer_list<double> values) {
  Array1 array(static_cast<Index>(values.size()));
  std::copy(values.begin(), values.end(), array.data());
  return array;
}

Array2 row(std::initializer_list<double> values) {
  Array2 array(1, static_cast<Index>(values.size()));
  array.row(0) = of(values).transpose();
  return array;
}

/// Four runs, one of each verdict; drops in Pa, uncertainties standard.
results::Measurement four_runs() {
  results::Measurement m;
  m.run = {"Q5", "Q10", "Q20", "Q70"};
  m.flow_rate = of({5.0, 10.0, 20.0, 70.5}) / 60e6;
  m.extracted_drop = of({1000.25, 2000.0, 4000.0, kNone});
  m.extracted_drop_uncertainty = of({0.5, 5.0, 50.0, kNone});
  m.resistance_drop = of({990.0, 1990.0, 3900.0, 13000.0});
  m.resistance_drop_uncertainty = of({15.0, 15.0, 15.0, 15.0});
  m.en_number = of({0.5, 1.5, 3.25, kNone});
  m.flow_model = {"section-march"};
  m.verdict_model = "section-march";
  m.model_drop = row({1001.0, 2010.0, 4500.0, 14000.0});
  m.model_drop_uncertainty = row({15.0, 15.0, 15.0, 150.0});
  m.model_en_number = row({0.25, 0.5, 4.75, kNone});
  m.model_p_value = row({0.5, 1e-4, 1e-9, kNone});
  m.model_stated_error = row({0.001, 0.001, 0.001, 0.03});
  return m;
}

Screen terminal(int columns) {
  Screen screen;
  screen.terminal = screen.moves = screen.colour = true;
  screen.columns = columns;
  return screen;
}

TEST(RunTable, HasEveryRunWithUnitsBarsAndVerdict) {
  const std::string text = run_table(four_runs(), Screen{});
  const std::string table =
      "run         Q        dp_e ± U  dp by the flow ± U   E_n  verdict\n"
      "     [mL/min]            [Pa]                [Pa]\n"
      "Q5        5    1000.2 ±   1.0          1001 ±  30  0.25  agrees\n";
  EXPECT_EQ(text.substr(0, table.size()), table);
  for (const char* line : {"  only the drop\n", "  differs\n", "  no verdict*\n",
                           "flow model section-march", "k = 2", "*: the model itself"}) {
    EXPECT_NE(text.find(line), std::string::npos) << line << text;
  }
  EXPECT_EQ(text.find('\033'), std::string::npos);
  EXPECT_TRUE(fits(text, 80)) << text;
}

TEST(RunTable, ColoursNothingButTheVerdictOnATerminal) {
  const std::string text = run_table(four_runs(), terminal(80));
  for (const char* word : {"\033[32magrees\033[0m\n", "\033[33monly the drop\033[0m\n",
                           "\033[31mdiffers\033[0m\n", "  no verdict*\n"}) {
    EXPECT_NE(text.find(word), std::string::npos) << word;
  }
  EXPECT_EQ(std::count(text.begin(), text.end(), '\033'), 6);
}

TEST(RunTable, AgreementWithADoubtfulModelIsNotGreen) {
  results::Measurement m = four_runs();
  m.model_stated_error(0, 0) = 0.03;
  const std::string text = run_table(m, terminal(80));
  EXPECT_NE(text.find("\033[33magrees\033[0m*\n"), std::string::npos) << text;
}

TEST(RunTable, KeepsDropAndVerdictOnANarrowTerminal) {
  for (const int columns : {70, 64, 60, 50, 40}) {
    const std::string text = run_table(four_runs(), terminal(columns));
    EXPECT_TRUE(fits(text, columns)) << text;
    EXPECT_NE(text.find("4000   ± 100"), std::string::npos) << text;
    EXPECT_NE(text.find("differs"), std::string::npos) << text;
    EXPECT_EQ(text.find("[mL/min]") != std::string::npos, columns >= 64) << text;
  }
}

TEST(RunTable, TakesEquationFourWhereNoModelWasRun) {
  results::Measurement m = four_runs();
  m.flow_model.clear();
  m.verdict_model.clear();
  const std::string text = run_table(m, terminal(80));
  for (const char* word : {"990 ± 30", "\033[32mwithin U\033[0m\n", "\033[33mbeyond U\033[0m\n",
                           "  no verdict\n", "paper's eq. (4)"}) {
    EXPECT_NE(text.find(word), std::string::npos) << word << text;
  }
}

}  // namespace
}  // namespace manoscope::cli

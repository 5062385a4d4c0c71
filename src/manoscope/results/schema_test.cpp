#include "manoscope/results/schema.hpp"

#include <gtest/gtest.h>

#include <set>
#include <sstream>

#include "manoscope/core/error.hpp"
#include "manoscope/core/provenance.hpp"
#include "manoscope/core/unit_text.hpp"
#include "tests/support/example_measurement.hpp"
#include "tests/support/paths.hpp"

namespace manoscope::results {
namespace {

TEST(Schema, NamesEveryVariableOnceAndOnlyDimensionsThatExist) {
  std::set<std::string_view> names;
  for (const Variable& variable : variables()) {
    EXPECT_TRUE(names.insert(variable.name).second) << variable.name;
    for (const auto name : variable.dimensions) EXPECT_NO_THROW(dimension(name)) << variable.name;
    EXPECT_FALSE(variable.long_name.empty()) << variable.name;
  }
  for (const Variable& variable : variables()) {
    std::istringstream ancillary{std::string(variable.ancillary_variables)};
    for (std::string name; ancillary >> name;) EXPECT_TRUE(names.contains(name)) << name;
  }
}

TEST(Schema, WritesUnitsThatUdunitsKnows) {
  for (const Variable& variable : variables()) {
    EXPECT_TRUE(is_known_unit(variable.units)) << variable.name << ": " << variable.units;
  }
}

TEST(Schema, MapsEveryVariableToAMemberOfItsOwn) {
  // Two variables on one member would write one array twice and lose the other.
  for (std::size_t i = 0; i < variables().size(); ++i) {
    for (std::size_t j = 0; j < i; ++j) {
      EXPECT_FALSE(variables()[i].member == variables()[j].member)
          << variables()[i].name << " and " << variables()[j].name;
    }
  }
}

TEST(Schema, FindsAnArrayWhoseShapeIsNotThatOfItsDimensions) {
  auto measurement = test_support::example_measurement({.n_x = 10, .n_levels = 3, .n_runs = 2});
  EXPECT_NO_THROW(check_shapes(measurement));
  measurement.pressure_covariance.pop_back();
  try {
    check_shapes(measurement);
    FAIL();
  } catch (const InternalError& error) {
    EXPECT_NE(std::string(error.what()).find("pressure_covariance"), std::string::npos);
  }
}

TEST(Schema, PrintsOneLineAVariable) {
  const std::string text = schema_as_markdown();
  EXPECT_EQ(static_cast<std::size_t>(std::count(text.begin(), text.end(), '\n')),
            variables().size() + 2);
  EXPECT_NE(text.find("| `pressure_covariance` | run, x, x_other | Pa2 |"), std::string::npos);
}

TEST(Schema, IsTheTableOfTheManual) {
  const std::string page =
      read_file(std::filesystem::path(test_paths::source) / "docs" / "result-file.md");
  EXPECT_NE(page.find(schema_as_markdown()), std::string::npos)
      << "put this into docs/result-file.md:\n"
      << schema_as_markdown();
}

}  // namespace
}  // namespace manoscope::results

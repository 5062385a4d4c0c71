#include "manoscope/core/options.hpp"

#include <gtest/gtest.h>

#include <string>

namespace manoscope {
namespace {

struct SomeOptions {
  Length smoothing{};
  std::optional<Length> margin;
  int draws = 0;
  template <class Visitor>
  void describe(Visitor&& visit) {
    visit("smoothing", smoothing, "standard deviation along x");
    visit("margin", margin, "width of the margin");
    visit("draws", draws, "Monte Carlo draws");
  }
};

TEST(Options, AreSetByNameWithTheirUnit) {
  SomeOptions options;
  set_option(options, "smoothing", "50um", "--smoothing");
  set_option(options, "margin", "0.1 mm", "--margin");
  set_option(options, "draws", "12", "--draws");
  EXPECT_DOUBLE_EQ(options.smoothing.in(um), 50.0);
  EXPECT_DOUBLE_EQ(options.margin.value().in(um), 100.0);
  EXPECT_EQ(options.draws, 12);
  set_option(options, "margin", "auto", "--margin");
  EXPECT_FALSE(options.margin);
}

TEST(Options, RefuseABareNumberForALengthAndAnUnknownName) {
  SomeOptions options;
  EXPECT_THROW(set_option(options, "smoothing", "50", "--smoothing"), InputError);
  EXPECT_THROW(set_option(options, "draws", "1.5", "--draws"), InputError);
  try {
    set_option(options, "smothing", "50um", "settings");
    FAIL();
  } catch (const InputError& error) {
    EXPECT_NE(std::string(error.what()).find("did you mean \"smoothing\""), std::string::npos);
  }
}

TEST(Options, AreListedWithUnitAndKind) {
  const auto list = list_options(SomeOptions{});
  ASSERT_EQ(list.size(), 3u);
  EXPECT_EQ(list[0].value, "0 m");
  EXPECT_EQ(list[1].value, "auto");
  EXPECT_EQ(list[1].kind, "length or auto");
}

}  // namespace
}  // namespace manoscope

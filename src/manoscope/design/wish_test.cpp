#include "manoscope/design/wish.hpp"

#include <gtest/gtest.h>

#include <string>

#include "manoscope/core/error.hpp"

namespace manoscope::design {
namespace {

/// Where and what validate() finds; "" if nothing.
std::string fault_of(const Wish& wish) {
  try {
    wish.validate();
  } catch (const InputError& error) {
    return error.where() + " " + error.found();
  }
  return "";
}

TEST(Wish, RefusesWhatCannotBeByName) {
  EXPECT_EQ(fault_of({}), "");
  Wish wish;
  wish.uncertainty = Pressure{};
  EXPECT_EQ(fault_of(wish), "--uncertainty is 0 Pa");
  wish = {};
  wish.resolution = -1.0 * mm;
  EXPECT_EQ(fault_of(wish), "--resolution is -0.001 m");
  wish = {};
  wish.lowest = -5.0 * Pa;
  EXPECT_EQ(fault_of(wish), "--lowest is -5 Pa");
  wish.lowest = 2.0 * kPa;
  wish.highest = 1.0 * kPa;
  EXPECT_EQ(fault_of(wish), "--lowest is 2000 Pa, --highest 1000 Pa");
  wish = {};
  wish.levels = 3;
  EXPECT_EQ(fault_of(wish), "--levels is 3");
  wish = {};
  wish.most_levels = 1000;
  EXPECT_EQ(fault_of(wish), "--most-levels is 1000");
  wish = {};
  wish.minimise = "wurst";
  EXPECT_EQ(fault_of(wish), "--minimise is \"wurst\" (did you mean \"worst\"?)");
  wish = {};
  wish.wall_doubt = 0.9;
  EXPECT_EQ(fault_of(wish), "--wall-doubt is 0.9");
}

TEST(Wish, AimsAtTheWorstWhereAnUncertaintyIsWanted) {
  Wish wish;
  EXPECT_EQ(wish.aim(), Aim::rms);
  wish.uncertainty = 5.0 * Pa;
  EXPECT_EQ(wish.aim(), Aim::worst);
  wish.minimise = "rms";
  EXPECT_EQ(wish.aim(), Aim::rms);
}

}  // namespace
}  // namespace manoscope::design

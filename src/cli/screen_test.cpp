#include "screen.hpp"

#include <gtest/gtest.h>

namespace manoscope::cli {
namespace {

TEST(Screen, APipeHasNoColourAndTheUsualWidth) {
  const Screen pipe = screen_from(false, 0, {"40", nullptr, "xterm"});
  EXPECT_FALSE(pipe.terminal || pipe.moves || pipe.colour);
  EXPECT_EQ(pipe.columns, kUsualColumns);
}

TEST(Screen, ColourGoesWithoutNoColorAndOnTerminalsThatKnowIt) {
  EXPECT_TRUE(screen_from(true, 80, {nullptr, nullptr, "xterm"}).colour);
  EXPECT_TRUE(screen_from(true, 80, {nullptr, "", "xterm"}).colour);
  EXPECT_FALSE(screen_from(true, 80, {nullptr, "1", "xterm"}).colour);
  EXPECT_TRUE(screen_from(true, 80, {nullptr, "1", "xterm"}).moves);
  for (const char* term : {"dumb", "", static_cast<const char*>(nullptr)}) {
    const Screen plain = screen_from(true, 80, {nullptr, nullptr, term});
    EXPECT_TRUE(plain.terminal);
    EXPECT_FALSE(plain.moves || plain.colour);
  }
}

TEST(Screen, ColumnsGoBeforeWhatTheTerminalSays) {
  EXPECT_EQ(screen_from(true, 132, {nullptr, nullptr, "xterm"}).columns, 132);
  EXPECT_EQ(screen_from(true, 132, {"60", nullptr, "xterm"}).columns, 60);
  for (const char* no_number : {"", "wide", "60x", "-5", "0", "99999999999999999999"}) {
    EXPECT_EQ(screen_from(true, 132, {no_number, nullptr, "xterm"}).columns, 132) << no_number;
  }
  EXPECT_EQ(screen_from(true, 0, {nullptr, nullptr, "xterm"}).columns, kUsualColumns);
}

TEST(Screen, TheWordStandsWhetherColouredOrNot) {
  Screen screen;
  EXPECT_EQ(coloured("agrees", Colour::green, screen), "agrees");
  screen.colour = true;
  EXPECT_EQ(coloured("agrees", Colour::green, screen), "\033[32magrees\033[0m");
  EXPECT_EQ(coloured("only the drop", Colour::yellow, screen), "\033[33monly the drop\033[0m");
  EXPECT_EQ(coloured("differs", Colour::red, screen), "\033[31mdiffers\033[0m");
  EXPECT_EQ(coloured("no verdict", Colour::none, screen), "no verdict");
}

}  // namespace
}  // namespace manoscope::cli

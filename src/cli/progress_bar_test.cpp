#include "progress_bar.hpp"

#include <gtest/gtest.h>

#include <algorithm>
#include <string>

#include "text_table.hpp"

namespace manoscope::cli {
namespace {

TEST(ProgressTrack, NeverRunsBackWithinAStage) {
  ProgressTrack track;
  EXPECT_EQ(track.report("reducing maps", 0.2, 0.0).share, 0.2);
  EXPECT_EQ(track.report("reducing maps", 0.4, 0.1).share, 0.4);
  // The thread that was second to finish reports first.
  EXPECT_EQ(track.report("reducing maps", 0.3, 0.2).share, 0.4);
  EXPECT_EQ(track.report("reducing maps", 1.7, 0.3).share, 1.0);
  const Progress& next = track.report("reading p(x)", 0.1, 0.4);
  EXPECT_EQ(next.share, 0.1);
  EXPECT_EQ(next.stage, "reading p(x)");
}

TEST(ProgressTrack, TellsTheTimeLeftOfWorkThatGoesEvenly) {
  ProgressTrack track;
  EXPECT_FALSE(track.report("reducing maps", 0.1, 5.0).seconds_left);
  EXPECT_FALSE(track.report("reducing maps", 0.2, 5.5).seconds_left) << "too early to tell";
  const Progress& told = track.report("reducing maps", 0.5, 7.0);
  ASSERT_TRUE(told.seconds_left);
  EXPECT_NEAR(*told.seconds_left, 2.5, 1e-9);  // 0.4 in 2 s, 0.5 to go; the rest is round-off
  EXPECT_FALSE(track.report("reading p(x)", 0.5, 8.0).seconds_left) << "another stage";
  EXPECT_FALSE(track.report("reading p(x)", 0.5, 18.0).seconds_left) << "nothing done meanwhile";
}

TEST(ProgressText, HasStageBarShareAndTimeLeft) {
  EXPECT_EQ(progress_text({"reducing maps", 0.3, 11.2}, 100),
            "reducing maps            [#########.....................]   30 %  12 s left");
  EXPECT_EQ(progress_text({"reducing maps", 1.0, 0.0}, 100),
            "reducing maps            [##############################]  100 %");
  EXPECT_EQ(progress_text({"finding the channel", 0.0, {}}, 100), "finding the channel ...");
}

TEST(ProgressText, CountsSecondsThenMinutesThenHoursUp) {
  const auto end = [](double seconds) {
    const std::string text = progress_text({"s", 0.5, seconds}, 100);
    return text.substr(text.find('%') + 3);
  };
  EXPECT_EQ(end(0.2), "1 s left");
  EXPECT_EQ(end(89.5), "90 s left");
  EXPECT_EQ(end(91.0), "2 min left");
  EXPECT_EQ(end(5399.0), "90 min left");
  EXPECT_EQ(end(5401.0), "2 h left");
}

TEST(ProgressText, StaysOnOneLineOfAnyScreen) {
  const Progress progress{"Q5: Navier-Stokes, développé inlet", 0.5, 7.0};
  for (int columns = 0; columns <= 100; ++columns) {
    const std::string text = progress_text(progress, columns);
    EXPECT_LT(shown_width(text), static_cast<std::size_t>(std::max(columns, 1))) << text;
    // Whole characters: what follows the first byte of one is there.
    EXPECT_TRUE(text.empty() || static_cast<unsigned char>(text.back()) < 0xC0) << text;
  }
  EXPECT_NE(progress_text({"reducing maps", 0.5, 7.0}, 80).find("7 s left"), std::string::npos);
  EXPECT_EQ(progress_text({"reducing maps", 0.5, 7.0}, 40),
            "reducing maps            [##...]   50 %");
  EXPECT_EQ(progress_text({"reducing maps", 0.5, 7.0}, 30), "reducing maps   50 %");
}

}  // namespace
}  // namespace manoscope::cli

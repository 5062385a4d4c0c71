#include "manoscope/core/words.hpp"

#include <gtest/gtest.h>

#include <set>
#include <string>

#include "manoscope/core/frame_words.hpp"

namespace manoscope {
namespace {

TEST(Words, EveryValueHasAWordOfItsOwn) {
  std::set<std::string> words;
  for (const auto flow : {FlowDirection::plus_columns, FlowDirection::minus_columns,
                          FlowDirection::plus_rows, FlowDirection::minus_rows}) {
    words.insert(word_of(kFlowDirections, flow));
  }
  EXPECT_EQ(words, (std::set<std::string>{"+columns", "-columns", "+rows", "-rows"}));
  EXPECT_STREQ(word_of(kOutwards, Outward::plus_height), "+height");
  EXPECT_STREQ(word_of(kOutwards, Outward::minus_height), "-height");
}

TEST(Words, AValueThatTheTableHasNotHasNone) {
  constexpr Word<int> kWords[] = {{"one", 1}};
  EXPECT_STREQ(word_of(kWords, 1), "one");
  EXPECT_STREQ(word_of(kWords, 2), "");
}

}  // namespace
}  // namespace manoscope

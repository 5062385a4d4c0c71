#include "manoscope/core/suggest.hpp"

#include <gtest/gtest.h>

#include <vector>

namespace manoscope {
namespace {

TEST(Suggest, FindsTheWordThatWasMeant) {
  const std::vector<std::string> known{"height", "width", "length"};
  EXPECT_EQ(nearest_word("heigth", known), "height");
  EXPECT_EQ(nearest_word("Width", known), "width");
  EXPECT_EQ(nearest_word("viscosity", known), "");
  EXPECT_EQ(nearest_word(std::string(100000, 'x'), known), "");
  EXPECT_EQ(did_you_mean("lenght", known), " (did you mean \"length\"?)");
}

}  // namespace
}  // namespace manoscope

#include "manoscope/core/base64.hpp"

#include <gtest/gtest.h>

namespace manoscope {
namespace {

TEST(Base64, GivesTheVectorsOfRfc4648) {
  EXPECT_EQ(base64(""), "");
  EXPECT_EQ(base64("f"), "Zg==");
  EXPECT_EQ(base64("fo"), "Zm8=");
  EXPECT_EQ(base64("foo"), "Zm9v");
  EXPECT_EQ(base64("foobar"), "Zm9vYmFy");
  EXPECT_EQ(base64(std::string("\x00\xff\x7f", 3)), "AP9/");
}

TEST(Base64, OfLongBytesIsThatOfTheirPieces) {
  const std::string bytes((3 << 20) + 1, 'a');
  const std::string text = base64(bytes);
  EXPECT_EQ(text.size(), (bytes.size() + 2) / 3 * 4);
  EXPECT_EQ(text.find('='), text.size() - 2);
  EXPECT_EQ(text.substr(text.size() - 8), "YWFhYQ==");
}

}  // namespace
}  // namespace manoscope

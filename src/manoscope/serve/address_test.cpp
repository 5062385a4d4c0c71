#include "manoscope/serve/address.hpp"

#include <gtest/gtest.h>

namespace manoscope::serve {
namespace {

using Parts = std::vector<std::string>;

TEST(Address, TakesPathAndQueryApart) {
  const auto address = parse_address("/results/a%20b/h%231.csv?folder=x%2Fy&download");
  ASSERT_TRUE(address);
  EXPECT_EQ(address->parts, (Parts{"results", "a b", "h#1.csv"}));
  EXPECT_EQ(address->value("folder"), "x/y");
  EXPECT_EQ(address->value("download"), "");
  EXPECT_EQ(address->value("none"), std::nullopt);
  EXPECT_EQ(parse_address("/")->parts, Parts{});
}

TEST(Address, DecodesOnce) {
  EXPECT_EQ(parse_address("/%252e%252e/x")->parts, (Parts{"%2e%2e", "x"}));
}

TEST(Address, RefusesEveryWayOut) {
  for (const char* target : {"",
                             "x",
                             "*",
                             "http://127.0.0.1/",
                             "//x",
                             "/a//b",
                             "/a/",
                             "/.",
                             "/..",
                             "/../x",
                             "/a/../b",
                             "/%2e%2e/x",
                             "/%2E./x",
                             "/.%2e",
                             "/a%2Fb",
                             "/a%2f..%2fb",
                             "/a%5c..%5cb",
                             "/a\\b",
                             "/%c0%ae%c0%ae/x",
                             "/%e0%80%ae",
                             "/%00",
                             "/a%00.csv",
                             "/a%0d%0aSet-Cookie:x",
                             "/%7f",
                             "/%",
                             "/%2",
                             "/%zz",
                             "/%u002e",
                             "/%ff",
                             "/%ed%a0%80",
                             "/x?a=%00",
                             "/x?a=%c0%ae",
                             "/x?a=%",
                             "/x?a=1&a=2"}) {
    EXPECT_FALSE(parse_address(target)) << target;
  }
}

TEST(Address, RelativePathsHoldPlainNamesAlone) {
  EXPECT_EQ(relative_parts(""), Parts{});
  EXPECT_EQ(relative_parts("s1/µ 1.gsf"), (Parts{"s1", "µ 1.gsf"}));
  for (const char* path : {"/etc", "a/", "a//b", "..", "a/../b", ".", ".ssh/key", "a/.b", "a\\b",
                           "a\nb", "\xC0\xAE"}) {
    EXPECT_FALSE(relative_parts(path)) << path;
  }
  EXPECT_TRUE(is_plain_name(std::string(255, 'a')));
  EXPECT_FALSE(is_plain_name(std::string(256, 'a')));
}

}  // namespace
}  // namespace manoscope::serve

#include <gtest/gtest.h>
TEST(MembraneDic, Placeholder) {}

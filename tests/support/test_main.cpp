// Entry of every test program: floating-point faults trap, so that a NaN is met where it is made.
#include <gtest/gtest.h>

#include <cfenv>

int main(int argc, char** argv) {
  ::testing::InitGoogleTest(&argc, argv);
  feenableexcept(FE_DIVBYZERO | FE_INVALID | FE_OVERFLOW);
  return RUN_ALL_TESTS();
}

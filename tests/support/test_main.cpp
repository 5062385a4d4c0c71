// Entry of every test program: floating-point faults trap, so that a NaN is met where it is made.
#include <gtest/gtest.h>

#include <cfenv>

#include "tests/support/paths.hpp"

namespace manoscope::test_paths {

const char* const shared = MANOSCOPE_SHARED_DIR;
const char* const source = MANOSCOPE_SOURCE_DIR;
const char* const python = MANOSCOPE_PYTHON;
const char* const program = MANOSCOPE_PROGRAM;

}  // namespace manoscope::test_paths

int main(int argc, char** argv) {
  ::testing::InitGoogleTest(&argc, argv);
  feenableexcept(FE_DIVBYZERO | FE_INVALID | FE_OVERFLOW);
  return RUN_ALL_TESTS();
}

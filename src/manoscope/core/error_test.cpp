#include "manoscope/core/error.hpp"

#include <gtest/gtest.h>

#include "manoscope/core/monitor.hpp"

namespace manoscope {
namespace {

TEST(InputError, ReadsAsPlaceFindingMend) {
  const InputError error("a.toml:3", "gap is -1 um", "Give a positive gap");
  EXPECT_STREQ(error.what(), "a.toml:3: gap is -1 um. Give a positive gap.");
}

TEST(InputErrors, ShowsEveryFault) {
  const InputErrors errors({{"a", "b", "c"}, {"d", "e", "f"}});
  EXPECT_STREQ(errors.what(), "a: b. c.\nd: e. f.");
  EXPECT_EQ(errors.faults().size(), 2u);
}

TEST(Assertion, ThrowsAFaultOfOurs) { EXPECT_THROW(MANO_ASSERT(1 == 2), InternalError); }

TEST(Monitor, StopsWorkWhenAsked) {
  Monitor monitor;
  EXPECT_NO_THROW(monitor.checkpoint());
  monitor.stop_requested = [] { return true; };
  EXPECT_THROW(monitor.checkpoint(), Interrupted);
}

}  // namespace
}  // namespace manoscope

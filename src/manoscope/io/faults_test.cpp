#include "manoscope/io/faults.hpp"

#include <gtest/gtest.h>

namespace manoscope::io {
namespace {

TEST(Faults, AreToldByFileAndLine) {
  Faults faults;
  EXPECT_NO_THROW(faults.throw_if_any("experiment.toml"));
  faults.add({"flow.csv", 3, "map"}, "x", "y");
  faults.add({"experiment.toml", 9, "fluid.density"}, "x", "y");
  faults.add({"experiment.toml", 4, "channel.height"}, "x", "y");
  faults.add({"experiment.toml", 0, "wall"}, "x", "y");
  try {
    faults.throw_if_any("experiment.toml");
    FAIL();
  } catch (const InputErrors& errors) {
    ASSERT_EQ(errors.faults().size(), 4u);
    EXPECT_EQ(errors.faults()[0].where(), "experiment.toml: wall");
    EXPECT_EQ(errors.faults()[1].where(), "experiment.toml:4: channel.height");
    EXPECT_EQ(errors.faults()[2].where(), "experiment.toml:9: fluid.density");
    EXPECT_EQ(errors.faults()[3].where(), "flow.csv:3: map");
  }
}

TEST(Faults, QuoteTextsSafely) {
  EXPECT_EQ(in_quotes("a\nb"), "\"a?b\"");
  EXPECT_EQ(in_quotes(std::string(59, 'x') + "µm"), '"' + std::string(59, 'x') + "...\"");
  EXPECT_EQ(in_quotes("µm"), "\"µm\"");
}

}  // namespace
}  // namespace manoscope::io

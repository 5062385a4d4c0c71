#include "manoscope/core/colour_map.hpp"

#include <gtest/gtest.h>

namespace manoscope {
namespace {

TEST(Viridis, IsWithinThreeOfThePublishedTableBetweenItsEntries) {
  // Red bends most between the entries, by 3 at 0.9. viridis(11) of the R package viridisLite: the
  // table of 256 colours at 0, 0.1, ... 1.
  constexpr std::array<std::uint32_t, 11> kPublished{0x440154, 0x482576, 0x414487, 0x35608D,
                                                     0x2A788E, 0x21908C, 0x22A884, 0x43BF71,
                                                     0x7AD151, 0xBBDF27, 0xFDE725};
  for (std::size_t i = 0; i < kPublished.size(); ++i) {
    const Rgb colour = viridis(0.1 * static_cast<double>(i));
    for (std::size_t part = 0; part < 3; ++part) {
      EXPECT_NEAR(colour[part], kPublished[i] >> (8 * (2 - part)) & 0xffU, 3.0) << i;
    }
  }
}

TEST(Viridis, EndsAtItsEnds) {
  EXPECT_EQ(viridis(-3.0), viridis(0.0));
  EXPECT_EQ(viridis(7.0), viridis(1.0));
}

}  // namespace
}  // namespace manoscope

#include "manoscope/serve/peer_user.hpp"

#include <gtest/gtest.h>

namespace manoscope::serve {
namespace {

TEST(PeerUser, IsTheOneOfTheOtherEnd) {
  const std::string table =
      "  sl  local_address rem_address   st tx_queue rx_queue tr tm->when retrnsmt   uid  timeout\n"
      "   0: 0100007F:1F90 00000000:0000 0A 00000000:00000000 00:00000000 00000000  1000        0\n"
      "   1: 0100007F:1F90 0100007F:C001 01 00000000:00000000 00:00000000 00000000  1000        0\n"
      "   2: 0100007F:C001 0100007F:1F90 01 00000000:00000000 00:00000000 00000000  1001        "
      "0\n";
  EXPECT_EQ(peer_user_in(table, 0xC001, 0x1F90), 1001u);
  EXPECT_EQ(peer_user_in(table, 0xC002, 0x1F90), std::nullopt);
  EXPECT_EQ(peer_user_in("", 1, 2), std::nullopt);
  EXPECT_EQ(peer_user_in("0: x y 01 z w v u\n", 1, 2), std::nullopt);
}

}  // namespace
}  // namespace manoscope::serve

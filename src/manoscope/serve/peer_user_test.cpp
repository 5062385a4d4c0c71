#include "manoscope/serve/peer_user.hpp"

#include <gtest/gtest.h>

namespace manoscope::serve {
namespace {

constexpr std::uint32_t kLoopback = 0x7F000001;
constexpr ConnectionEnd kOwn{kLoopback, 0x1F90};

// As Linux prints it on machines that store the low byte first, as all do that this runs on.
const char* const kTable =
    "  sl  local_address rem_address   st tx_queue rx_queue tr tm->when retrnsmt   uid  timeout "
    "inode\n"
    "   0: 0100007F:1F90 00000000:0000 0A 00000000:00000000 00:00000000 00000000  1000 0 11 1\n"
    "   1: 0100007F:1F90 0100007F:C001 01 00000000:00000000 00:00000000 00000000  1000 0 12 1\n"
    "   2: 0200007F:C001 0100007F:1F90 01 00000000:00000000 00:00000000 00000000  1002 0 13 1\n"
    "   3: 0100007F:C001 0200007F:1F90 01 00000000:00000000 00:00000000 00000000  1003 0 14 1\n"
    "   4: 0100007F:C001 0100007F:1F90 01 00000000:00000000 00:00000000 00000000  1001 0 15 1\n"
    "   5: 0100007F:C002 0100007F:1F90 04 00000000:00000000 00:00000000 00000000     0 0 0 1\n"
    "   6: 0000000000000000FFFF00000100007F:C003 0000000000000000FFFF00000100007F:1F90 01 "
    "00000000:00000000 00:00000000 00000000  1004 0 16 1\n";

TEST(PeerUser, IsTheOneOfTheOtherEnd) {
  EXPECT_EQ(peer_user_in(kTable, {kLoopback, 0xC001}, kOwn), 1001u)
      << "not the one of equal ports between other addresses";
  EXPECT_EQ(peer_user_in(kTable, {kLoopback + 1, 0xC001}, kOwn), 1002u);
  EXPECT_EQ(peer_user_in(kTable, {kLoopback, 0xC003}, kOwn), 1004u);
}

TEST(PeerUser, IsNotToldOfWhatIsClosedOrNotThere) {
  EXPECT_EQ(peer_user_in(kTable, {kLoopback, 0xC002}, kOwn), std::nullopt);
  EXPECT_EQ(peer_user_in(kTable, {kLoopback, 0xC009}, kOwn), std::nullopt);
  EXPECT_EQ(peer_user_in("", {kLoopback, 1}, kOwn), std::nullopt);
  EXPECT_EQ(peer_user_in("0: x y 01 z w v u\n", {kLoopback, 1}, kOwn), std::nullopt);
}

}  // namespace
}  // namespace manoscope::serve

#pragma once

#include <cstdint>
#include <optional>
#include <string_view>

namespace manoscope::serve {

/// One end of a connection over IPv4.
struct ConnectionEnd {
  std::uint32_t address = 0;  ///< 0x7F000001 is 127.0.0.1
  std::uint16_t port = 0;
};

/// The user whose program holds the other end of a connection of this machine with itself.
///
/// Other users of this machine can reach the port, and can see the address that a browser was
/// started with: token and cookie are for this user alone.
/// @param peer  the end that the program in question holds, `own` the one that it is connected to.
/// @return nullopt where the system does not tell, or the other end was closed.
std::optional<unsigned> peer_user(const ConnectionEnd& peer, const ConnectionEnd& own);

/// The same off the text of /proc/net/tcp or tcp6.
std::optional<unsigned> peer_user_in(std::string_view table, const ConnectionEnd& peer,
                                     const ConnectionEnd& own);

}  // namespace manoscope::serve

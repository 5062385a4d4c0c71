#pragma once

#include <cstdint>
#include <optional>
#include <string_view>

namespace manoscope::serve {

/// The user whose program holds the other end of a connection over the loopback interface.
///
/// Other users of this machine can reach the port, and can see the address that a browser was
/// started with: the token in it is for this user alone.
/// @return nullopt where the system does not tell.
std::optional<unsigned> peer_user(std::uint16_t peer_port, std::uint16_t own_port);

/// The same off the text of /proc/net/tcp or tcp6.
std::optional<unsigned> peer_user_in(std::string_view table, std::uint16_t peer_port,
                                     std::uint16_t own_port);

}  // namespace manoscope::serve

#include "manoscope/serve/peer_user.hpp"

#include <arpa/inet.h>
#include <fmt/format.h>

#include <fstream>
#include <iterator>
#include <sstream>
#include <string>

namespace manoscope::serve {
namespace {

/// "0100007F:1F90": the kernel prints the bytes of the network as a number of this machine.
std::string written(const ConnectionEnd& end) {
  return fmt::format("{:08X}:{:04X}", htonl(end.address), end.port);
}

/// The same among addresses of IPv6, ::ffff:127.0.0.1.
std::string written_as_v6(const ConnectionEnd& end) {
  constexpr std::uint32_t kMapped = 0xFFFF;
  return fmt::format("{:016X}{:08X}{}", 0, htonl(kMapped), written(end));
}

}  // namespace

std::optional<unsigned> peer_user_in(std::string_view table, const ConnectionEnd& peer,
                                     const ConnectionEnd& own) {
  constexpr const char* kEstablished = "01";
  std::istringstream lines{std::string(table)};
  for (std::string line; std::getline(lines, line);) {
    std::istringstream words(line);
    std::string number, local, remote, state, queues, timer, retransmits, timeout;
    unsigned user = 0;
    std::uint64_t inode = 0;
    if (!(words >> number >> local >> remote >> state >> queues >> timer >> retransmits >> user >>
          timeout >> inode)) {
      continue;  // the head
    }
    // An end that its program has closed is told as root's, without an inode.
    if (state != kEstablished || inode == 0) continue;
    if ((local == written(peer) && remote == written(own)) ||
        (local == written_as_v6(peer) && remote == written_as_v6(own))) {
      return user;
    }
  }
  return std::nullopt;
}

std::optional<unsigned> peer_user(const ConnectionEnd& peer, const ConnectionEnd& own) {
  for (const char* path : {"/proc/net/tcp", "/proc/net/tcp6"}) {
    std::ifstream file(path);
    const std::string table{std::istreambuf_iterator<char>(file), std::istreambuf_iterator<char>()};
    if (const auto user = peer_user_in(table, peer, own)) return user;
  }
  return std::nullopt;
}

}  // namespace manoscope::serve

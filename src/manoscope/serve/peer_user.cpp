#include "manoscope/serve/peer_user.hpp"

#include <charconv>
#include <fstream>
#include <iterator>
#include <sstream>
#include <string>

namespace manoscope::serve {
namespace {

/// The port of "0100007F:1F90".
std::optional<unsigned> port_of(const std::string& address) {
  const auto colon = address.rfind(':');
  unsigned port = 0;
  const char* end = address.data() + address.size();
  if (colon == std::string::npos) return std::nullopt;
  const auto [at, error] = std::from_chars(address.data() + colon + 1, end, port, 16);
  return error == std::errc() && at == end ? std::optional(port) : std::nullopt;
}

}  // namespace

std::optional<unsigned> peer_user_in(std::string_view table, std::uint16_t peer_port,
                                     std::uint16_t own_port) {
  std::istringstream lines{std::string(table)};
  for (std::string line; std::getline(lines, line);) {
    std::istringstream words(line);
    std::string number, local, remote, state, queues, timer, retransmits;
    unsigned user = 0;
    if (!(words >> number >> local >> remote >> state >> queues >> timer >> retransmits >> user)) {
      continue;  // the head
    }
    if (port_of(local) == peer_port && port_of(remote) == own_port) return user;
  }
  return std::nullopt;
}

std::optional<unsigned> peer_user(std::uint16_t peer_port, std::uint16_t own_port) {
  for (const char* path : {"/proc/net/tcp", "/proc/net/tcp6"}) {
    std::ifstream file(path);
    const std::string table{std::istreambuf_iterator<char>(file), std::istreambuf_iterator<char>()};
    if (const auto user = peer_user_in(table, peer_port, own_port)) return user;
  }
  return std::nullopt;
}

}  // namespace manoscope::serve

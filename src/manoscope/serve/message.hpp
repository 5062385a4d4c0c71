#pragma once

#include <cstdint>
#include <string>
#include <utility>
#include <vector>

#include "manoscope/serve/address.hpp"
#include "manoscope/serve/descriptor.hpp"

namespace manoscope::serve {

enum class Method { get, put, post, del, other };

/// A request that passed the guard, its body read.
struct Request {
  Method method = Method::other;
  Address address;
  std::string if_match, if_none_match;  ///< as sent, "" if not
  std::string body;
};

/// An answer; what every answer carries besides is added when it is sent.
struct Reply {
  unsigned status = 200;
  std::string type;
  std::string body;
  std::vector<std::pair<std::string, std::string>> headers;
  Descriptor file;  ///< if open, its `file_size` bytes are the body
  std::uint64_t file_size = 0;
};

/// What a client may take of the server. The times are those between a request's bytes: no one can
/// hold a connection by sending slowly.
struct Limits {
  std::uint32_t header_bytes = 16 << 10;
  std::uint64_t json_bytes = 4 << 20;
  std::uint64_t upload_bytes = std::uint64_t{2} << 30;
  double header_seconds = 10.0;  ///< for a whole header
  double idle_seconds = 60.0;    ///< between two requests, and between two bytes of a body
  double linger_seconds = 1.0;   ///< for a client to read why it was refused
  int connections = 64;
  int event_streams = 16;
};

}  // namespace manoscope::serve

#pragma once

#include <cstdint>
#include <functional>
#include <optional>
#include <string>
#include <vector>

#include "manoscope/serve/routes.hpp"

namespace manoscope::serve {

/// The head of a request as it was sent. A field that may be sent once has all its values here.
struct Head {
  Method method = Method::other;
  bool http11 = true;
  bool upgrades = false;  ///< asks for a WebSocket
  std::string target;
  std::vector<std::string> host, origin, cookie, content_length, transfer_encoding, content_type;
  std::string fetch_site;  ///< Sec-Fetch-Site
  /// Whose program sent it, where the system tells. It costs a look at every connection of the
  /// machine: asked of nobody but who knows the token or the cookie.
  std::function<std::optional<unsigned>()> peer_user;
};

/// Why a request goes no further.
struct Refusal {
  unsigned status = 400;
  std::string found, mend;
};

/// What the guard decided: a refusal, or where the request goes.
struct Admission {
  std::optional<Refusal> refusal;
  Address address;
  Route route;
  bool enters = false;  ///< with a token that is good: the cookie is to be set
};

/// Decides which requests go further. It knows no sockets.
///
/// A browser runs pages of many masters, and each of them can send requests here. Told apart they
/// are by the Host (a foreign name that was made to point here), the Origin (a foreign page that
/// writes), and a cookie that only a page of this server sends. It is given out once, for the token
/// in the address that was printed, to a program of the same user. A browser shows its cookie to
/// every port of this machine, other users' too: it holds for the same user alone.
class Guard {
 public:
  Guard(std::uint16_t port, Limits limits);

  Admission admit(const Head& head);

  /// The value of Set-Cookie.
  std::string cookie() const;
  const std::string& token() const { return token_; }

 private:
  std::optional<Refusal> check_form(const Head& head) const;
  std::optional<Refusal> check_body(const Head& head, const Route& route) const;
  std::optional<Refusal> check_sender(const Head& head, const Route& route) const;
  bool is_known(const Head& head) const;
  static bool is_ours(const Head& head);
  bool enters(const Head& head, const std::string& token) const;

  std::uint16_t port_;
  Limits limits_;
  std::string token_, key_;
  bool token_used_ = false;
};

}  // namespace manoscope::serve

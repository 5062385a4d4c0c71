#include "manoscope/serve/guard.hpp"

#include <fmt/format.h>
#include <unistd.h>

#include <algorithm>
#include <charconv>

#include "manoscope/serve/secret.hpp"

namespace manoscope::serve {
namespace {

std::string lower(std::string text) {
  for (char& letter : text) {
    if (letter >= 'A' && letter <= 'Z') letter = static_cast<char>(letter - 'A' + 'a');
  }
  return text;
}

std::string_view trim(std::string_view text) {
  const auto first = text.find_first_not_of(" \t");
  if (first == std::string_view::npos) return {};
  return text.substr(first, text.find_last_not_of(" \t") - first + 1);
}

std::optional<std::uint64_t> whole_number(std::string_view text) {
  std::uint64_t number = 0;
  const char* end = text.data() + text.size();
  const auto [at, error] = std::from_chars(text.data(), end, number);
  return error == std::errc() && at == end ? std::optional(number) : std::nullopt;
}

/// The value of one cookie among those of a header.
std::optional<std::string_view> cookie_value(std::string_view header, std::string_view name) {
  while (!header.empty()) {
    const auto end = std::min(header.find(';'), header.size());
    const std::string_view pair = trim(header.substr(0, end));
    header.remove_prefix(std::min(end + 1, header.size()));
    if (pair.starts_with(name) && pair.substr(name.size()).starts_with('=')) {
      return pair.substr(name.size() + 1);
    }
  }
  return std::nullopt;
}

std::string cookie_name(std::uint16_t port) { return fmt::format("manoscope-{}", port); }

}  // namespace

Guard::Guard(std::uint16_t port, Limits limits)
    : port_(port), limits_(limits), token_(new_secret()), key_(new_secret()) {}

std::string Guard::cookie() const {
  return fmt::format("{}={}; Path=/; HttpOnly; SameSite=Strict", cookie_name(port_), key_);
}

bool Guard::is_known(const Head& head) const {
  if (head.cookie.size() != 1) return false;
  const auto value = cookie_value(head.cookie[0], cookie_name(port_));
  return value && same_secret(*value, key_);
}

/// Whether a program of this user sent it, or of root, who may do all this user may and who hands
/// over what the browser of a Windows around this Linux asks for. Not where the system does not
/// tell.
bool Guard::is_ours(const Head& head) {
  constexpr uid_t kRoot = 0;
  const auto user = head.peer_user ? head.peer_user() : std::nullopt;
  return user == ::geteuid() || user == kRoot;
}

bool Guard::enters(const Head& head, const std::string& token) const {
  return (is_known(head) || (!token_used_ && same_secret(token, token_))) && is_ours(head);
}

std::optional<Refusal> Guard::check_form(const Head& head) const {
  if (!head.http11) return Refusal{505, "a request in another version of HTTP", "Use HTTP/1.1"};
  if (head.host.size() != 1 || head.origin.size() > 1 || head.cookie.size() > 1 ||
      head.content_length.size() > 1 || head.transfer_encoding.size() > 1 ||
      head.content_type.size() > 1) {
    return Refusal{400, "a field of the header that belongs there once", "Send it once"};
  }
  const bool chunked = !head.transfer_encoding.empty();
  if (chunked && (!head.content_length.empty() ||
                  lower(std::string(trim(head.transfer_encoding[0]))) != "chunked")) {
    return Refusal{400, "a body whose end is told in two ways, or in an unknown one",
                   "Send Content-Length, or Transfer-Encoding: chunked"};
  }
  if (!head.content_length.empty() && !whole_number(head.content_length[0])) {
    return Refusal{400, "a Content-Length that is no length", "Send the number of bytes"};
  }
  const std::string& host = head.host[0];
  if (host != fmt::format("127.0.0.1:{}", port_) && host != fmt::format("localhost:{}", port_)) {
    return Refusal{421, "a request for another host",
                   fmt::format("Use the address that was printed: http://127.0.0.1:{}/", port_)};
  }
  return std::nullopt;
}

std::optional<Refusal> Guard::check_sender(const Head& head, const Route& route) const {
  if (!head.fetch_site.empty() && head.fetch_site != "same-origin" && head.fetch_site != "none") {
    return Refusal{403, "a request from another page", "Use the page of this program"};
  }
  if (!is_known(head)) {
    return Refusal{401, "this browser has not been let in",
                   "Open the address that `manoscope serve` printed; start it again for a new one"};
  }
  if (!is_ours(head)) {
    return Refusal{403, "a request from a program of another user, or of one that is not told",
                   "Use a browser of the user who started `manoscope serve`, on this machine"};
  }
  const bool writes = route.method != Method::get || route.task == Task::events;
  if (writes && (head.origin.size() != 1 || head.origin[0] != "http://" + head.host[0])) {
    return Refusal{403, "a request from another page", "Use the page of this program"};
  }
  return std::nullopt;
}

std::optional<Refusal> Guard::check_body(const Head& head, const Route& route) const {
  const std::uint64_t length =
      head.content_length.empty() ? 0 : *whole_number(head.content_length[0]);
  if (route.task == Task::events) {
    if (!head.upgrades) return Refusal{426, "this address is a WebSocket", "Open it as one"};
  } else if (head.upgrades) {
    return Refusal{400, "a WebSocket is asked for where there is none", "Use /api/events"};
  }
  if (route.body == Body::none) {
    if (length == 0 && head.transfer_encoding.empty()) return std::nullopt;
    return Refusal{400, "a body where none belongs", "Send none"};
  }
  const std::uint64_t most = route.body == Body::json ? limits_.json_bytes : limits_.upload_bytes;
  if (length > most) {
    return Refusal{413, fmt::format("a body of {} bytes", length),
                   fmt::format("Send {} bytes at most", most)};
  }
  if (route.body == Body::json) {
    const std::string type = head.content_type.empty() ? "" : lower(head.content_type[0]);
    if (trim(std::string_view(type).substr(0, type.find(';'))) != "application/json") {
      return Refusal{415, "a body that is not called JSON", "Send Content-Type: application/json"};
    }
  }
  return std::nullopt;
}

Admission Guard::admit(const Head& head) {
  Admission admission;
  admission.refusal = check_form(head);
  if (admission.refusal) return admission;
  auto address = parse_address(head.target);
  if (!address) {
    admission.refusal = Refusal{400, "an address that names nothing", "Look at its spelling"};
    return admission;
  }
  admission.address = std::move(*address);
  const Found found = find_route(head.method, admission.address.parts);
  const auto token = admission.address.value("token");
  if (token && found.route && found.route->task == Task::page) {
    admission.route = *found.route;
    admission.enters = enters(head, *token);
    token_used_ = token_used_ || admission.enters;
    if (!admission.enters) {
      admission.refusal = Refusal{403, "this address has been used, or is another user's",
                                  "Start `manoscope serve` again for a new one"};
    }
    return admission;
  }
  admission.refusal = check_sender(head, found.route.value_or(Route{.method = head.method}));
  if (admission.refusal) return admission;
  if (!found.route) {
    admission.refusal =
        found.status == 405
            ? Refusal{405, "this cannot be done with that address", "See the manual"}
            : Refusal{404, "there is nothing of that address", "Look at its spelling"};
    return admission;
  }
  admission.route = *found.route;
  admission.refusal = check_body(head, admission.route);
  return admission;
}

}  // namespace manoscope::serve

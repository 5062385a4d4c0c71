#include "manoscope/serve/http_head.hpp"

#include <boost/beast/http/error.hpp>

namespace manoscope::serve {
namespace {

namespace http = boost::beast::http;
using boost::system::error_code;

Method method_of(http::verb verb) {
  switch (verb) {
    case http::verb::get:
      return Method::get;
    case http::verb::put:
      return Method::put;
    case http::verb::post:
      return Method::post;
    case http::verb::delete_:
      return Method::del;
    default:
      return Method::other;
  }
}

std::vector<std::string> every(const HttpRequest& request, const char* name) {
  std::vector<std::string> values;
  const auto [first, last] = request.equal_range(name);
  for (auto it = first; it != last; ++it) values.emplace_back(it->value());
  return values;
}

}  // namespace

std::string first_field(const HttpRequest& request, const char* name) {
  const auto found = request.find(name);
  return found == request.end() ? std::string() : std::string(found->value());
}

Head head_of(const HttpRequest& request) {
  Head head;
  head.method = method_of(request.method());
  head.http11 = request.version() == 11;
  head.target = std::string(request.target());
  head.host = every(request, "Host");
  head.origin = every(request, "Origin");
  head.cookie = every(request, "Cookie");
  head.content_length = every(request, "Content-Length");
  head.transfer_encoding = every(request, "Transfer-Encoding");
  head.content_type = every(request, "Content-Type");
  head.fetch_site = first_field(request, "Sec-Fetch-Site");
  head.upgrades = !every(request, "Upgrade").empty();
  return head;
}

Refusal refusal_for(error_code error) {
  if (error == http::error::header_limit || error == http::error::buffer_overflow) {
    return {431, "a header that is too large", "Send less"};
  }
  if (error == http::error::body_limit) return {413, "a body that is too large", "Send less"};
  return {400, "this is no HTTP: " + error.message(), "Send a request as RFC 9112 says"};
}

bool is_of_http(error_code error) {
  return error.category() == http::make_error_code(http::error{}).category();
}

}  // namespace manoscope::serve

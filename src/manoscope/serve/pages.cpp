#include "manoscope/serve/pages.hpp"

#include <fmt/format.h>

#include "manoscope/serve/assets.hpp"

namespace manoscope::serve {
namespace {

constexpr const char* kNoScript =
    "default-src 'none'; base-uri 'none'; form-action 'none'; frame-ancestors 'none'";

Reply page(unsigned status, const std::string& policy, const std::string& head,
           const std::string& body) {
  Reply reply;
  reply.status = status;
  reply.type = "text/html; charset=utf-8";
  reply.body = fmt::format(
      "<!doctype html>\n<html lang=\"en\">\n<head>\n<meta charset=\"utf-8\">\n"
      "<meta name=\"viewport\" content=\"width=device-width, initial-scale=1\">\n"
      "<title>manoscope</title>\n{}</head>\n<body>\n{}</body>\n</html>\n",
      head, body);
  reply.headers.emplace_back("Content-Security-Policy", policy);
  return reply;
}

}  // namespace

Reply app_page(std::uint16_t port) {
  return page(200,
              fmt::format("default-src 'none'; script-src 'self'; style-src 'self'; "
                          "img-src 'self' data: blob:; "
                          "connect-src 'self' ws://127.0.0.1:{0} ws://localhost:{0}; "
                          "frame-src 'self'; base-uri 'none'; form-action 'none'; "
                          "frame-ancestors 'none'",
                          port),
              "<link rel=\"icon\" href=\"data:,\">\n"  // none, or a browser asks for /favicon.ico
              "<link rel=\"stylesheet\" href=\"/app.css\">\n"
              "<script src=\"/app.js\" defer></script>\n",
              "<div id=\"app\"></div>\n"
              "<noscript><p>This page needs scripts; the command line does the same without: "
              "<code>manoscope --help</code>.</p></noscript>\n");
}

Reply script_reply() {
  Reply reply;
  reply.type = "text/javascript; charset=utf-8";
  reply.body = app_script();
  return reply;
}

Reply style_reply() {
  Reply reply;
  reply.type = "text/css; charset=utf-8";
  reply.body = app_style();
  return reply;
}

Reply entrance_page(const std::string& cookie) {
  Reply reply = page(200, kNoScript, "<meta http-equiv=\"refresh\" content=\"0;url=/\">\n",
                     "<p><a href=\"/\">manoscope</a></p>\n");
  reply.headers.emplace_back("Set-Cookie", cookie);
  return reply;
}

Reply refusal_page(unsigned status, const std::string& found, const std::string& mend) {
  return page(status, kNoScript, "",
              fmt::format("<p>manoscope: {}.</p>\n<p>{}.</p>\n<p>If it is open in this browser "
                          "already: <a href=\"/\">go on</a>.</p>\n",
                          found, mend));
}

}  // namespace manoscope::serve

#include "manoscope/serve/refuse_connection.hpp"

#include <boost/asio/buffer.hpp>
#include <boost/asio/steady_timer.hpp>
#include <chrono>
#include <memory>
#include <string>

#include "manoscope/serve/shared.hpp"

namespace manoscope::serve {

namespace asio = boost::asio;
using asio::ip::tcp;
using boost::system::error_code;

void refuse_connection(tcp::socket socket, Shared& shared) {
  static const std::string kBusy =
      "HTTP/1.1 503 Service Unavailable\r\nConnection: close\r\nContent-Length: 0\r\n\r\n";
  struct Refused {
    Refused(tcp::socket connection, Shared& all)
        : socket(std::move(connection)), timer(*all.io), shared(all) {
      ++shared.n_refused;
    }
    ~Refused() { --shared.n_refused; }
    tcp::socket socket;
    asio::steady_timer timer;
    Shared& shared;
  };
  if (shared.n_refused >= 2 * shared.limits.connections) return;  // closed without a word
  auto refused = std::make_shared<Refused>(std::move(socket), shared);
  error_code ignored;
  refused->socket.non_blocking(true, ignored);
  refused->socket.write_some(asio::buffer(kBusy), ignored);
  refused->socket.shutdown(tcp::socket::shutdown_send, ignored);
  // Until the client has read it: what it sent meanwhile would reset the connection.
  refused->timer.expires_after(
      std::chrono::milliseconds(static_cast<long long>(1e3 * shared.limits.linger_seconds)));
  refused->timer.async_wait([refused](error_code) {
    error_code closed;
    refused->socket.close(closed);
  });
}

}  // namespace manoscope::serve

// A client for the tests of this folder, on plain sockets: it sends what no library would.
#pragma once

#include <arpa/inet.h>
#include <netinet/in.h>
#include <poll.h>
#include <sys/socket.h>
#include <unistd.h>

#include <atomic>
#include <cstring>
#include <fstream>
#include <sstream>
#include <stdexcept>
#include <string>
#include <string_view>
#include <thread>

#include "manoscope/serve/descriptor.hpp"
#include "manoscope/serve/server.hpp"

namespace manoscope::serve {

struct Answer {
  int status = 0;  ///< 0: the connection ended without one
  std::string head, body;

  /// The value of a field, "" if it is not there.
  std::string field(const std::string& name) const {
    const auto at = head.find("\r\n" + name + ": ");
    if (at == std::string::npos) return "";
    const auto begin = at + name.size() + 4;
    return head.substr(begin, head.find("\r\n", begin) - begin);
  }
};

/// One connection.
class Connection {
 public:
  explicit Connection(int port) : socket_(::socket(AF_INET, SOCK_STREAM | SOCK_CLOEXEC, 0)) {
    sockaddr_in address{};
    address.sin_family = AF_INET;
    address.sin_port = htons(static_cast<std::uint16_t>(port));
    address.sin_addr.s_addr = htonl(INADDR_LOOPBACK);
    if (::connect(socket_.number(), reinterpret_cast<sockaddr*>(&address), sizeof(address)) != 0) {
      throw std::runtime_error(std::string("connect: ") + std::strerror(errno));
    }
  }

  /// @return false once the server has closed.
  bool send(std::string_view bytes) {
    while (!bytes.empty()) {
      const ssize_t n = ::send(socket_.number(), bytes.data(), bytes.size(), MSG_NOSIGNAL);
      if (n <= 0) return false;
      bytes.remove_prefix(static_cast<std::size_t>(n));
    }
    return true;
  }
  /// What comes within the time, at most `size` bytes; "" at the end.
  std::string receive(std::size_t size, int milliseconds = 20000) {
    pollfd waiting{socket_.number(), POLLIN, 0};
    if (::poll(&waiting, 1, milliseconds) <= 0) return "";
    std::string bytes(size, '\0');
    const ssize_t n = ::recv(socket_.number(), bytes.data(), size, 0);
    bytes.resize(n > 0 ? static_cast<std::size_t>(n) : 0);
    return bytes;
  }
  /// One answer; the connection stays.
  Answer answer(int milliseconds = 20000) {
    Answer answer;
    std::size_t end = std::string::npos;
    while ((end = read_.find("\r\n\r\n")) == std::string::npos) {
      const std::string more = receive(1 << 16, milliseconds);
      if (more.empty()) return answer;
      read_ += more;
    }
    answer.head = read_.substr(0, end + 2);
    read_.erase(0, end + 4);
    answer.status = std::stoi(answer.head.substr(9, 3));
    const std::string length = answer.field("Content-Length");
    const std::size_t size = length.empty() ? 0 : std::stoul(length);
    while (read_.size() < size) {
      const std::string more = receive(1 << 16, milliseconds);
      if (more.empty()) break;
      read_ += more;
    }
    answer.body = read_.substr(0, size);
    read_.erase(0, size);
    return answer;
  }
  /// Whether the server closes within the time, and says nothing before.
  bool is_closed(int milliseconds = 20000) {
    pollfd waiting{socket_.number(), POLLIN, 0};
    if (!read_.empty() || ::poll(&waiting, 1, milliseconds) <= 0) return false;
    char byte = 0;
    return ::recv(socket_.number(), &byte, 1, 0) <= 0;
  }

 private:
  Descriptor socket_;
  std::string read_;
};

/// A server that runs beside the test, and what a browser that was let in sends.
class TestServer {
 public:
  explicit TestServer(const ServerOptions& options)
      : server_(options), thread_([this] {
          Monitor monitor;
          monitor.stop_requested = [this] { return stop_.load(); };
          server_.run(monitor);
        }) {
    cookie = enter();
  }
  ~TestServer() {
    stop_ = true;
    thread_.join();
  }

  int port() const { return server_.port(); }
  std::string host() const { return "127.0.0.1:" + std::to_string(port()); }
  std::string url() const { return server_.url(); }
  std::string head(const std::string& method, const std::string& target) const {
    return method + " " + target + " HTTP/1.1\r\nHost: " + host() + "\r\nCookie: " + cookie +
           "\r\nOrigin: http://" + host() + "\r\n";
  }
  std::string request(const std::string& method, const std::string& target,
                      const std::string& body = "", const std::string& fields = "") const {
    std::string text = head(method, target) + fields;
    if (!body.empty()) {
      text += "Content-Type: application/json\r\nContent-Length: " + std::to_string(body.size()) +
              "\r\n";
    }
    return text + "\r\n" + body;
  }
  Answer ask(const std::string& method, const std::string& target, const std::string& body = "",
             const std::string& fields = "") const {
    return send(request(method, target, body, fields));
  }
  Answer send(const std::string& bytes) const {
    Connection connection(port());
    connection.send(bytes);
    return connection.answer();
  }

  std::string cookie;

 private:
  std::string enter() const {
    const std::string target = server_.url().substr(server_.url().find("/?"));
    const Answer answer = send("GET " + target + " HTTP/1.1\r\nHost: " + host() + "\r\n\r\n");
    const std::string value = answer.field("Set-Cookie");
    return value.substr(0, value.find(';'));
  }

  Server server_;
  std::atomic<bool> stop_{false};
  std::thread thread_;
};

/// Resident memory of this process, MB; 0 under the address sanitizer, which keeps what is freed.
inline double resident_megabytes() {
#ifdef __SANITIZE_ADDRESS__
  return 0.0;
#else
  std::ifstream file("/proc/self/statm");
  double size = 0.0, resident = 0.0;
  file >> size >> resident;
  return resident * static_cast<double>(::sysconf(_SC_PAGESIZE)) / 1e6;
#endif
}

}  // namespace manoscope::serve

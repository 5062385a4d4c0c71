#pragma once

#include <cstdint>
#include <filesystem>
#include <memory>
#include <string>

#include "manoscope/core/monitor.hpp"
#include "manoscope/serve/message.hpp"

namespace manoscope::serve {

struct ServerOptions {
  std::filesystem::path folder = ".";
  int port = 0;         ///< 0: any that is free
  std::string program;  ///< path of this program, which measures
  Limits limits;
};

/// The server of one folder, on the loopback interface alone.
class Server {
 public:
  /// @throws InputError if the folder cannot be served or the port is taken.
  explicit Server(const ServerOptions& options);
  /// Ends what is measured.
  ~Server();
  Server(const Server&) = delete;
  Server& operator=(const Server&) = delete;

  std::uint16_t port() const;
  /// The address that lets one browser in, once.
  std::string url() const;
  /// Serves until the monitor asks to stop.
  void run(const Monitor& monitor);

 private:
  struct Impl;
  std::unique_ptr<Impl> impl_;
};

}  // namespace manoscope::serve

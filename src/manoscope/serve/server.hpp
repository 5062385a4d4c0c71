#pragma once

#include <cstdint>
#include <filesystem>
#include <memory>
#include <optional>
#include <string>

#include "manoscope/core/monitor.hpp"
#include "manoscope/serve/message.hpp"

namespace manoscope::serve {

struct ServerOptions {
  std::filesystem::path folder = ".";
  /// 0: any that is free. None: port_of_folder(), or any if that is taken.
  std::optional<int> port;
  std::string program;  ///< path of this program, which measures
  Limits limits;
};

/// A port of the folder's own, the same at every start: what a browser keeps for the page, it keeps
/// by its port. Above those that Linux gives to clients, 61000 to 65535.
int port_of_folder(const std::filesystem::path& folder);

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

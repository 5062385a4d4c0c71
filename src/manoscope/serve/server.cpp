#include "manoscope/serve/server.hpp"

#include <fcntl.h>
#include <fmt/format.h>

#include <boost/asio/ip/tcp.hpp>
#include <boost/asio/post.hpp>
#include <boost/asio/steady_timer.hpp>
#include <chrono>
#include <nlohmann/json.hpp>

#include "manoscope/core/error.hpp"
#include "manoscope/core/provenance.hpp"
#include "manoscope/serve/refuse_connection.hpp"
#include "manoscope/serve/session.hpp"
#include "manoscope/serve/shared.hpp"

namespace manoscope::serve {
namespace {

namespace asio = boost::asio;
using asio::ip::tcp;
using boost::system::error_code;

constexpr auto kTick = std::chrono::milliseconds(100);
constexpr int kTicksBetweenScans = 10;
constexpr int kQuickThreads = 2, kHeavyThreads = 1, kDiskThreads = 2;

}  // namespace

struct Server::Impl {
  // In this order: a connection that is left in `io` counts itself out of `shared` when it goes.
  Shared shared;
  asio::io_context io{1};
  tcp::acceptor acceptor{io};
  asio::steady_timer ticks{io}, pause{io};
  asio::thread_pool quick{kQuickThreads}, heavy{kHeavyThreads}, disk{kDiskThreads};
  std::unique_ptr<App> app;
  std::unique_ptr<Guard> guard;
  Monitor monitor;
  int n_ticks = 0;
  bool scans = false;

  error_code try_to_listen(int port) {
    const tcp::endpoint endpoint(asio::ip::address_v4::loopback(),
                                 static_cast<unsigned short>(port));
    error_code error, ignored;
    acceptor.close(ignored);
    acceptor.open(endpoint.protocol(), error);
    if (!error) ::fcntl(acceptor.native_handle(), F_SETFD, FD_CLOEXEC);
    if (!error) acceptor.set_option(tcp::acceptor::reuse_address(true), error);
    if (!error) acceptor.bind(endpoint, error);
    if (!error) acceptor.listen(asio::socket_base::max_listen_connections, error);
    return error;
  }

  void listen(const std::filesystem::path& folder, std::optional<int> wanted) {
    const int port = wanted.value_or(port_of_folder(folder));
    error_code error = try_to_listen(port);
    if (error && !wanted) error = try_to_listen(0);
    if (error) {
      throw InputError(fmt::format("port {}", port), "cannot be listened at: " + error.message(),
                       "Leave out --port for one that is free, or name another");
    }
    shared.port = acceptor.local_endpoint().port();
  }

  void accept() {
    acceptor.async_accept([this](error_code error, tcp::socket socket) {
      if (error == asio::error::operation_aborted) return;
      if (error) {
        // No descriptors are left: some connection will end.
        pause.expires_after(kTick);
        pause.async_wait([this](error_code) { accept(); });
        return;
      }
      ::fcntl(socket.native_handle(), F_SETFD, FD_CLOEXEC);
      error_code ignored;
      socket.set_option(tcp::no_delay(true), ignored);
      if (shared.n_connections < shared.limits.connections) {
        start_session(std::move(socket), shared);
      } else {
        refuse_connection(std::move(socket), shared);
      }
      accept();
    });
  }

  void tick() {
    ticks.expires_after(kTick);
    ticks.async_wait([this](error_code error) {
      if (error) return;
      if (monitor.stop_requested && monitor.stop_requested()) return io.stop();
      if (++n_ticks % kTicksBetweenScans == 0 && shared.listeners.size() > 0 && !scans) look();
      tick();
    });
  }

  /// Whether files changed, on a pool; never two at a time.
  void look() {
    scans = true;
    asio::post(quick, [this] {
      const std::string event = app->file_event();
      asio::post(io, [this, event] {
        scans = false;
        if (!event.empty()) shared.listeners.tell(event);
      });
    });
  }
};

int port_of_folder(const std::filesystem::path& folder) {
  constexpr unsigned kFirst = 61000, kLast = 65535;
  constexpr std::size_t kDigits = 8;
  std::error_code error;
  const std::string path = std::filesystem::weakly_canonical(folder, error).string();
  const auto number = std::stoul(sha256(path).substr(0, kDigits), nullptr, 16);
  return static_cast<int>(kFirst + number % (kLast - kFirst + 1));
}

Server::Server(const ServerOptions& options) : impl_(std::make_unique<Impl>()) {
  Impl& impl = *impl_;
  const auto publish = [&impl](const nlohmann::json& event) {
    std::string text = event.dump(-1, ' ', false, nlohmann::json::error_handler_t::replace);
    asio::post(impl.io, [&impl, text = std::move(text)] { impl.shared.listeners.tell(text); });
  };
  impl.app = std::make_unique<App>(options.folder, options.program, publish);
  impl.listen(options.folder, options.port);
  impl.guard = std::make_unique<Guard>(impl.shared.port, options.limits);
  impl.app->set_port(impl.shared.port);
  impl.shared.limits = options.limits;
  impl.shared.guard = impl.guard.get();
  impl.shared.app = impl.app.get();
  impl.shared.io = &impl.io;
  impl.shared.quick = &impl.quick;
  impl.shared.heavy = &impl.heavy;
  impl.shared.disk = &impl.disk;
}

Server::~Server() {
  impl_->shared.stopping = true;
  impl_->io.stop();
  // What waits in a queue is dropped; what runs is asked to stop.
  for (asio::thread_pool* pool : {&impl_->quick, &impl_->heavy, &impl_->disk}) pool->stop();
  for (asio::thread_pool* pool : {&impl_->quick, &impl_->heavy, &impl_->disk}) pool->join();
  impl_->app.reset();
}

std::uint16_t Server::port() const { return impl_->shared.port; }

std::string Server::url() const {
  return fmt::format("http://127.0.0.1:{}/?token={}", port(), impl_->guard->token());
}

void Server::run(const Monitor& monitor) {
  impl_->monitor = monitor;
  impl_->accept();
  impl_->tick();
  impl_->io.run();
}

}  // namespace manoscope::serve

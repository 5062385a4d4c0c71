#pragma once

#include <atomic>
#include <boost/asio/io_context.hpp>
#include <boost/asio/thread_pool.hpp>
#include <functional>
#include <map>
#include <memory>
#include <string>

#include "manoscope/core/monitor.hpp"
#include "manoscope/serve/app.hpp"
#include "manoscope/serve/guard.hpp"

namespace manoscope::serve {

/// Those who listen to events. Used from the thread of the sockets alone.
class Listeners {
 public:
  using Send = std::function<void(const std::shared_ptr<const std::string>&)>;

  int add(Send send) {
    listeners_.emplace(++last_, std::move(send));
    return last_;
  }
  void remove(int id) { listeners_.erase(id); }
  int size() const { return static_cast<int>(listeners_.size()); }
  void tell(std::string text) {
    const auto shared = std::make_shared<const std::string>(std::move(text));
    const auto listeners = listeners_;  // a listener that is too slow takes itself out
    for (const auto& [id, send] : listeners) send(shared);
  }

 private:
  std::map<int, Send> listeners_;
  int last_ = 0;
};

/// What every connection of a server uses. Sockets, guard and listeners belong to the one thread
/// that runs `io`; the pools do what touches the disk: `quick` answers, `heavy` reads maps, `disk`
/// takes and sends whole files.
struct Shared {
  Limits limits;
  Listeners listeners;
  int n_connections = 0, n_refused = 0;
  std::atomic<bool> stopping{false};
  std::uint16_t port = 0;
  Guard* guard = nullptr;
  App* app = nullptr;
  boost::asio::io_context* io = nullptr;
  boost::asio::thread_pool* quick = nullptr;
  boost::asio::thread_pool* heavy = nullptr;
  boost::asio::thread_pool* disk = nullptr;

  Monitor monitor() {
    Monitor monitor;
    monitor.stop_requested = [this] { return stopping.load(); };
    return monitor;
  }
};

}  // namespace manoscope::serve

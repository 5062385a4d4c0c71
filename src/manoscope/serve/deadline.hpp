#pragma once

#include <boost/asio/io_context.hpp>
#include <boost/asio/ip/tcp.hpp>
#include <boost/asio/steady_timer.hpp>
#include <chrono>
#include <memory>

namespace manoscope::serve {

/// A time for what is under way on a socket: when it is up, that is cancelled.
class Deadline {
 public:
  Deadline(boost::asio::io_context& io, boost::asio::ip::tcp::socket& socket)
      : timer_(io), socket_(&socket) {}

  /// From now on, what is under way may take so long.
  /// @param keep  holds this object as long as the time runs.
  void set(double seconds, std::shared_ptr<void> keep) {
    passed_ = false;
    timer_.expires_after(std::chrono::milliseconds(static_cast<long long>(seconds * 1e3)));
    timer_.async_wait([this, keep = std::move(keep), turn = ++turn_](auto error) {
      if (error || turn != turn_) return;
      passed_ = true;
      boost::system::error_code ignored;
      socket_->cancel(ignored);
    });
  }
  void clear() {
    ++turn_;
    timer_.cancel();
  }
  bool passed() const { return passed_; }

 private:
  boost::asio::steady_timer timer_;
  boost::asio::ip::tcp::socket* socket_;
  int turn_ = 0;
  bool passed_ = false;
};

}  // namespace manoscope::serve

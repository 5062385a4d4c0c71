#include "manoscope/serve/send_reply.hpp"

#include <unistd.h>

#include <algorithm>
#include <boost/beast/http.hpp>
#include <cerrno>
#include <memory>
#include <vector>

#include "manoscope/serve/deadline.hpp"
#include "manoscope/serve/run_on.hpp"
#include "manoscope/serve/shared.hpp"

namespace manoscope::serve {
namespace {

namespace http = boost::beast::http;
using boost::asio::ip::tcp;
using boost::system::error_code;

constexpr std::size_t kPieceBytes = std::size_t{256} << 10;

class Sending : public std::enable_shared_from_this<Sending> {
 public:
  Sending(tcp::socket& socket, Shared& shared, Reply reply, std::function<void(bool)> sent)
      : socket_(socket),
        shared_(shared),
        deadline_(*shared.io, socket),
        reply_(std::move(reply)),
        sent_(std::move(sent)) {}

  void start(bool last) {
    set_head(last);
    auto& body = message_.body();
    if (reply_.file) {
      left_ = reply_.file_size;
      message_.content_length(left_);
      body.data = nullptr;
      body.more = left_ > 0;
    } else {
      message_.content_length(reply_.body.size());
      body.data = reply_.body.empty() ? nullptr : reply_.body.data();
      body.size = reply_.body.size();
      body.more = false;
    }
    write();
  }

 private:
  void set_head(bool last) {
    const auto is_sandboxed = [](const auto& header) {
      return header.first == "Content-Security-Policy" && header.second.starts_with("sandbox");
    };
    message_.result(reply_.status);
    message_.set(http::field::content_type, reply_.type);
    message_.set("X-Content-Type-Options", "nosniff");
    message_.set("Referrer-Policy", "no-referrer");
    message_.set("Cache-Control", "no-store");
    // By the HTML standard a page with both a sandbox and an opener policy is a network error in a
    // tab (Chromium shows it all the same); a sandboxed page has an origin of its own anyway.
    if (std::none_of(reply_.headers.begin(), reply_.headers.end(), is_sandboxed)) {
      message_.set("Cross-Origin-Opener-Policy", "same-origin");
    }
    message_.set("Cross-Origin-Resource-Policy", "same-origin");
    message_.set("Content-Security-Policy", "default-src 'none'; frame-ancestors 'none'");
    for (const auto& [name, value] : reply_.headers) message_.set(name, value);
    message_.keep_alive(!last);
  }

  void write() {
    deadline_.set(shared_.limits.idle_seconds, shared_from_this());
    http::async_write_some(socket_, serializer_,
                           [self = shared_from_this()](error_code error, std::size_t) {
                             self->deadline_.clear();
                             self->wrote(error);
                           });
  }
  void wrote(error_code error) {
    if (error == http::error::need_buffer) return read();
    if (error) return end(false);
    if (serializer_.is_done()) return end(true);
    write();
  }

  /// The next piece of the file.
  void read() {
    run_on(
        *shared_.disk, *shared_.io, shared_from_this(), [this] { read_piece(); },
        [this](const std::exception_ptr& failure) {
          if (failure || n_read_ == 0) return end(false);  // the file has become shorter
          auto& body = message_.body();
          body.data = piece_.data();
          body.size = n_read_;
          left_ -= n_read_;
          body.more = left_ > 0;
          write();
        });
  }
  void read_piece() {
    piece_.resize(kPieceBytes);
    const auto most = static_cast<std::size_t>(std::min<std::uint64_t>(left_, piece_.size()));
    ssize_t n = 0;
    do {
      n = ::read(reply_.file.number(), piece_.data(), most);
    } while (n < 0 && errno == EINTR);
    n_read_ = n > 0 ? static_cast<std::size_t>(n) : 0;
  }

  void end(bool whole) {
    if (sent_) std::exchange(sent_, nullptr)(whole);
  }

  tcp::socket& socket_;
  Shared& shared_;
  Deadline deadline_;
  Reply reply_;
  std::function<void(bool)> sent_;
  http::response<http::buffer_body> message_;
  http::response_serializer<http::buffer_body> serializer_{message_};
  std::vector<char> piece_;
  std::uint64_t left_ = 0;
  std::size_t n_read_ = 0;
};

}  // namespace

void send_reply(tcp::socket& socket, Shared& shared, Reply reply, bool last,
                std::function<void(bool whole)> sent) {
  std::make_shared<Sending>(socket, shared, std::move(reply), std::move(sent))->start(last);
}

}  // namespace manoscope::serve

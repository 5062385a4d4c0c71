#include "manoscope/serve/event_stream.hpp"

#include <boost/asio/post.hpp>
#include <boost/beast/core/flat_buffer.hpp>
#include <boost/beast/websocket/stream.hpp>
#include <deque>

#include "manoscope/serve/shared.hpp"

namespace manoscope::serve {
namespace {

namespace asio = boost::asio;
namespace http = boost::beast::http;
namespace websocket = boost::beast::websocket;
using asio::ip::tcp;
using boost::system::error_code;

constexpr std::size_t kMostWaiting = 2000;  // events that a page may lag behind
constexpr std::size_t kMostRead = 4096;     // bytes of a message that nobody reads

class EventStream : public std::enable_shared_from_this<EventStream> {
 public:
  EventStream(tcp::socket socket, http::request<http::empty_body> request, Shared& shared)
      : stream_(std::move(socket)), request_(std::move(request)), shared_(shared) {
    ++shared_.n_connections;
  }
  ~EventStream() { --shared_.n_connections; }
  EventStream(const EventStream&) = delete;
  EventStream& operator=(const EventStream&) = delete;

  void start() {
    stream_.set_option(websocket::stream_base::timeout::suggested(boost::beast::role_type::server));
    stream_.read_message_max(kMostRead);
    stream_.async_accept(request_, [self = shared_from_this()](error_code error) {
      if (!error) self->begin();
    });
  }

 private:
  void begin() {
    id_ = shared_.listeners.add([weak = weak_from_this()](const auto& text) {
      if (const auto self = weak.lock()) self->send(text);
    });
    // What is running now, asked for on a pool as it may wait for a lock. It gets in line with the
    // events of the job, and takes the pool's hold of this object with it.
    asio::post(*shared_.quick, [self = shared_from_this()]() mutable {
      Shared& shared = self->shared_;
      shared.app->greet([&](std::string words) {
        auto text = std::make_shared<const std::string>(std::move(words));
        asio::post(*shared.io, [self = std::move(self), text] { self->send(text); });
      });
    });
    read();
  }
  /// What a page sends is dropped; reading is how its end is noticed.
  void read() {
    stream_.async_read(buffer_, [self = shared_from_this()](error_code error, std::size_t) {
      self->buffer_.clear();
      if (error) return self->end();
      self->read();
    });
  }
  void send(const std::shared_ptr<const std::string>& text) {
    if (id_ == 0) return;
    if (waiting_.size() >= kMostWaiting) return end();
    waiting_.push_back(text);
    if (waiting_.size() == 1) write();
  }
  void write() {
    stream_.text(true);
    stream_.async_write(asio::buffer(*waiting_.front()),
                        [self = shared_from_this()](error_code error, std::size_t) {
                          if (error) return self->end();
                          self->waiting_.pop_front();
                          if (!self->waiting_.empty()) self->write();
                        });
  }
  void end() {
    if (id_ != 0) shared_.listeners.remove(id_);
    id_ = 0;
    error_code ignored;
    stream_.next_layer().close(ignored);
  }

  websocket::stream<tcp::socket, false> stream_;
  http::request<http::empty_body> request_;
  Shared& shared_;
  boost::beast::flat_buffer buffer_;
  std::deque<std::shared_ptr<const std::string>> waiting_;
  int id_ = 0;
};

}  // namespace

void start_event_stream(tcp::socket socket, http::request<http::empty_body> request,
                        Shared& shared) {
  std::make_shared<EventStream>(std::move(socket), std::move(request), shared)->start();
}

}  // namespace manoscope::serve

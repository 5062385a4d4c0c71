#include "manoscope/serve/session.hpp"

#include <boost/asio/write.hpp>
#include <boost/beast/core/flat_buffer.hpp>
#include <boost/beast/http.hpp>
#include <limits>
#include <optional>
#include <utility>
#include <vector>

#include "manoscope/serve/deadline.hpp"
#include "manoscope/serve/event_stream.hpp"
#include "manoscope/serve/http_head.hpp"
#include "manoscope/serve/json.hpp"
#include "manoscope/serve/pages.hpp"
#include "manoscope/serve/peer_user.hpp"
#include "manoscope/serve/run_on.hpp"
#include "manoscope/serve/send_reply.hpp"
#include "manoscope/serve/shared.hpp"

namespace manoscope::serve {
namespace {

namespace asio = boost::asio;
namespace http = boost::beast::http;
using asio::ip::tcp;
using boost::system::error_code;

ConnectionEnd end_of(const tcp::endpoint& end) {
  return {end.address().to_v4().to_uint(), end.port()};
}

Reply reply_to(const std::exception_ptr& failure) {
  try {
    std::rethrow_exception(failure);
  } catch (...) {
    return reply_to_exception();
  }
}

class Session : public std::enable_shared_from_this<Session> {
 public:
  Session(tcp::socket socket, Shared& shared)
      : socket_(std::move(socket)),
        shared_(shared),
        deadline_(*shared.io, socket_),
        buffer_(2 * std::size_t{shared.limits.header_bytes}) {
    ++shared_.n_connections;
  }
  ~Session() { --shared_.n_connections; }
  Session(const Session&) = delete;
  Session& operator=(const Session&) = delete;

  void start() { read_header(); }

 private:
  using Parser = http::request_parser<http::buffer_body>;

  void limit(double seconds) { deadline_.set(seconds, shared_from_this()); }
  void unlimit() { deadline_.clear(); }
  void close() {
    unlimit();
    error_code ignored;
    socket_.close(ignored);
  }

  void wait_for_request() {
    if (buffer_.size() > 0) return read_header();  // sent ahead
    limit(shared_.limits.idle_seconds);
    socket_.async_wait(tcp::socket::wait_read, [self = shared_from_this()](error_code error) {
      self->unlimit();
      if (error) return self->close();
      self->read_header();
    });
  }

  void read_header() {
    parser_.emplace();
    parser_->header_limit(shared_.limits.header_bytes);
    // It depends on where the request goes; without any, Boost 1.74 refuses every length.
    parser_->body_limit(std::numeric_limits<std::uint64_t>::max());
    limit(shared_.limits.header_seconds);
    http::async_read_header(socket_, buffer_, *parser_,
                            [self = shared_from_this()](error_code error, std::size_t) {
                              self->unlimit();
                              self->take_header(error);
                            });
  }

  void take_header(error_code error) {
    if (deadline_.passed()) {
      const bool began = parser_->got_some() || buffer_.size() > 0;
      if (!began) return close();
      return refuse({408, "a header that does not end", "Send it at once"});
    }
    if (error == http::error::end_of_stream || error == http::error::partial_message ||
        (error && !is_of_http(error))) {
      return close();
    }
    if (error) return refuse(refusal_for(error));
    Head head = head_of(parser_->get());
    head.peer_user = [this] { return user_of_peer(); };
    admission_ = shared_.guard->admit(head);
    if (admission_.refusal) return refuse(*admission_.refusal);
    if (admission_.enters) return enter();
    if (admission_.route.task == Task::events) return listen();
    request_ = Request{};
    request_.method = head.method;
    request_.address = admission_.address;
    request_.if_match = first_field(parser_->get(), "If-Match");
    request_.if_none_match = first_field(parser_->get(), "If-None-Match");
    total_ = 0;
    most_ = admission_.route.body == Body::json ? shared_.limits.json_bytes
                                                : shared_.limits.upload_bytes;
    parser_->body_limit(most_);
    if (admission_.route.body == Body::upload) return begin_upload();
    read_body();
  }

  /// Asked of the system once in a connection.
  std::optional<unsigned> user_of_peer() {
    if (!std::exchange(peer_asked_, true)) {
      error_code error, own_error;
      const auto peer = socket_.remote_endpoint(error), own = socket_.local_endpoint(own_error);
      if (!error && !own_error) peer_user_ = peer_user(end_of(peer), end_of(own));
    }
    return peer_user_;
  }

  void enter() { reply(entrance_page(shared_.guard->cookie())); }

  void listen() {
    if (shared_.listeners.size() >= shared_.limits.event_streams) {
      return refuse({503, "too many pages listen", "Close some"});
    }
    http::request<http::empty_body> request{std::move(parser_->get().base())};
    start_event_stream(std::move(socket_), std::move(request), shared_);
  }

  void read_body() {
    if (parser_->is_done()) return upload_ ? finish_upload() : answer();
    if (first_field(parser_->get(), "Expect") == "100-continue" && total_ == 0 && !continued_) {
      return send_continue();
    }
    if (chunk_.empty()) chunk_.resize(std::size_t{64} << 10);
    auto& body = parser_->get().body();
    body.data = chunk_.data();
    body.size = chunk_.size();
    limit(shared_.limits.idle_seconds);
    http::async_read_some(socket_, buffer_, *parser_,
                          [self = shared_from_this()](error_code error, std::size_t) {
                            self->unlimit();
                            self->take_body(error);
                          });
  }

  void send_continue() {
    static const std::string kContinue = "HTTP/1.1 100 Continue\r\n\r\n";
    continued_ = true;
    asio::async_write(socket_, asio::buffer(kContinue),
                      [self = shared_from_this()](error_code error, std::size_t) {
                        if (error) return self->close();
                        self->read_body();
                      });
  }

  void take_body(error_code error) {
    if (deadline_.passed()) return refuse({408, "a body that does not end", "Send it at once"});
    if (error == http::error::need_buffer) error = {};
    if (error) {
      if (!is_of_http(error) || error == http::error::partial_message) return close();
      return refuse(refusal_for(error));
    }
    const std::size_t n = chunk_.size() - parser_->get().body().size;
    total_ += n;
    if (total_ > most_) return refuse(refusal_for(http::error::body_limit));
    if (!upload_) {
      request_.body.append(chunk_.data(), n);
      return read_body();
    }
    on_pool(
        *shared_.disk,
        [this, n] {
          upload_->write({chunk_.data(), n});
        },
        [this] { read_body(); });
  }

  /// Does `work` on a pool and `then` back on this thread; what `work` throws is the answer.
  template <class Work, class Then>
  void on_pool(asio::thread_pool& pool, Work work, Then then) {
    run_on(pool, *shared_.io, shared_from_this(), std::move(work),
           [this, then = std::move(then)](const std::exception_ptr& failure) {
             if (failure) return reply(reply_to(failure), true);
             then();
           });
  }

  void begin_upload() {
    on_pool(
        *shared_.disk, [this] { upload_ = shared_.app->begin_upload(admission_.address); },
        [this] { read_body(); });
  }
  void finish_upload() {
    on_pool(
        *shared_.disk, [this] { upload_->finish(); }, [this] { reply(upload_reply(*upload_)); });
  }

  void answer() {
    const bool heavy =
        admission_.route.heavy || shared_.app->reads_maps(admission_.route, request_);
    on_pool(
        heavy ? *shared_.heavy : *shared_.quick,
        [this] { answer_ = shared_.app->answer(admission_.route, request_, shared_.monitor()); },
        [this] { reply(std::move(answer_)); });
  }

  /// The connection ends with a refusal: what else was sent on it cannot be trusted.
  void refuse(const Refusal& refusal) {
    const bool page = admission_.refusal && admission_.address.parts.empty() &&
                      (refusal.status == 401 || refusal.status == 403);
    reply(page ? refusal_page(refusal.status, refusal.found, refusal.mend)
               : error_reply(refusal.status, {"request", refusal.found, refusal.mend}),
          true);
  }

  void reply(Reply reply, bool last = false) {
    last = last || !parser_->get().keep_alive() || shared_.stopping;
    send_reply(socket_, shared_, std::move(reply), last,
               [self = shared_from_this(), last](bool whole) {
                 if (!whole) return self->close();
                 self->sent(last);
               });
  }

  void sent(bool last) {
    upload_.reset();
    request_ = Request{};
    answer_ = Reply{};
    continued_ = false;
    if (!last) return wait_for_request();
    error_code ignored;
    socket_.shutdown(tcp::socket::shutdown_send, ignored);
    if (chunk_.empty()) chunk_.resize(std::size_t{4} << 10);
    limit(shared_.limits.linger_seconds);
    linger();
  }

  /// A client that still sends would lose the answer if the connection was closed at once.
  void linger() {
    socket_.async_read_some(asio::buffer(chunk_),
                            [self = shared_from_this()](error_code error, std::size_t) {
                              if (error || self->deadline_.passed()) return self->close();
                              self->linger();
                            });
  }

  tcp::socket socket_;
  Shared& shared_;
  Deadline deadline_;
  bool continued_ = false, peer_asked_ = false;
  std::optional<unsigned> peer_user_;
  boost::beast::flat_buffer buffer_;
  std::optional<Parser> parser_;
  Admission admission_;
  Request request_;
  Reply answer_;
  std::unique_ptr<Upload> upload_;
  std::vector<char> chunk_;
  std::uint64_t total_ = 0, most_ = 0;
};

}  // namespace

void start_session(tcp::socket socket, Shared& shared) {
  std::make_shared<Session>(std::move(socket), shared)->start();
}

}  // namespace manoscope::serve

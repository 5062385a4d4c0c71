#include "manoscope/serve/session.hpp"

#include <fmt/format.h>
#include <unistd.h>

#include <algorithm>
#include <boost/asio/post.hpp>
#include <boost/asio/steady_timer.hpp>
#include <boost/asio/write.hpp>
#include <boost/beast/core/flat_buffer.hpp>
#include <boost/beast/http.hpp>
#include <chrono>
#include <limits>
#include <optional>
#include <vector>

#include "manoscope/serve/event_stream.hpp"
#include "manoscope/serve/json.hpp"
#include "manoscope/serve/pages.hpp"
#include "manoscope/serve/peer_user.hpp"
#include "manoscope/serve/shared.hpp"

namespace manoscope::serve {
namespace {

namespace asio = boost::asio;
namespace http = boost::beast::http;
using asio::ip::tcp;
using boost::system::error_code;

Method method_of(http::verb verb) {
  switch (verb) {
    case http::verb::get:
      return Method::get;
    case http::verb::put:
      return Method::put;
    case http::verb::post:
      return Method::post;
    case http::verb::delete_:
      return Method::del;
    default:
      return Method::other;
  }
}

template <class Fields>
std::vector<std::string> every(const Fields& fields, const char* name) {
  std::vector<std::string> values;
  const auto [first, last] = fields.equal_range(name);
  for (auto it = first; it != last; ++it) values.emplace_back(it->value());
  return values;
}

template <class Fields>
std::string first(const Fields& fields, const char* name) {
  const auto found = fields.find(name);
  return found == fields.end() ? std::string() : std::string(found->value());
}

template <class Message>
Head head_of(const Message& request) {
  Head head;
  head.method = method_of(request.method());
  head.http11 = request.version() == 11;
  head.target = std::string(request.target());
  head.host = every(request, "Host");
  head.origin = every(request, "Origin");
  head.cookie = every(request, "Cookie");
  head.content_length = every(request, "Content-Length");
  head.transfer_encoding = every(request, "Transfer-Encoding");
  head.content_type = every(request, "Content-Type");
  head.fetch_site = first(request, "Sec-Fetch-Site");
  head.upgrades = !every(request, "Upgrade").empty();
  return head;
}

/// What a header or body that cannot be read is answered with.
Refusal refusal_for(error_code error) {
  if (error == http::error::header_limit || error == http::error::buffer_overflow) {
    return {431, "a header that is too large", "Send less"};
  }
  if (error == http::error::body_limit) return {413, "a body that is too large", "Send less"};
  return {400, "this is no HTTP: " + error.message(), "Send a request as RFC 9112 says"};
}

class Session : public std::enable_shared_from_this<Session> {
 public:
  Session(tcp::socket socket, Shared& shared)
      : socket_(std::move(socket)),
        shared_(shared),
        timer_(*shared.io),
        buffer_(2 * std::size_t{shared.limits.header_bytes}) {
    ++shared_.n_connections;
  }
  ~Session() { --shared_.n_connections; }
  Session(const Session&) = delete;
  Session& operator=(const Session&) = delete;

  void start() { read_header(); }

 private:
  using Parser = http::request_parser<http::buffer_body>;

  /// From now on, what is under way may take so long.
  void limit(double seconds) {
    timed_out_ = false;
    timer_.expires_after(std::chrono::milliseconds(static_cast<long long>(seconds * 1e3)));
    timer_.async_wait([self = shared_from_this(), turn = ++turn_](error_code error) {
      if (error || turn != self->turn_) return;
      self->timed_out_ = true;
      error_code ignored;
      self->socket_.cancel(ignored);
    });
  }
  void unlimit() {
    ++turn_;
    timer_.cancel();
  }
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
    if (timed_out_) {
      const bool began = parser_->got_some() || buffer_.size() > 0;
      if (!began) return close();
      return refuse({408, "a header that does not end", "Send it at once"});
    }
    const bool of_http = error.category() == http::make_error_code(http::error{}).category();
    if (error == http::error::end_of_stream || error == http::error::partial_message ||
        (error && !of_http)) {
      return close();
    }
    if (error) return refuse(refusal_for(error));
    Head head = head_of(parser_->get());
    if (head.target.find("token=") != std::string::npos) head.peer_user = user_of_peer();
    admission_ = shared_.guard->admit(head);
    if (admission_.refusal) return refuse(*admission_.refusal);
    if (admission_.enters) return enter();
    if (admission_.route.task == Task::events) return listen();
    request_ = Request{};
    request_.method = head.method;
    request_.address = admission_.address;
    request_.if_match = first(parser_->get(), "If-Match");
    request_.if_none_match = first(parser_->get(), "If-None-Match");
    total_ = 0;
    most_ = admission_.route.body == Body::json ? shared_.limits.json_bytes
                                                : shared_.limits.upload_bytes;
    parser_->body_limit(most_);
    if (admission_.route.body == Body::upload) return begin_upload();
    read_body();
  }

  std::optional<unsigned> user_of_peer() const {
    error_code error;
    const auto peer = socket_.remote_endpoint(error);
    return error ? std::nullopt : peer_user(peer.port(), shared_.port);
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
    if (first(parser_->get(), "Expect") == "100-continue" && total_ == 0 && !continued_) {
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
    if (timed_out_) return refuse({408, "a body that does not end", "Send it at once"});
    if (error == http::error::need_buffer) error = {};
    if (error) {
      const bool of_http = error.category() == http::make_error_code(http::error{}).category();
      if (!of_http || error == http::error::partial_message) return close();
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
        false,
        [this, n] {
          upload_->write({chunk_.data(), n});
        },
        [this] { read_body(); });
  }

  /// Does `work` on a pool and `then` back on this thread; what `work` throws is the answer.
  template <class Work, class Then>
  void on_pool(bool heavy, Work work, Then then) {
    auto& pool = heavy ? *shared_.heavy : *shared_.quick;
    asio::post(pool, [self = shared_from_this(), work, then]() mutable {
      std::shared_ptr<Reply> failure;
      try {
        work();
      } catch (...) {
        failure = std::make_shared<Reply>(reply_to_exception());
      }
      auto& io = *self->shared_.io;
      asio::post(io, [self = std::move(self), then, failure] {
        if (failure) return self->reply(std::move(*failure), true);
        then();
      });
    });
  }

  void begin_upload() {
    on_pool(
        false, [this] { upload_ = shared_.app->begin_upload(admission_.address); },
        [this] { read_body(); });
  }
  void finish_upload() {
    on_pool(
        false, [this] { upload_->finish(); }, [this] { reply(upload_reply(*upload_)); });
  }

  void answer() {
    const bool heavy =
        admission_.route.heavy || shared_.app->reads_maps(admission_.route, request_);
    on_pool(
        heavy,
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

  template <class Message>
  void set_head(Message& message, const Reply& reply, bool last) {
    message.result(reply.status);
    message.set(http::field::content_type, reply.type);
    message.set("X-Content-Type-Options", "nosniff");
    message.set("Referrer-Policy", "no-referrer");
    message.set("Cache-Control", "no-store");
    message.set("Cross-Origin-Opener-Policy", "same-origin");
    message.set("Cross-Origin-Resource-Policy", "same-origin");
    message.set("Content-Security-Policy", "default-src 'none'; frame-ancestors 'none'");
    for (const auto& [name, value] : reply.headers) message.set(name, value);
    message.keep_alive(!last);
  }

  void reply(Reply reply, bool last = false) {
    last = last || !parser_->get().keep_alive() || shared_.stopping;
    if (reply.file) {
      http::response<http::file_body> message;
      set_head(message, reply, last);
      boost::beast::file_posix file;
      file.native_handle(reply.file.release());
      error_code error;
      message.body().reset(std::move(file), error);
      if (error) return close();
      message.content_length(reply.file_size);
      return send(std::move(message), last);
    }
    http::response<http::string_body> message;
    set_head(message, reply, last);
    message.body() = std::move(reply.body);
    message.prepare_payload();
    send(std::move(message), last);
  }

  template <class Body>
  struct Outgoing {
    explicit Outgoing(http::response<Body> response) : message(std::move(response)) {}
    http::response<Body> message;
    http::response_serializer<Body> serializer{message};
  };

  template <class Body>
  void send(http::response<Body> message, bool last) {
    send_some(std::make_shared<Outgoing<Body>>(std::move(message)), last);
  }

  template <class Body>
  void send_some(std::shared_ptr<Outgoing<Body>> out, bool last) {
    limit(shared_.limits.idle_seconds);
    http::async_write_some(socket_, out->serializer,
                           [self = shared_from_this(), out, last](error_code error, std::size_t) {
                             self->unlimit();
                             if (error) return self->close();
                             if (!out->serializer.is_done()) return self->send_some(out, last);
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
                              if (error || self->timed_out_) return self->close();
                              self->linger();
                            });
  }

  tcp::socket socket_;
  Shared& shared_;
  asio::steady_timer timer_;
  int turn_ = 0;
  bool timed_out_ = false, continued_ = false;
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

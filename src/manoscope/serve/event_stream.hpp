#pragma once

#include <boost/asio/ip/tcp.hpp>
#include <boost/beast/http/empty_body.hpp>
#include <boost/beast/http/message.hpp>

namespace manoscope::serve {

struct Shared;

/// Makes a WebSocket of a connection whose request passed the guard, and tells it events until it
/// ends.
void start_event_stream(boost::asio::ip::tcp::socket socket,
                        boost::beast::http::request<boost::beast::http::empty_body> request,
                        Shared& shared);

}  // namespace manoscope::serve

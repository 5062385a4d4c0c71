#pragma once

#include <boost/asio/ip/tcp.hpp>
#include <functional>

#include "manoscope/serve/message.hpp"

namespace manoscope::serve {

struct Shared;

/// Sends an answer; of a file piece by piece, read from the disk on a pool. To be called, and calls
/// back, on the thread of the sockets.
/// @param last  tells the client that the connection ends.
/// @param sent  called once, with whether all was sent; what it holds keeps the socket.
void send_reply(boost::asio::ip::tcp::socket& socket, Shared& shared, Reply reply, bool last,
                std::function<void(bool whole)> sent);

}  // namespace manoscope::serve

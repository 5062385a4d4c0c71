#pragma once

#include <boost/asio/ip/tcp.hpp>

namespace manoscope::serve {

struct Shared;

/// Serves one connection until it ends. To be called from the thread of the sockets.
void start_session(boost::asio::ip::tcp::socket socket, Shared& shared);

}  // namespace manoscope::serve

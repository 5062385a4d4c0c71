#pragma once

#include <boost/asio/ip/tcp.hpp>

namespace manoscope::serve {

struct Shared;

/// Tells a connection beyond the cap that the server is busy, and ends it.
void refuse_connection(boost::asio::ip::tcp::socket socket, Shared& shared);

}  // namespace manoscope::serve

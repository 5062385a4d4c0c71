#pragma once

#include <boost/beast/http/buffer_body.hpp>
#include <boost/beast/http/message.hpp>
#include <string>

#include "manoscope/serve/guard.hpp"

namespace manoscope::serve {

using HttpRequest = boost::beast::http::request<boost::beast::http::buffer_body>;

/// The head of a request as the guard looks at it; whose program sent it is not in it.
Head head_of(const HttpRequest& request);

/// The first value of a field, "" if it is not there.
std::string first_field(const HttpRequest& request, const char* name);

/// What a header or body that cannot be read is answered with.
Refusal refusal_for(boost::system::error_code error);

/// Whether an error is the sender's, not the connection's.
bool is_of_http(boost::system::error_code error);

}  // namespace manoscope::serve

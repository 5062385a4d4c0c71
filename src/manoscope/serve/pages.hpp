#pragma once

#include <cstdint>

#include "manoscope/serve/message.hpp"

namespace manoscope::serve {

/// The page of the app; script and style come from this server alone.
Reply app_page(std::uint16_t port);
Reply script_reply();
Reply style_reply();

/// The page behind the address with the token: it sets the cookie and goes on to the app.
///
/// A redirection would do so too, but a browser that came here from elsewhere (a link in a mail)
/// sends no SameSite=Strict cookie along the way of one.
Reply entrance_page(const std::string& cookie);

/// A refusal for a person who typed the address.
Reply refusal_page(unsigned status, const std::string& found, const std::string& mend);

}  // namespace manoscope::serve

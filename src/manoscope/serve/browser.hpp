#pragma once

#include <string>

namespace manoscope::serve {

/// Opens an address in the user's browser, if there is a display to show it on. The browser is
/// nobody's child afterwards: it is neither waited for nor ended.
/// @return false where there is none, or no way to open it.
bool open_browser(const std::string& url);

}  // namespace manoscope::serve

#pragma once

#include <string_view>

namespace manoscope::serve {

/// Script and style of the app, as web/ builds them; part of the program.
std::string_view app_script();
std::string_view app_style();

}  // namespace manoscope::serve

#pragma once

#include <string_view>

namespace manoscope::report {

/// Script and style of the interactive report.html, as built from web/ (web/dist).
std::string_view page_script();
std::string_view page_style();

}  // namespace manoscope::report

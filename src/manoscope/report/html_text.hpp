#pragma once

#include <string>
#include <string_view>

namespace manoscope::report {

/// Text as it must stand in HTML, in elements and in quoted attributes: & < > " ' escaped, bytes
/// that are no text (control characters other than tab and line breaks) as U+FFFD.
std::string escape_html(std::string_view text);

}  // namespace manoscope::report

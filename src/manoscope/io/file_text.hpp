#pragma once

#include <string>
#include <string_view>

namespace manoscope::io {

/// Without blanks, tabs and line ends at both ends.
std::string_view trimmed(std::string_view text);

/// ASCII letters made small; other bytes stay.
std::string lower_case(std::string_view text);

/// A piece of an untrusted file, fit for a message: one line, at most 60 bytes, no control codes.
std::string excerpt(std::string_view text);

/// A title fit for a one-line header: line ends and other control codes become blanks.
std::string one_line(std::string_view text);

}  // namespace manoscope::io

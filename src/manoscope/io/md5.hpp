#pragma once

#include <string>
#include <string_view>

namespace manoscope::io {

/// MD5 of bytes, as 32 small hexadecimal digits. Good against slips of copying, which is what file
/// formats keep it for; not against anyone's will.
std::string md5(std::string_view bytes);

}  // namespace manoscope::io

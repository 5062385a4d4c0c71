#pragma once

#include <string>
#include <string_view>

namespace manoscope::serve {

/// 256 bits from the system's random source, as 64 hexadecimal digits.
/// @throws InternalError if there is none.
std::string new_secret();

/// Compares in a time that does not tell where the two differ.
bool same_secret(std::string_view a, std::string_view b);

}  // namespace manoscope::serve

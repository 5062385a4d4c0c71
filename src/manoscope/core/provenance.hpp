#pragma once

#include <filesystem>
#include <string>
#include <string_view>

namespace manoscope {

/// "0.1.0"
std::string_view program_version();
/// Git revision of the source the program was built from, "-dirty" if it was changed since.
std::string_view source_revision();

/// SHA-256 of bytes, as 64 hexadecimal digits.
std::string sha256(std::string_view bytes);

/// The whole content of a file.
///
/// @throws InputError if the file is missing, not a regular file, unreadable, or longer than
///         `largest` bytes.
std::string read_file(const std::filesystem::path& path,
                      std::uintmax_t largest = std::uintmax_t{1} << 32);

}  // namespace manoscope

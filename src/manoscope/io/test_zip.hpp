#pragma once

// For the tests of this folder only.

#include <cstdint>
#include <string>
#include <utility>
#include <vector>

#include "manoscope/io/test_bytes.hpp"

namespace manoscope::io::testing {

inline std::uint32_t crc32(const std::string& bytes) {
  std::uint32_t crc = 0xffffffffU;
  for (const char byte : bytes) {
    crc ^= static_cast<unsigned char>(byte);
    for (int bit = 0; bit < 8; ++bit) crc = crc >> 1 ^ ((crc & 1U) != 0 ? 0xedb88320U : 0U);
  }
  return ~crc;
}

/// A zip archive laid out by hand (PKWARE's APPNOTE 6.3), files stored as they are.
/// @param declared_size  what the archive says of the last file's unpacked size; 0 = the truth.
inline std::string stored_zip(const std::vector<std::pair<std::string, std::string>>& files,
                              std::uint64_t declared_size = 0, int method = 0, int flags = 0) {
  std::string bytes, directory;
  for (std::size_t i = 0; i < files.size(); ++i) {
    const auto& [name, content] = files[i];
    const bool last = i + 1 == files.size();
    const std::uint64_t size = last && declared_size > 0 ? declared_size : content.size();
    const std::string common = little(last ? method : 0, 2) + little(0, 2) + little(0x21, 2) +
                               little(crc32(content), 4) + little(content.size(), 4) +
                               little(size, 4) + little(name.size(), 2) + little(0, 2);
    const std::string flag_bytes = little(last ? flags : 0, 2);
    directory += "PK\x01\x02" + little(20, 2) + little(20, 2) + flag_bytes + common + little(0, 2) +
                 little(0, 2) + little(0, 2) + little(0, 4) + little(bytes.size(), 4) + name;
    bytes += "PK\x03\x04" + little(20, 2) + flag_bytes + common + name + content;
  }
  return bytes + directory + "PK\x05\x06" + little(0, 4) + little(files.size(), 2) +
         little(files.size(), 2) + little(directory.size(), 4) + little(bytes.size(), 4) +
         little(0, 2);
}

}  // namespace manoscope::io::testing

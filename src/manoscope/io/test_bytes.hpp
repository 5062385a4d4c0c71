#pragma once

// For tests only: the bytes that files are laid out from by hand.

#include <bit>
#include <cstdint>
#include <filesystem>
#include <fstream>
#include <iterator>
#include <string>

namespace manoscope::io::testing {

inline std::string little(std::uint64_t value, int n_bytes) {
  std::string bytes;
  for (int i = 0; i < n_bytes; ++i) bytes += static_cast<char>(value >> (8 * i) & 0xff);
  return bytes;
}
inline std::string big(std::uint64_t value, int n_bytes) {
  const std::string bytes = little(value, n_bytes);
  return {bytes.rbegin(), bytes.rend()};
}
inline std::string little(float value) { return little(std::bit_cast<std::uint32_t>(value), 4); }
inline std::string little(double value) { return little(std::bit_cast<std::uint64_t>(value), 8); }
inline std::string big(float value) { return big(std::bit_cast<std::uint32_t>(value), 4); }
inline std::string big(double value) { return big(std::bit_cast<std::uint64_t>(value), 8); }

/// Overwrites bytes from `offset` on.
inline void put(std::string& bytes, std::size_t offset, const std::string& field) {
  bytes.replace(offset, field.size(), field);
}

/// A text field of fixed width.
inline std::string padded(std::string text, std::size_t n_bytes, char with = '\0') {
  text.resize(n_bytes, with);
  return text;
}

inline std::string bytes_of(const std::filesystem::path& path) {
  std::ifstream in(path, std::ios::binary);
  return {std::istreambuf_iterator<char>(in), {}};
}

}  // namespace manoscope::io::testing

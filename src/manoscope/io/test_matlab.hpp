// MATLAB files of version 5 put together by hand, for tests.
#pragma once

#include <bit>
#include <cstdint>
#include <string>

#include "manoscope/io/test_bytes.hpp"

namespace manoscope::io::testing {

inline std::string padded(std::string bytes) {
  bytes.resize((bytes.size() + 7) / 8 * 8, '\0');
  return bytes;
}

/// A file of one matrix `z` of 2 rows and 3 columns, 1 ... 6 by columns, in either byte order.
inline std::string matlab_file(bool big_endian, std::uint32_t type = 9, unsigned kind = 6,
                               std::uint32_t n_rows = 2) {
  const auto number = [&](std::uint64_t value, int n) {
    return big_endian ? big(value, n) : little(value, n);
  };
  const auto element = [&](std::uint32_t what, const std::string& bytes) {
    return number(what, 4) + number(bytes.size(), 4) + padded(bytes);
  };
  std::string values;
  for (int i = 1; i <= 6; ++i) {
    if (type == 9) values += number(std::bit_cast<std::uint64_t>(static_cast<double>(i)), 8);
    if (type == 3) values += number(static_cast<std::uint64_t>(i), 2);
  }
  // The name in one word with its count.
  const std::string name = big_endian ? big(1, 2) + big(1, 2) : little(1, 2) + little(1, 2);
  const std::string matrix = element(6, number(kind, 4) + number(0, 4)) +
                             element(5, number(n_rows, 4) + number(3, 4)) + name +
                             std::string("z\0\0\0", 4) + element(type, values);
  std::string head = "MATLAB 5.0 MAT-file, by hand";
  head.resize(124, ' ');
  return head + number(0x0100, 2) + (big_endian ? "MI" : "IM") + element(14, matrix);
}

}  // namespace manoscope::io::testing

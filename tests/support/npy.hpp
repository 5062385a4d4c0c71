#pragma once

#include <filesystem>
#include <fstream>
#include <functional>
#include <numeric>
#include <sstream>
#include <stdexcept>
#include <string>
#include <vector>

namespace manoscope::test {

/// Array of a NumPy file: little-endian float64, C order, format version 1.
struct NpyArray {
  std::vector<std::size_t> shape;
  std::vector<double> values;  ///< row-major
};

/// Reads a .npy file of format version 1.0 (numpy.lib.format): magic, version, length of the
/// header, header (a Python dictionary), data.
/// @throws std::runtime_error for anything else than little-endian float64 in C order.
inline NpyArray read_npy(const std::filesystem::path& path) {
  std::ifstream file(path, std::ios::binary);
  std::ostringstream buffer;
  buffer << file.rdbuf();
  const std::string bytes = buffer.str();
  constexpr std::size_t kPreamble = 10;
  const auto refuse = [&](const std::string& why) {
    throw std::runtime_error(path.string() + ": " + why);
  };
  if (bytes.size() < kPreamble || bytes.compare(0, 8, std::string("\x93NUMPY\x01\x00", 8)) != 0) {
    refuse("no .npy file of version 1.0");
  }
  const auto byte = [&](std::size_t i) { return static_cast<unsigned char>(bytes[i]); };
  const std::size_t header_size = byte(8) + 256u * byte(9);
  const std::string header = bytes.substr(kPreamble, header_size);
  if (header.find("'<f8'") == std::string::npos ||
      header.find("'fortran_order': False") == std::string::npos) {
    refuse("values are not little-endian float64 in C order: " + header);
  }
  NpyArray array;
  const std::size_t open = header.find('('), close = header.find(')');
  if (open == std::string::npos || close == std::string::npos) refuse("no shape: " + header);
  std::istringstream sizes(header.substr(open + 1, close - open - 1));
  for (std::size_t size = 0; sizes >> size; sizes.ignore(1, ',')) array.shape.push_back(size);
  const std::size_t n =
      std::accumulate(array.shape.begin(), array.shape.end(), std::size_t{1}, std::multiplies<>());
  if (bytes.size() != kPreamble + header_size + n * sizeof(double)) refuse("data are cut short");
  array.values.resize(n);
  std::copy_n(bytes.data() + kPreamble + header_size, n * sizeof(double),
              reinterpret_cast<char*>(array.values.data()));
  return array;
}

}  // namespace manoscope::test

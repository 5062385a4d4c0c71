#pragma once

// For the tests of this folder only: classic NetCDF files laid out byte by byte from the format's
// description, without the NetCDF library.

#include <cstdint>
#include <string>
#include <utility>
#include <vector>

#include "manoscope/io/test_bytes.hpp"

namespace manoscope::io::testing {

struct ClassicNetcdf {
  struct Variable {
    std::string name;
    std::vector<std::uint64_t> dimensions;                   ///< places in `dimensions` below
    std::vector<std::pair<std::string, std::string>> texts;  ///< attributes
    std::vector<std::pair<std::string, double>> numbers;     ///< attributes of one double
    std::string data;                                        ///< big-endian
    std::uint64_t type = 6;                                  ///< NC_DOUBLE
  };
  std::vector<std::pair<std::string, std::uint64_t>> dimensions;
  std::vector<Variable> variables;

  static std::string doubles(const std::vector<double>& values) {
    std::string bytes;
    for (const double value : values) bytes += big(value);
    return bytes;
  }

  /// @param version  1 (32-bit offsets), 2 (64-bit offsets) or 5 (64-bit counts too).
  std::string bytes(int version) const {
    // The header's length does not depend on the offsets in it: laid out twice.
    std::vector<std::uint64_t> begins(variables.size(), 0);
    std::uint64_t begin = header(version, begins).size();
    for (std::size_t i = 0; i < variables.size(); ++i) {
      begins[i] = begin;
      begin += padded(variables[i].data).size();
    }
    std::string file = header(version, begins);
    for (const Variable& variable : variables) file += padded(variable.data);
    // What pads the last variable may be missing, as other programs leave it out.
    if (!variables.empty()) {
      const std::string& last = variables.back().data;
      file.resize(file.size() - (padded(last).size() - last.size()));
    }
    return file;
  }

 private:
  static std::string padded(std::string text) {
    while (text.size() % 4 != 0) text += '\0';
    return text;
  }

  std::string header(int version, const std::vector<std::uint64_t>& begins) const {
    const int n = version == 5 ? 8 : 4;
    const auto count = [n](std::uint64_t value) { return big(value, n); };
    const auto name = [&](const std::string& text) { return count(text.size()) + padded(text); };
    std::string out = "CDF";
    out += static_cast<char>(version);
    out += count(0) + big(std::uint64_t{10}, 4) + count(dimensions.size());
    for (const auto& [text, length] : dimensions) out += name(text) + count(length);
    out += big(std::uint64_t{0}, 4) + count(0);  // no global attributes
    out += big(std::uint64_t{11}, 4) + count(variables.size());
    for (std::size_t i = 0; i < variables.size(); ++i) {
      const Variable& variable = variables[i];
      out += name(variable.name) + count(variable.dimensions.size());
      for (const std::uint64_t dimension : variable.dimensions) out += count(dimension);
      const std::size_t n_attributes = variable.texts.size() + variable.numbers.size();
      out += big(std::uint64_t{n_attributes == 0 ? 0U : 12U}, 4) + count(n_attributes);
      for (const auto& [key, text] : variable.texts) {
        out += name(key) + big(std::uint64_t{2}, 4) + count(text.size()) + padded(text);
      }
      for (const auto& [key, value] : variable.numbers) {
        out += name(key) + big(std::uint64_t{6}, 4) + count(1) + big(value);
      }
      out += big(variable.type, 4) + count(padded(variable.data).size());
      out += big(begins[i], version == 1 ? 4 : 8);
    }
    return out;
  }
};

}  // namespace manoscope::io::testing

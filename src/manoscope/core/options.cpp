#include "manoscope/core/options.hpp"

#include <fmt/format.h>

#include <charconv>
#include <cmath>

namespace manoscope::option_text {
namespace {

template <class Integer>
Integer read_integer(std::string_view text, const std::string& where) {
  Integer value{};
  const auto [end, error] = std::from_chars(text.data(), text.data() + text.size(), value);
  if (error != std::errc() || end != text.data() + text.size()) {
    throw InputError(where, fmt::format("\"{}\" is not an integer in range", text),
                     "Write a whole number");
  }
  return value;
}

}  // namespace

std::string write(double value) { return fmt::format("{}", value); }
std::string write(int value) { return fmt::format("{}", value); }
std::string write(std::uint64_t value) { return fmt::format("{}", value); }
std::string write(bool value) { return value ? "true" : "false"; }
std::string write(const std::string& value) { return value; }

void read(std::string_view text, const std::string& where, double& value) {
  const auto number = parse_number(text);
  if (!number || !std::isfinite(*number)) {
    throw InputError(where, fmt::format("\"{}\" is not a number", text), "Write a plain number");
  }
  value = *number;
}

void read(std::string_view text, const std::string& where, int& value) {
  value = read_integer<int>(text, where);
}

void read(std::string_view text, const std::string& where, std::uint64_t& value) {
  value = read_integer<std::uint64_t>(text, where);
}

void read(std::string_view text, const std::string& where, bool& value) {
  if (text == "true" || text == "yes") {
    value = true;
  } else if (text == "false" || text == "no") {
    value = false;
  } else {
    throw InputError(where, fmt::format("\"{}\" is neither true nor false", text),
                     "Write true or false");
  }
}

void read(std::string_view text, const std::string&, std::string& value) { value = text; }

}  // namespace manoscope::option_text

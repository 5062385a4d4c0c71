#include "manoscope/io/map_address.hpp"

#include <charconv>
#include <string>

namespace manoscope::io {

MapAddress map_address(const std::filesystem::path& name) {
  const std::string text = name.string();
  const auto mark = text.rfind('#');
  if (mark == std::string::npos || mark == 0 || mark + 1 == text.size()) return {name, 0};
  int page = 0;
  const char* end = text.data() + text.size();
  const auto [at, fault] = std::from_chars(text.data() + mark + 1, end, page);
  if (fault != std::errc() || at != end || page < 1) return {name, 0};
  std::error_code error;
  if (std::filesystem::exists(name, error)) return {name, 0};
  return {text.substr(0, mark), page};
}

}  // namespace manoscope::io

#include "manoscope/serve/address.hpp"

#include <algorithm>
#include <cstddef>

namespace manoscope::serve {
namespace {

std::optional<int> hex_digit(char letter) {
  if (letter >= '0' && letter <= '9') return letter - '0';
  if (letter >= 'a' && letter <= 'f') return letter - 'a' + 10;
  if (letter >= 'A' && letter <= 'F') return letter - 'A' + 10;
  return std::nullopt;
}

std::optional<std::string> decoded(std::string_view text) {
  std::string bytes;
  for (std::size_t i = 0; i < text.size(); ++i) {
    if (text[i] != '%') {
      bytes += text[i];
      continue;
    }
    if (i + 2 >= text.size()) return std::nullopt;
    const auto high = hex_digit(text[i + 1]), low = hex_digit(text[i + 2]);
    if (!high || !low) return std::nullopt;
    bytes += static_cast<char>(16 * *high + *low);
    i += 2;
  }
  return bytes;
}

bool has_control(std::string_view text) {
  return std::any_of(text.begin(), text.end(), [](char letter) {
    const auto code = static_cast<unsigned char>(letter);
    return code < 0x20 || code == 0x7F;
  });
}

bool is_sound_part(std::string_view part) {
  return !part.empty() && part != "." && part != ".." &&
         part.find_first_of("/\\") == std::string_view::npos && !has_control(part) && is_utf8(part);
}

bool parse_query(std::string_view text, Address& address) {
  while (!text.empty()) {
    const auto end = std::min(text.find('&'), text.size());
    const std::string_view pair = text.substr(0, end);
    text.remove_prefix(std::min(end + 1, text.size()));
    const auto sign = std::min(pair.find('='), pair.size());
    const auto name = decoded(pair.substr(0, sign));
    const auto value = decoded(pair.substr(std::min(sign + 1, pair.size())));
    if (!name || !value || !is_utf8(*name) || !is_utf8(*value) || has_control(*name) ||
        has_control(*value) || address.value(*name)) {
      return false;
    }
    address.query.emplace_back(*name, *value);
  }
  return true;
}

}  // namespace

std::optional<std::string> Address::value(std::string_view name) const {
  for (const auto& [known, value] : query) {
    if (known == name) return value;
  }
  return std::nullopt;
}

std::optional<Address> parse_address(std::string_view target) {
  if (!target.starts_with('/')) return std::nullopt;
  Address address;
  const auto mark = std::min(target.find('?'), target.size());
  std::string_view path = target.substr(1, mark - 1);
  while (!path.empty()) {
    const auto end = path.find('/');
    auto part = decoded(path.substr(0, end));
    if (!part || !is_sound_part(*part)) return std::nullopt;
    address.parts.push_back(std::move(*part));
    if (end == std::string_view::npos) break;
    path.remove_prefix(end + 1);
    if (path.empty()) return std::nullopt;  // a slash at the end names nothing here
  }
  if (mark < target.size() && !parse_query(target.substr(mark + 1), address)) return std::nullopt;
  return address;
}

bool is_plain_name(std::string_view part) {
  constexpr std::size_t kLongestName = 255;  // bytes, of the usual file systems
  return is_sound_part(part) && part.front() != '.' && part.size() <= kLongestName;
}

std::optional<std::vector<std::string>> relative_parts(std::string_view path) {
  std::vector<std::string> parts;
  while (!path.empty()) {
    const auto end = path.find('/');
    const std::string_view part = path.substr(0, end);
    if (!is_plain_name(part)) return std::nullopt;
    parts.emplace_back(part);
    if (end == std::string_view::npos) break;
    path.remove_prefix(end + 1);
    if (path.empty()) return std::nullopt;
  }
  return parts;
}

std::string join(const std::vector<std::string>& parts) {
  std::string path;
  for (const std::string& part : parts) path = under(path, part);
  return path;
}

std::string under(const std::string& folder, const std::string& name) {
  if (folder.empty()) return name;
  std::string path = folder;
  path += '/';
  return path += name;
}

bool is_utf8(std::string_view text) {
  const auto byte = [&](std::size_t i) { return static_cast<unsigned char>(text[i]); };
  for (std::size_t i = 0; i < text.size();) {
    const unsigned char lead = byte(i);
    const std::size_t length = lead < 0x80                   ? 1
                               : lead >= 0xC2 && lead < 0xE0 ? 2
                               : lead >= 0xE0 && lead < 0xF0 ? 3
                               : lead >= 0xF0 && lead < 0xF5 ? 4
                                                             : 0;
    if (length == 0 || i + length > text.size()) return false;
    for (std::size_t k = 1; k < length; ++k) {
      if ((byte(i + k) & 0xC0) != 0x80) return false;
    }
    // No overlong forms, no surrogates, nothing beyond U+10FFFF.
    if ((lead == 0xE0 && byte(i + 1) < 0xA0) || (lead == 0xED && byte(i + 1) > 0x9F) ||
        (lead == 0xF0 && byte(i + 1) < 0x90) || (lead == 0xF4 && byte(i + 1) > 0x8F)) {
      return false;
    }
    i += length;
  }
  return true;
}

}  // namespace manoscope::serve

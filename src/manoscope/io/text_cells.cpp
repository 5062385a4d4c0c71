#include "manoscope/io/text_cells.hpp"

#include <algorithm>
#include <array>
#include <charconv>
#include <cmath>
#include <cstdint>
#include <limits>

#include "manoscope/io/file_text.hpp"

namespace manoscope::io {
namespace {

constexpr double kMissing = std::numeric_limits<double>::quiet_NaN();

bool is_missing_word(std::string_view cell) {
  constexpr std::array<std::string_view, 18> kWords{
      "",     "nan",     "bad", "--",      "---",      "na",  "n/a",     "null", "none",
      "void", "missing", "***", "1.#qnan", "-1.#qnan", "#na", "-1.#ind", "-nan", "masked"};
  if (cell.size() > 8) return false;
  const std::string lower = lower_case(cell);
  return std::find(kWords.begin(), kWords.end(), lower) != kWords.end() || lower == "inf" ||
         lower == "-inf" || lower == "1.#inf" || lower == "-1.#inf" || lower == "-1.#ind00";
}

void append_utf8(std::uint32_t code, std::string& text) {
  const auto add = [&text](std::uint32_t byte) { text += static_cast<char>(byte); };
  if (code < 0x80) {
    add(code);
  } else if (code < 0x800) {
    add(0xC0U | code >> 6);
    add(0x80U | (code & 0x3FU));
  } else if (code < 0x10000) {
    add(0xE0U | code >> 12);
    add(0x80U | (code >> 6 & 0x3FU));
    add(0x80U | (code & 0x3FU));
  } else {
    add(0xF0U | code >> 18);
    add(0x80U | (code >> 12 & 0x3FU));
    add(0x80U | (code >> 6 & 0x3FU));
    add(0x80U | (code & 0x3FU));
  }
}

}  // namespace

bool is_blank(char letter) { return letter == ' ' || letter == '\t' || letter == '\r'; }

std::string_view strip(std::string_view text) {
  while (!text.empty() && is_blank(text.front())) text.remove_prefix(1);
  while (!text.empty() && is_blank(text.back())) text.remove_suffix(1);
  return text;
}

bool is_comment(std::string_view line) {
  return line.starts_with('#') || line.starts_with('%') || line.starts_with("//");
}

std::optional<double> cell_value(std::string_view cell, bool comma_is_decimal) {
  std::string_view digits = cell;
  if (digits.starts_with('+')) digits.remove_prefix(1);
  double value = 0.0;
  const auto [end, error] = std::from_chars(digits.data(), digits.data() + digits.size(), value);
  if (error == std::errc() && end == digits.data() + digits.size()) {
    return std::isfinite(value) ? value : kMissing;
  }
  if (comma_is_decimal && error == std::errc() && *end == ',' && digits.size() < 64) {
    std::array<char, 64> point{};
    std::copy(digits.begin(), digits.end(), point.begin());
    point[static_cast<std::size_t>(end - digits.data())] = '.';
    const char* const last = point.data() + digits.size();
    const auto again = std::from_chars(point.data(), last, value);
    if (again.ec == std::errc() && again.ptr == last && std::isfinite(value)) return value;
  }
  if (is_missing_word(cell)) return kMissing;
  return std::nullopt;
}

/// The sign between the cells of a row. A comma next to a blank or to another comma, or in a row
/// without blanks, parts cells; between digits of a row with blanks it is the decimal mark.
char delimiter_of(std::string_view row) {
  if (row.find(';') != std::string_view::npos) return ';';
  const bool tab = row.find('\t') != std::string_view::npos;
  const std::string_view bare = strip(row);
  bool comma = false, blank = tab, comma_by_itself = false;
  for (std::size_t i = 0; i < bare.size(); ++i) {
    if (bare[i] == ',') {
      comma = true;
      const bool before = i > 0 && bare[i - 1] >= '0' && bare[i - 1] <= '9';
      const bool after = i + 1 < bare.size() && bare[i + 1] >= '0' && bare[i + 1] <= '9';
      comma_by_itself = comma_by_itself || !before || !after;
    }
    blank = blank || is_blank(bare[i]);
  }
  if (comma && (comma_by_itself || !blank)) return ',';
  if (!tab) return ' ';
  // Tabs part cells (and leave some empty) unless blanks do so too.
  Cells cells(row, '\t');
  for (std::string_view cell; cells.next(cell);) {
    if (std::any_of(cell.begin(), cell.end(), is_blank)) return ' ';
  }
  return '\t';
}

std::string utf8_text(std::string bytes) {
  const bool little = bytes.starts_with("\xFF\xFE"), big = bytes.starts_with("\xFE\xFF");
  if (!little && !big) return bytes;
  const auto unit = [&](std::size_t at) {
    const auto low = static_cast<unsigned char>(bytes[at + (little ? 0 : 1)]);
    const auto high = static_cast<unsigned char>(bytes[at + (little ? 1 : 0)]);
    return static_cast<std::uint32_t>(high) << 8 | low;
  };
  constexpr std::uint32_t kUnreadable = 0xFFFD;
  std::string text;
  text.reserve(bytes.size() / 2);
  for (std::size_t at = 2; at + 1 < bytes.size(); at += 2) {
    const std::uint32_t first = unit(at);
    if (first < 0xD800 || first > 0xDFFF) {
      append_utf8(first, text);
      continue;
    }
    // Beyond the first 65536 letters: a pair of surrogates.
    const std::uint32_t second = at + 3 < bytes.size() ? unit(at + 2) : 0;
    const bool pair = first < 0xDC00 && second >= 0xDC00 && second <= 0xDFFF;
    append_utf8(pair ? 0x10000U + ((first - 0xD800U) << 10) + (second - 0xDC00U) : kUnreadable,
                text);
    at += pair ? 2 : 0;
  }
  return text;
}

}  // namespace manoscope::io

#include "text_table.hpp"

#include <algorithm>

namespace manoscope::cli {
namespace {

/// Characters on the screen, not bytes.
std::size_t shown_width(const std::string& text) {
  return static_cast<std::size_t>(std::count_if(text.begin(), text.end(), [](char byte) {
    return (static_cast<unsigned char>(byte) & 0xC0) != 0x80;
  }));
}

std::string pad(const std::string& text, std::size_t width) {
  const std::size_t shown = shown_width(text);
  return (shown < width ? std::string(width - shown, ' ') : std::string()) + text;
}

}  // namespace

std::string text_table(const std::vector<std::vector<std::string>>& rows) {
  std::vector<std::size_t> widths(rows.front().size(), 0);
  for (const auto& row : rows) {
    for (std::size_t c = 0; c < row.size(); ++c) {
      widths[c] = std::max(widths[c], shown_width(row[c]));
    }
  }
  std::string text;
  for (const auto& row : rows) {
    for (std::size_t c = 0; c < row.size(); ++c) text += pad(row[c], widths[c] + (c > 0 ? 2 : 0));
    text += '\n';
  }
  return text;
}

}  // namespace manoscope::cli

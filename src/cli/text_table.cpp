#include "text_table.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>

#include "manoscope/core/uncertainty.hpp"

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

std::string value_text(double value, double standard_uncertainty) {
  if (!std::isfinite(value)) return "-";
  if (!(standard_uncertainty > 0.0)) return fmt::format("{:.0f}", value);
  const double expanded = kExpansion * standard_uncertainty;
  const int digits = std::max(0, 1 - static_cast<int>(std::floor(std::log10(expanded))));
  return fmt::format("{:.{}f} ± {:.{}f}", value, digits, expanded, digits);
}

}  // namespace manoscope::cli

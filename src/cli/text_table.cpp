#include "text_table.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <array>
#include <cmath>
#include <sstream>

#include "manoscope/core/uncertainty.hpp"

namespace manoscope::cli {
namespace {

using Rows = std::vector<std::vector<std::string>>;

std::string blanks(std::size_t n) { return std::string(n, ' '); }

std::string pad(const std::string& text, std::size_t width, Align align) {
  const std::size_t shown = shown_width(text);
  const std::string fill = blanks(shown < width ? width - shown : 0);
  return align == Align::left ? text + fill : fill + text;
}

/// "12.3 ± 4.5" as what lies below each other: "12", ".3", " ± ", "4", ".5".
using Parts = std::array<std::string, 5>;

Parts parts_of(const std::string& cell) {
  static const std::string kSign = " ± ";
  const std::size_t sign = cell.find(kSign);
  const bool pair = sign != std::string::npos;
  const std::string value = cell.substr(0, sign);
  const std::string bar = pair ? cell.substr(sign + kSign.size()) : std::string();
  const auto point = [](const std::string& number) {
    return std::min(number.find('.'), number.size());
  };
  return {value.substr(0, point(value)), value.substr(point(value)), pair ? kSign : std::string(),
          bar.substr(0, point(bar)), bar.substr(point(bar))};
}

/// The cells of column c below the heads, aligned by the point and all of one width.
void align_by_point(Rows& rows, std::size_t c, std::size_t n_head) {
  constexpr Align kParts[] = {Align::right, Align::left, Align::left, Align::right, Align::left};
  std::array<std::size_t, 5> widths{};
  for (std::size_t r = n_head; r < rows.size(); ++r) {
    const Parts parts = parts_of(rows[r][c]);
    for (std::size_t k = 0; k < parts.size(); ++k) {
      widths[k] = std::max(widths[k], shown_width(parts[k]));
    }
  }
  for (std::size_t r = n_head; r < rows.size(); ++r) {
    const Parts parts = parts_of(rows[r][c]);
    rows[r][c].clear();
    for (std::size_t k = 0; k < parts.size(); ++k) {
      rows[r][c] += pad(parts[k], widths[k], kParts[k]);
    }
  }
}

/// A line as several.
std::string broken_at_blanks(const std::string& text, std::size_t width) {
  std::istringstream words(text);
  std::string lines, line;
  for (std::string word; words >> word;) {
    if (!line.empty() && shown_width(line) + 1 + shown_width(word) > width) {
      lines += line + '\n';
      line = "  " + word;
    } else {
      line += (line.empty() ? "" : " ") + word;
    }
  }
  return lines + line;
}

}  // namespace

std::size_t shown_width(const std::string& text) {
  std::size_t width = 0;
  bool code = false;
  for (const char byte : text) {
    if (byte == '\033') code = true;
    const bool continues = (static_cast<unsigned char>(byte) & 0xC0) == 0x80;
    if (!code && !continues) ++width;
    if (code && byte == 'm') code = false;
  }
  return width;
}

std::string text_table(const Rows& rows) {
  return text_table(rows, std::vector<Align>(rows.front().size(), Align::right));
}

std::string text_table(const Rows& rows, const std::vector<Align>& columns, std::size_t n_head) {
  Rows cells = rows;
  std::vector<std::size_t> widths(columns.size(), 0);
  for (std::size_t c = 0; c < columns.size(); ++c) {
    if (columns[c] == Align::point) align_by_point(cells, c, n_head);
    for (const auto& row : cells) widths[c] = std::max(widths[c], shown_width(row[c]));
  }
  std::string text;
  for (const auto& row : cells) {
    std::string line;
    for (std::size_t c = 0; c < row.size(); ++c) {
      line += (c > 0 ? "  " : "") + pad(row[c], widths[c], columns[c]);
    }
    text += line.substr(0, line.find_last_not_of(' ') + 1) + '\n';
  }
  return text;
}

void add_row(std::vector<Column>& columns, const std::vector<std::string>& cells) {
  for (std::size_t c = 0; c < columns.size(); ++c) columns[c].cells.push_back(cells[c]);
}

std::string text_table(std::vector<Column> columns, const Screen& screen, std::size_t n_head) {
  for (;;) {
    Rows rows(columns.front().cells.size());
    std::vector<Align> aligns;
    for (const Column& column : columns) {
      aligns.push_back(column.align);
      for (std::size_t r = 0; r < rows.size(); ++r) rows[r].push_back(column.cells[r]);
    }
    std::string text = text_table(rows, aligns, n_head);
    if (!screen.terminal || fits(text, screen.columns)) return text;
    const auto least =
        std::max_element(columns.begin(), columns.end(),
                         [](const Column& a, const Column& b) { return a.rank < b.rank; });
    if (least->rank == 0) return text;
    columns.erase(least);
  }
}

bool fits(const std::string& text, int width) {
  std::istringstream lines(text);
  for (std::string line; std::getline(lines, line);) {
    if (shown_width(line) > static_cast<std::size_t>(std::max(width, 0))) return false;
  }
  return true;
}

std::string wrapped(const std::string& text, int width) {
  const auto most = static_cast<std::size_t>(std::max(width, 0));
  std::istringstream lines(text);
  std::string broken;
  for (std::string line; std::getline(lines, line);) {
    broken += (shown_width(line) <= most ? line : broken_at_blanks(line, most)) + '\n';
  }
  return broken;
}

std::string value_text(double value, double standard_uncertainty) {
  if (!std::isfinite(value)) return "-";
  if (!std::isgreater(standard_uncertainty, 0.0)) return fmt::format("{:.0f}", value);
  const double expanded = kExpansion * standard_uncertainty;
  const int digits = std::max(0, 1 - static_cast<int>(std::floor(std::log10(expanded))));
  return fmt::format("{:.{}f} ± {:.{}f}", value, digits, expanded, digits);
}

std::string fixed(double value, int digits) {
  return std::isfinite(value) ? fmt::format("{:.{}f}", value, digits) : std::string("-");
}

std::string flow_rate_text(FlowRate flow_rate) {
  return fmt::format("{:.4g}", flow_rate.in(mL_per_min));
}

}  // namespace manoscope::cli

#pragma once

#include <string>
#include <vector>

#include "manoscope/core/units.hpp"
#include "screen.hpp"

namespace manoscope::cli {

/// Characters that a text takes on the screen: neither bytes nor the codes of colours.
std::size_t shown_width(const std::string& text);

/// How the cells of a column lie below each other. `point` aligns numbers by their decimal point,
/// and what stands behind " ± " by its own.
enum class Align { left, right, point };

/// Rows of cells, at least one, as a table aligned to the right.
std::string text_table(const std::vector<std::vector<std::string>>& rows);
/// The same, each column its own way; the first `n_head` rows are heads, which `point` leaves to
/// the right.
std::string text_table(const std::vector<std::vector<std::string>>& rows,
                       const std::vector<Align>& columns, std::size_t n_head = 1);

/// A column of a table that may meet a narrow terminal.
struct Column {
  std::vector<std::string> cells;  ///< heads first
  Align align = Align::right;
  int rank = 0;  ///< where there is no room the highest goes first; 0 stays
};
void add_row(std::vector<Column>& columns, const std::vector<std::string>& cells);
/// The columns as a table, on a terminal no more of them than fit.
std::string text_table(std::vector<Column> columns, const Screen& screen, std::size_t n_head = 1);

/// Whether no line of a text is longer than `width` characters.
bool fits(const std::string& text, int width);
/// Lines longer than `width` characters broken at blanks, what follows indented by two; a word that
/// is longer stays whole. Ends with a line's end.
std::string wrapped(const std::string& text, int width);

/// "12287 ± 21": a value with its expanded uncertainty (k = 2) to two digits; without one, to the
/// unit; a dash where there is no value.
std::string value_text(double value, double standard_uncertainty);
/// With so many digits behind the point; a dash where there is no value.
std::string fixed(double value, int digits);
/// "12.5": in mL/min, four digits.
std::string flow_rate_text(FlowRate flow_rate);

}  // namespace manoscope::cli

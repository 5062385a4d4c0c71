#pragma once

#include <string>
#include <string_view>
#include <vector>

#include "manoscope/core/arrays.hpp"
#include "manoscope/io/text_header.hpp"

namespace manoscope::io {

/// A matrix of numbers as text, with what its header says.
struct TextMatrix {
  TextHeader header;
  std::vector<std::string> labels;  ///< of the columns; empty if no line names them
  char delimiter = ' ';             ///< ',' ';' tab, or ' ' for any run of blanks
  Array2 values;                    ///< (rows, columns) as stored; NaN where missing
};

/// Reads a matrix: one row a line, cells parted by ',' ';' tab or blanks (found from the first
/// row).
///
/// Before the first row, comment lines (# % //) and lines `key: value` or `key = value` make the
/// header; a line of words just before it, one for each column, labels them. Comments and empty
/// lines are passed over everywhere. Unless ',' parts the cells, it may
/// be the decimal mark. Missing samples: an empty cell, NaN, inf, Bad, --, ---, NA, N/A, null and
/// the like. A delimiter at the end of every line does not open a column.
/// @param where  the file's name, for messages.
/// @throws InputError naming the line for a ragged row or a cell that is not a number; for text in
///         UTF-16 and for a file without numbers.
TextMatrix parse_text_matrix(std::string_view text, const std::string& where);

/// True if the bytes look like text that parse_text_matrix() might read: no control codes, and a
/// line that holds numbers only.
bool looks_like_text_matrix(std::string_view head);

}  // namespace manoscope::io

#pragma once

#include <string>
#include <vector>

#include "manoscope/io/toml_document.hpp"

namespace manoscope::experiment {

/// One list of maps as a table of texts.
struct FormList {
  std::string file;                  ///< as the experiment file names it; "" = an inline list
  std::vector<std::string> columns;  ///< "pressure [Pa]"; of an inline list "pressure"
  std::vector<std::vector<std::string>> rows;  ///< as many cells as there are columns
  std::vector<int> lines;  ///< of each row, in its file; not looked at when a form is applied
  std::string locked;      ///< why the table cannot be edited as one; "" = it can

  friend bool same_table(const FormList& a, const FormList& b) {
    return a.columns == b.columns && a.rows == b.rows;
  }
};

/// The table of a CSV list, none of an empty text. A text that is no table, or with rows that do
/// not fit, comes out locked.
FormList read_csv_form(const std::string& text, const std::string& name);

/// The text of a CSV list with another table in it: comments, the head and rows that are as before
/// stay byte by byte, as does the delimiter. A row is known by its map, wherever it has moved.
/// Where that cannot be (a cell holds a line end of old machines) the table is written anew, and
/// all comments stand above it.
/// @throws InputError if a row has other cells than there are columns, or a cell cannot be written.
std::string edit_csv_list(const std::string& text, const FormList& wanted);

/// The table of an inline list: columns in the order in which the entries name them.
FormList read_inline_form(const io::TomlValue& maps);
/// An inline list in TOML's writing, one entry a line; empty cells are left out.
std::string inline_list(const FormList& wanted);

}  // namespace manoscope::experiment

#pragma once

#include <filesystem>
#include <optional>
#include <string>
#include <vector>

namespace manoscope::io {

/// One column head: "pressure [Pa]" is name "pressure", unit "Pa"; "run" has no unit.
struct CsvColumn {
  std::string name;
  std::string unit;
};

/// One row of cells as text, and where it stood in the file.
struct CsvRow {
  int line = 0;                    ///< 1-based line in the file
  std::vector<std::string> cells;  ///< as many as there are columns, trimmed
  int last_line = 0;               ///< beyond `line` where a cell has several lines
};

/// A table with a header line: text cells, to be understood by whoever knows the columns.
///
/// Delimiter ',' ';' or tab, found from the header; with ';' or tab a decimal comma is understood
/// by `cell_number`. Quotes "..." as in RFC 4180, UTF-8 byte order mark and CR LF accepted, empty
/// lines and lines that begin with '#' skipped. What spreadsheets leave behind is dropped: rows of
/// empty cells, and empty cells beyond the last named column.
struct CsvTable {
  std::filesystem::path path;
  char delimiter = ',';
  int header_line = 1;  ///< 1-based line of the column heads
  std::vector<CsvColumn> columns;
  std::vector<CsvRow> rows;

  /// Position of a column by name, nullopt if absent.
  std::optional<std::size_t> column(const std::string& name) const;
  /// The number in a cell (a decimal comma is allowed unless ',' is the delimiter), nullopt if it
  /// is not one.
  std::optional<double> cell_number(const CsvRow& row, std::size_t column) const;
};

/// @throws InputError for an unreadable file, text that is not UTF-8, no header, a duplicate
/// column,
///         or a row with more or fewer cells than the header (naming its line).
CsvTable read_csv_table(const std::filesystem::path& path);
/// The same from text already in memory; `path` only names it in messages.
CsvTable parse_csv_table(const std::string& text, const std::filesystem::path& path);

/// A row that could not be taken into the table.
struct CsvRowFault {
  int line = 0;
  std::string found, mend;
};

/// The same, but rows at fault are left out and told in `faults`: for reports of every fault at
/// once. What concerns the whole file is still thrown.
CsvTable read_csv_table(const std::filesystem::path& path, std::vector<CsvRowFault>& faults);
CsvTable parse_csv_table(const std::string& text, const std::filesystem::path& path,
                         std::vector<CsvRowFault>& faults);

}  // namespace manoscope::io

#include "manoscope/io/csv_table.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <fstream>
#include <iterator>
#include <string_view>
#include <utility>

#include "manoscope/core/error.hpp"
#include "manoscope/core/unit_text.hpp"

namespace manoscope::io {
namespace {

constexpr std::uintmax_t kLargestTable = 256u << 20;  // a list or table, never an image

std::string place(const std::filesystem::path& path, int line) {
  return fmt::format("{}:{}", path.string(), line);
}

std::string_view trim(std::string_view text) {
  const auto first = text.find_first_not_of(" \t\r\n");
  if (first == std::string_view::npos) return {};
  return text.substr(first, text.find_last_not_of(" \t\r\n") - first + 1);
}

std::string excerpt(std::string_view text) {
  constexpr std::size_t kLongest = 60;
  return text.size() <= kLongest ? std::string(text)
                                 : std::string(text.substr(0, kLongest)) + "...";
}

/// Length of the UTF-8 character that starts `text`, 0 if it is malformed.
std::size_t utf8_length(std::string_view text) {
  const auto byte = [&](std::size_t i) { return static_cast<unsigned char>(text[i]); };
  const unsigned char lead = byte(0);
  const std::size_t length = lead < 0x80                   ? 1
                             : lead >= 0xC2 && lead < 0xE0 ? 2
                             : lead >= 0xE0 && lead < 0xF0 ? 3
                             : lead >= 0xF0 && lead < 0xF5 ? 4
                                                           : 0;
  if (length == 0 || text.size() < length) return 0;
  for (std::size_t i = 1; i < length; ++i) {
    if ((byte(i) & 0xC0) != 0x80) return 0;
  }
  if (length > 2) {  // no overlong forms, no surrogates, nothing beyond U+10FFFF
    const unsigned char second = byte(1);
    if ((lead == 0xE0 && second < 0xA0) || (lead == 0xED && second > 0x9F) ||
        (lead == 0xF0 && second < 0x90) || (lead == 0xF4 && second > 0x8F)) {
      return 0;
    }
  }
  return length;
}

void check_text(std::string_view text, const std::filesystem::path& path) {
  const char* const save_as = "Save the table as plain text in UTF-8 (\"CSV UTF-8\")";
  if (text.starts_with("\xFF\xFE") || text.starts_with("\xFE\xFF")) {
    throw InputError(path.string(), "the text is UTF-16", save_as);
  }
  int line = 1;
  for (std::size_t i = 0; i < text.size();) {
    if (text[i] == '\0') {
      throw InputError(place(path, line), "a zero byte: this is not a text file", save_as);
    }
    const std::size_t length = utf8_length(text.substr(i));
    if (length == 0) {
      throw InputError(place(path, line),
                       fmt::format("byte 0x{:02X} is not UTF-8 text",
                                   static_cast<unsigned>(static_cast<unsigned char>(text[i]))),
                       save_as);
    }
    if (text[i] == '\n') ++line;
    i += length;
  }
}

/// The commonest of ';', tab and ',' in the header, outside quotes and brackets.
char find_delimiter(std::string_view text) {
  std::size_t semicolons = 0, tabs = 0, commas = 0;
  bool quoted = false, bracketed = false;
  for (const char letter : text) {
    if (letter == '"') quoted = !quoted;
    if (quoted) continue;
    if (letter == '\n' || letter == '\r') break;
    if (letter == '[') bracketed = true;
    if (letter == ']') bracketed = false;
    if (bracketed) continue;
    semicolons += letter == ';';
    tabs += letter == '\t';
    commas += letter == ',';
  }
  if (semicolons > 0 && semicolons >= tabs && semicolons >= commas) return ';';
  if (tabs > 0 && tabs >= commas) return '\t';
  return ',';
}

/// Walks through the records of a table; quoted cells may hold delimiters and line ends.
class RecordReader {
 public:
  RecordReader(std::string_view text, const std::filesystem::path& path)
      : text_(text), path_(path) {}

  void set_delimiter(char delimiter) { delimiter_ = delimiter; }
  std::string_view rest() const { return text_.substr(at_); }

  /// Moves past empty lines and comments. False at the end of the file.
  bool find_record() {
    while (at_ < text_.size()) {
      const std::size_t end = std::min(text_.find_first_of("\r\n", at_), text_.size());
      const std::string_view line = text_.substr(at_, end - at_);
      if (!line.starts_with('#') && !trim(line).empty()) return true;
      at_ = end;
      skip_line_end();
    }
    return false;
  }

  CsvRow read_record() {
    CsvRow row;
    row.line = line_;
    while (true) {
      row.cells.push_back(read_cell());
      if (at_ < text_.size() && text_[at_] == delimiter_) {
        ++at_;
        continue;
      }
      row.last_line = line_;
      skip_line_end();
      return row;
    }
  }

 private:
  std::string read_cell() {
    while (at_ < text_.size() && text_[at_] != delimiter_ &&
           (text_[at_] == ' ' || text_[at_] == '\t')) {
      ++at_;
    }
    std::string cell;
    if (at_ < text_.size() && text_[at_] == '"') {
      cell = read_quoted();
    }
    const char stops[] = {delimiter_, '\r', '\n', '\0'};
    const std::size_t end = std::min(text_.find_first_of(stops, at_), text_.size());
    cell += text_.substr(at_, end - at_);
    at_ = end;
    return std::string(trim(cell));
  }

  std::string read_quoted() {
    const int first_line = line_;
    std::string cell;
    for (++at_; at_ < text_.size(); ++at_) {
      if (text_[at_] == '"') {
        if (at_ + 1 >= text_.size() || text_[at_ + 1] != '"') {
          ++at_;
          return cell;
        }
        ++at_;
      }
      if (text_[at_] == '\n') ++line_;
      cell += text_[at_];
    }
    throw InputError(place(path_, first_line), "a quote \" that is never closed",
                     "Close it, or double it (\"\") where it belongs to the text");
  }

  void skip_line_end() {
    if (at_ >= text_.size()) return;
    if (text_[at_] == '\r' && at_ + 1 < text_.size() && text_[at_ + 1] == '\n') ++at_;
    ++at_;
    ++line_;
  }

  std::string_view text_;
  const std::filesystem::path& path_;
  std::size_t at_ = 0;
  int line_ = 1;
  char delimiter_ = ',';
};

CsvColumn parse_column(const std::string& head, const std::string& where) {
  const std::size_t open = head.rfind('[');
  if (open == std::string::npos && head.find(']') == std::string::npos) return {head, ""};
  if (open == std::string::npos || !head.ends_with(']')) {
    throw InputError(
        where, fmt::format("column head \"{}\" has a bracket without its pair", excerpt(head)),
        "Write the unit at the end in square brackets, e.g. pressure [Pa]");
  }
  return {std::string(trim(std::string_view(head).substr(0, open))),
          std::string(trim(std::string_view(head).substr(open + 1, head.size() - open - 2)))};
}

std::vector<CsvColumn> parse_header(CsvRow header, const std::filesystem::path& path) {
  const std::string where = place(path, header.line);
  while (!header.cells.empty() && header.cells.back().empty()) header.cells.pop_back();
  std::vector<CsvColumn> columns;
  for (std::size_t i = 0; i < header.cells.size(); ++i) {
    CsvColumn column = parse_column(header.cells[i], where);
    if (column.name.empty()) {
      throw InputError(where, fmt::format("column {} has no name", i + 1),
                       "Name every column in the first line, e.g. map,pressure [Pa]");
    }
    for (const CsvColumn& other : columns) {
      if (other.name == column.name) {
        throw InputError(where,
                         fmt::format("column \"{}\" stands there twice", excerpt(column.name)),
                         "Keep one of them");
      }
    }
    columns.push_back(std::move(column));
  }
  return columns;
}

bool is_empty(const CsvRow& row) {
  return std::all_of(row.cells.begin(), row.cells.end(),
                     [](const std::string& cell) { return cell.empty(); });
}

CsvRowFault wrong_cell_count(const CsvRow& row, std::size_t expected, char delimiter) {
  const bool more = row.cells.size() > expected;
  return {row.line, fmt::format("{} cells under {} columns", row.cells.size(), expected),
          more && delimiter == ','
              ? "Give every row as many cells as the header; with decimal commas, separate the "
                "columns by ';' in every line"
              : "Give every row as many cells as the header; a cell without a value stays empty"};
}

std::string read_text(const std::filesystem::path& path) {
  std::error_code error;
  const auto status = std::filesystem::status(path, error);
  const std::string name = path.string();
  if (!std::filesystem::exists(status)) {
    throw InputError(name, "there is no such file", "Check the path");
  }
  if (std::filesystem::is_directory(status)) {
    throw InputError(name, "this is a folder, not a file", "Name the table itself");
  }
  const std::uintmax_t size = std::filesystem::file_size(path, error);
  if (!error && size > kLargestTable) {
    throw InputError(name, fmt::format("{} MB: too large for a table", size >> 20),
                     "Name the table, not a map");
  }
  std::ifstream stream(path, std::ios::binary);
  if (!stream) throw InputError(name, "the file cannot be opened", "Check its read permission");
  std::string text{std::istreambuf_iterator<char>(stream), std::istreambuf_iterator<char>()};
  if (stream.bad()) throw InputError(name, "reading stopped halfway", "Check the disk");
  return text;
}

CsvTable throw_first_fault(CsvTable table, const std::vector<CsvRowFault>& faults) {
  if (!faults.empty()) {
    const CsvRowFault& fault = faults.front();
    throw InputError(place(table.path, fault.line), fault.found, fault.mend);
  }
  return table;
}

}  // namespace

std::optional<std::size_t> CsvTable::column(const std::string& name) const {
  for (std::size_t i = 0; i < columns.size(); ++i) {
    if (columns[i].name == name) return i;
  }
  return std::nullopt;
}

std::optional<double> CsvTable::cell_number(const CsvRow& row, std::size_t column) const {
  if (column >= row.cells.size()) return std::nullopt;
  std::string cell = row.cells[column];
  if (delimiter != ',' && cell.find('.') == std::string::npos) {
    if (const auto comma = cell.find(','); comma != std::string::npos) cell[comma] = '.';
  }
  return parse_number(cell);
}

CsvTable parse_csv_table(const std::string& text, const std::filesystem::path& path,
                         std::vector<CsvRowFault>& faults) {
  check_text(text, path);
  std::string_view body(text);
  if (body.starts_with("\xEF\xBB\xBF")) body.remove_prefix(3);
  CsvTable table;
  table.path = path;
  RecordReader reader(body, path);
  if (!reader.find_record()) {
    throw InputError(path.string(), body.empty() ? "the file is empty" : "there is no header line",
                     "Name the columns in the first line, e.g. map,pressure [Pa]");
  }
  table.delimiter = find_delimiter(reader.rest());
  reader.set_delimiter(table.delimiter);
  CsvRow header = reader.read_record();
  table.header_line = header.line;
  table.columns = parse_header(std::move(header), path);
  if (table.columns.empty()) {
    throw InputError(path.string(), "the header line names no column",
                     "Name the columns in the first line, e.g. map,pressure [Pa]");
  }
  const std::size_t n_columns = table.columns.size();
  while (reader.find_record()) {
    CsvRow row = reader.read_record();
    if (is_empty(row)) continue;
    while (row.cells.size() > n_columns && row.cells.back().empty()) row.cells.pop_back();
    if (row.cells.size() == n_columns) {
      table.rows.push_back(std::move(row));
    } else {
      faults.push_back(wrong_cell_count(row, n_columns, table.delimiter));
    }
  }
  return table;
}

CsvTable parse_csv_table(const std::string& text, const std::filesystem::path& path) {
  std::vector<CsvRowFault> faults;
  return throw_first_fault(parse_csv_table(text, path, faults), faults);
}

CsvTable read_csv_table(const std::filesystem::path& path, std::vector<CsvRowFault>& faults) {
  return parse_csv_table(read_text(path), path, faults);
}

CsvTable read_csv_table(const std::filesystem::path& path) {
  return parse_csv_table(read_text(path), path);
}

}  // namespace manoscope::io

#include "manoscope/experiment/form_list.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <cstddef>
#include <utility>

#include "manoscope/core/error.hpp"
#include "manoscope/core/unit_text.hpp"
#include "manoscope/experiment/align_rows.hpp"
#include "manoscope/io/csv_table.hpp"
#include "manoscope/io/toml_edit.hpp"

namespace manoscope::experiment {
namespace {

std::string head_text(const io::CsvColumn& column) {
  return column.unit.empty() ? column.name : fmt::format("{} [{}]", column.name, column.unit);
}

std::string csv_cell(const std::string& text, char delimiter) {
  const bool plain = text.find(delimiter) == std::string::npos &&
                     text.find_first_of("\"\r\n") == std::string::npos && !text.starts_with('#');
  if (plain) return text;
  std::string quoted = "\"";
  for (const char letter : text) {
    if (letter == '"') quoted += '"';
    quoted += letter;
  }
  return quoted + '"';
}

std::string csv_line(const std::vector<std::string>& cells, char delimiter) {
  std::string line;
  for (std::size_t i = 0; i < cells.size(); ++i) {
    if (i > 0) line += delimiter;
    line += csv_cell(cells[i], delimiter);
  }
  return line;
}

/// Lines with their ends: a line feed, behind a carriage return or not, or that alone.
std::vector<std::string> lines_of(const std::string& text) {
  std::vector<std::string> lines;
  for (std::size_t at = 0; at < text.size();) {
    std::size_t next = std::min(text.find_first_of("\r\n", at), text.size() - 1) + 1;
    if (text[next - 1] == '\r' && next < text.size() && text[next] == '\n') ++next;
    lines.push_back(text.substr(at, next - at));
    at = next;
  }
  return lines;
}

/// All that may be a comment of a table, a line each.
std::string comments_of(const std::string& text, const std::string& end) {
  std::string comments;
  for (const std::string& line : lines_of(text)) {
    if (line.starts_with('#')) comments += line.substr(0, line.find_first_of("\r\n")) + end;
  }
  return comments;
}

void check_cells(const FormList& wanted) {
  for (std::size_t i = 0; i < wanted.rows.size(); ++i) {
    if (wanted.rows[i].size() == wanted.columns.size()) continue;
    throw InputError(wanted.file,
                     fmt::format("row {} has {} cells, the table {} columns", i + 1,
                                 wanted.rows[i].size(), wanted.columns.size()),
                     "Give every row a cell for every column");
  }
}

std::string whole_table(const FormList& wanted, char delimiter, const std::string& end) {
  std::string text = csv_line(wanted.columns, delimiter) + end;
  for (const auto& row : wanted.rows) text += csv_line(row, delimiter) + end;
  return text;
}

}  // namespace

FormList read_csv_form(const std::string& text, const std::string& name) {
  FormList list;
  list.file = name;
  if (text.empty()) return list;
  std::vector<io::CsvRowFault> faults;
  try {
    const io::CsvTable table = io::parse_csv_table(text, name, faults);
    for (const io::CsvColumn& column : table.columns) list.columns.push_back(head_text(column));
    for (const io::CsvRow& row : table.rows) {
      list.rows.push_back(row.cells);
      list.lines.push_back(row.line);
    }
  } catch (const InputError& error) {
    list.locked = fmt::format("{}. {}", error.found(), error.mend());
  }
  if (!faults.empty()) {
    list.locked = fmt::format("line {}: {}. {}", faults[0].line, faults[0].found, faults[0].mend);
  }
  return list;
}

std::string edit_csv_list(const std::string& text, const FormList& wanted) {
  check_cells(wanted);
  const FormList old = read_csv_form(text, wanted.file);
  if (old.locked.empty() && same_table(old, wanted)) return text;
  if (!old.locked.empty()) {
    throw InputError(wanted.file, old.locked, "Mend the text of the list first");
  }
  if (text.empty()) return whole_table(wanted, ',', "\n");
  const io::CsvTable table = io::parse_csv_table(text, wanted.file);
  const std::string end = text.find("\r\n") == std::string::npos ? "\n" : "\r\n";
  std::vector<std::string> lines = lines_of(text);
  if (lines.back().find_last_of("\r\n") == std::string::npos) lines.back() += end;
  // Rows are taken out of the lines, and put behind the line in which they, or those before, ended.
  std::vector<std::string> rows(lines.size());
  const auto behind = [&](int number) -> std::string& {
    return rows[static_cast<std::size_t>(number - 1)];
  };
  const auto take_out = [&](const io::CsvRow& row) {
    std::string taken;
    for (int number = row.line; number <= row.last_line; ++number) {
      taken += std::exchange(lines[static_cast<std::size_t>(number - 1)], "");
    }
    return taken;
  };
  std::vector<std::string> before;
  for (const io::CsvRow& row : table.rows) before.push_back(take_out(row));
  const bool same_columns = old.columns == wanted.columns;
  if (!same_columns) {
    lines[static_cast<std::size_t>(table.header_line - 1)] =
        csv_line(wanted.columns, table.delimiter) + end;
  }
  const auto old_rows = align_rows(old, wanted);
  int last = table.header_line;
  for (std::size_t i = 0; i < wanted.rows.size(); ++i) {
    const auto k = old_rows[i];
    if (k) last = table.rows[*k].last_line;
    const bool same = k && same_columns && old.rows[*k] == wanted.rows[i];
    behind(last) += same ? before[*k] : csv_line(wanted.rows[i], table.delimiter) + end;
  }
  std::string changed;
  for (std::size_t i = 0; i < lines.size(); ++i) changed += lines[i] + rows[i];
  const FormList read = read_csv_form(changed, wanted.file);
  if (!read.locked.empty() || !same_table(read, wanted)) {
    changed = comments_of(text, end) + whole_table(wanted, table.delimiter, end);
    if (!same_table(read_csv_form(changed, wanted.file), wanted)) {
      throw InputError(wanted.file, "a cell or a head that a table cannot hold",
                       "Write plain texts without blanks around them, and no row without any text");
    }
  }
  return changed;
}

FormList read_inline_form(const io::TomlValue& maps) {
  FormList list;
  for (const io::TomlValue& entry : maps.items) {
    if (entry.kind != io::TomlValue::Kind::table) {
      list.locked = fmt::format("line {}: {} is no map", entry.line, io::toml_quoted(entry.text));
    }
    for (const std::string& key : entry.keys) {
      if (std::find(list.columns.begin(), list.columns.end(), key) == list.columns.end()) {
        list.columns.push_back(key);
      }
    }
  }
  for (const io::TomlValue& entry : maps.items) {
    std::vector<std::string> row;
    for (const std::string& column : list.columns) {
      const io::TomlValue* value = entry.find(column);
      row.push_back(value == nullptr ? "" : value->text);
    }
    list.rows.push_back(std::move(row));
    list.lines.push_back(entry.line);
  }
  return list;
}

std::string inline_list(const FormList& wanted) {
  check_cells(wanted);
  std::string text = "[";
  for (const auto& row : wanted.rows) {
    std::string entry;
    for (std::size_t i = 0; i < row.size(); ++i) {
      const std::string& name = wanted.columns[i];
      if (row[i].empty()) continue;
      const bool bare = (name == "sequence" || name == "repeat") && parse_number(row[i]);
      entry += fmt::format("{}{} = {}", entry.empty() ? "" : ", ", name,
                           bare ? row[i] : io::toml_quoted(row[i]));
    }
    text += "\n  {" + entry + "},";
  }
  return text + (wanted.rows.empty() ? "]" : "\n]");
}

}  // namespace manoscope::experiment

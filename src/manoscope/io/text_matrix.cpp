#include "manoscope/io/text_matrix.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <array>
#include <charconv>
#include <cmath>
#include <cstring>
#include <limits>
#include <optional>
#include <utility>

#include "manoscope/core/error.hpp"
#include "manoscope/io/file_text.hpp"
#include "manoscope/io/file_units.hpp"

namespace manoscope::io {
namespace {

constexpr double kMissing = std::numeric_limits<double>::quiet_NaN();

bool is_blank(char letter) { return letter == ' ' || letter == '\t' || letter == '\r'; }

std::string_view strip(std::string_view text) {
  while (!text.empty() && is_blank(text.front())) text.remove_prefix(1);
  while (!text.empty() && is_blank(text.back())) text.remove_suffix(1);
  return text;
}

bool is_comment(std::string_view line) {
  return line.starts_with('#') || line.starts_with('%') || line.starts_with("//");
}

/// Lines of a text ended by LF, CR LF or CR, counted from 1.
class Lines {
 public:
  explicit Lines(std::string_view text) : rest_(text) {
    if (rest_.starts_with("\xEF\xBB\xBF")) rest_.remove_prefix(3);
    // CR alone ends the lines only where there is no LF at all.
    end_ = rest_.find('\n') == std::string_view::npos ? '\r' : '\n';
  }
  bool next(std::string_view& line) {
    if (rest_.empty()) return false;
    const void* found = std::memchr(rest_.data(), end_, rest_.size());
    const std::size_t length =
        found == nullptr ? rest_.size()
                         : static_cast<std::size_t>(static_cast<const char*>(found) - rest_.data());
    line = strip_end(rest_.substr(0, length));
    rest_.remove_prefix(found == nullptr ? length : length + 1);
    ++number_;
    return true;
  }
  int number() const { return number_; }

 private:
  static std::string_view strip_end(std::string_view line) {
    while (line.ends_with('\r')) line.remove_suffix(1);
    return line;
  }
  std::string_view rest_;
  char end_ = '\n';
  int number_ = 0;
};

bool is_missing_word(std::string_view cell) {
  constexpr std::array<std::string_view, 18> kWords{
      "",     "nan",     "bad", "--",      "---",      "na",  "n/a",     "null", "none",
      "void", "missing", "***", "1.#qnan", "-1.#qnan", "#na", "-1.#ind", "-nan", "masked"};
  if (cell.size() > 8) return false;
  const std::string lower = lower_case(cell);
  return std::find(kWords.begin(), kWords.end(), lower) != kWords.end() || lower == "inf" ||
         lower == "-inf" || lower == "1.#inf" || lower == "-1.#inf" || lower == "-1.#ind00";
}

/// The value of one cell; NaN for a missing one, nullopt for what is neither.
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

/// Hands out the cells of one line.
class Cells {
 public:
  Cells(std::string_view line, char delimiter)
      : rest_(delimiter == '\t' ? line : strip(line)), delimiter_(delimiter) {}

  bool next(std::string_view& cell) {
    if (done_) return false;
    if (delimiter_ == ' ') {
      std::size_t length = 0;
      while (length < rest_.size() && !is_blank(rest_[length])) ++length;
      cell = rest_.substr(0, length);
      while (length < rest_.size() && is_blank(rest_[length])) ++length;
      rest_.remove_prefix(length);
      done_ = rest_.empty();
      return true;
    }
    const auto end = rest_.find(delimiter_);
    cell = strip(rest_.substr(0, end));
    done_ = end == std::string_view::npos;
    if (!done_) rest_.remove_prefix(end + 1);
    return true;
  }

 private:
  std::string_view rest_;
  char delimiter_;
  bool done_ = false;
};

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

/// True if every cell is a number or a missing sample. A row may begin with missing samples, or
/// hold nothing else: words such as "Bad" and "nan" count, others do not.
bool may_be_row(std::string_view line) {
  const char delimiter = delimiter_of(line);
  Cells cells(line, delimiter);
  std::size_t n_cells = 0, n_numbers = 0;
  for (std::string_view cell; cells.next(cell); ++n_cells) {
    const auto value = cell_value(cell, delimiter != ',');
    if (!value) return false;
    n_numbers += std::isfinite(*value) ? 1 : 0;
  }
  return n_numbers > 0 || n_cells > 1;
}

/// Two passes: the first finds header, delimiter and shape, so that the second fills memory of the
/// right size.
class Parser {
 public:
  Parser(std::string_view text, std::string where) : text_(text), where_(std::move(where)) {}

  TextMatrix run() {
    survey();
    if (n_rows_ == 0) {
      throw InputError(where_, "holds no numbers", "Give a matrix of heights, one row a line");
    }
    // Each value takes two bytes of text or more, but for empty cells.
    if (n_columns_ * n_rows_ > std::max<std::size_t>(1024, text_.size() / 2 + 1)) {
      throw InputError(
          where_,
          fmt::format("its first row has {} cells and {} lines follow, too many for {} "
                      "bytes unless nearly all are empty",
                      n_columns_, n_rows_ - 1, text_.size()),
          "Export the map again");
    }
    check_pixel_counts(static_cast<double>(n_columns_), static_cast<double>(n_rows_), where_);
    matrix_.values.resize(static_cast<Index>(n_rows_), static_cast<Index>(n_columns_));
    fill();
    return std::move(matrix_);
  }

 private:
  std::string place(const Lines& lines) const {
    return fmt::format("{}:{}", where_, lines.number());
  }

  /// Reads the header and the shape: columns of the first row, number of rows.
  void survey() {
    Lines lines(text_);
    bool in_header = true;
    for (std::string_view line; lines.next(line);) {
      const std::string_view bare = strip(line);
      if (bare.empty()) continue;
      if (in_header) {
        if (is_comment(bare)) {
          static_cast<void>(read_header_line(bare, matrix_.header, place(lines)));
          continue;
        }
        if (!may_be_row(line)) {
          if (!read_header_line(bare, matrix_.header, place(lines))) {
            throw InputError(
                place(lines),
                fmt::format("\"{}\" is neither a row of numbers nor a header line", excerpt(bare)),
                "Put # before header lines; write numbers as 1.5e-6 or 1,5e-6");
          }
          continue;
        }
        in_header = false;
        first_line_ = lines.number();
        matrix_.delimiter = delimiter_of(line);
        Cells cells(line, matrix_.delimiter);
        for (std::string_view cell; cells.next(cell);) ++n_columns_;
      } else if (is_comment(bare)) {
        continue;
      }
      ++n_rows_;
    }
  }

  void fill() {
    Lines lines(text_);
    Index row = 0;
    bool last_cell_always_empty = true;
    const bool comma_is_decimal = matrix_.delimiter != ',';
    for (std::string_view line; lines.next(line);) {
      if (lines.number() < first_line_) continue;
      const std::string_view bare = strip(line);
      if (bare.empty() || is_comment(bare)) continue;
      double* out = matrix_.values.data() + row * matrix_.values.cols();
      Cells cells(line, matrix_.delimiter);
      std::size_t n_cells = 0;
      std::string_view cell;
      while (cells.next(cell)) {
        if (n_cells < n_columns_) {
          const auto value = cell_value(cell, comma_is_decimal);
          if (!value) {
            throw InputError(
                place(lines),
                fmt::format("\"{}\" in column {} is not a number", excerpt(cell), n_cells + 1),
                "Write numbers as 1.5e-6 and missing samples as nan");
          }
          out[n_cells] = *value;
        }
        ++n_cells;
      }
      if (n_cells != n_columns_) {
        throw InputError(place(lines),
                         fmt::format("has {} values, the first row (line {}) has {}", n_cells,
                                     first_line_, n_columns_),
                         "Every row must have as many values; write missing ones as nan");
      }
      last_cell_always_empty = last_cell_always_empty && cell.empty();
      ++row;
    }
    MANO_ASSERT(row == matrix_.values.rows());
    if (last_cell_always_empty && n_columns_ > 1) {
      const Array2 kept = matrix_.values.leftCols(matrix_.values.cols() - 1);
      matrix_.values = kept;
    }
  }

  std::string_view text_;
  std::string where_;
  TextMatrix matrix_;
  std::size_t n_columns_ = 0, n_rows_ = 0;
  int first_line_ = 0;
};

}  // namespace

TextMatrix parse_text_matrix(std::string_view text, const std::string& where) {
  if (text.starts_with("\xFF\xFE") || text.starts_with("\xFE\xFF")) {
    throw InputError(where, "the text is UTF-16", "Save it as plain text in UTF-8");
  }
  if (text.find('\0') != std::string_view::npos) {
    throw InputError(where, "holds NUL bytes: it is not plain text",
                     "Export the map as text again");
  }
  return Parser(text, where).run();
}

bool looks_like_text_matrix(std::string_view head) {
  for (const char letter : head) {
    const auto byte = static_cast<unsigned char>(letter);
    if (byte < 0x20 && letter != '\t' && letter != '\r' && letter != '\n') return false;
  }
  Lines lines(head);
  bool any_row = false;
  std::string_view line, before;
  // The head may end within a line: the last one is not looked at unless it is the only one.
  while (lines.next(line)) {
    if (!before.empty()) any_row = any_row || may_be_row(before);
    before = is_comment(strip(line)) ? std::string_view() : line;
  }
  if (lines.number() == 1 && !before.empty()) {
    const auto cut = before.find_last_of(" \t,;");
    before = before.substr(0, cut == std::string_view::npos ? before.size() : cut);
  }
  return any_row || (!before.empty() && may_be_row(before));
}

}  // namespace manoscope::io

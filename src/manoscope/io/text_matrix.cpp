#include "manoscope/io/text_matrix.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <optional>
#include <utility>

#include "manoscope/core/error.hpp"
#include "manoscope/io/file_text.hpp"
#include "manoscope/io/file_units.hpp"
#include "manoscope/io/text_cells.hpp"

namespace manoscope::io {
namespace {

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
    if (n_rows_ == 0 && !labels_.empty()) throw not_a_header();
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
          // A line of words may label the columns, if the next row has as many cells.
          if (!labels_.empty()) throw not_a_header();
          if (!read_header_line(bare, matrix_.header, place(lines))) {
            labels_ = line;
            labels_place_ = place(lines);
          }
          continue;
        }
        in_header = false;
        first_line_ = lines.number();
        matrix_.delimiter = delimiter_of(line);
        Cells cells(line, matrix_.delimiter);
        for (std::string_view cell; cells.next(cell);) ++n_columns_;
        keep_labels();
      } else if (is_comment(bare)) {
        continue;
      }
      ++n_rows_;
    }
  }

  InputError not_a_header() const {
    return {labels_place_,
            fmt::format("\"{}\" is neither a row of numbers nor a header line", excerpt(labels_)),
            "Put # before header lines; write numbers as 1.5e-6 or 1,5e-6"};
  }

  void keep_labels() {
    if (labels_.empty()) return;
    Cells cells(labels_, matrix_.delimiter);
    for (std::string_view cell; cells.next(cell);) {
      if (matrix_.labels.size() == n_columns_) throw not_a_header();
      matrix_.labels.emplace_back(cell.substr(0, 200));
    }
    if (matrix_.labels.size() != n_columns_) throw not_a_header();
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
      if (!matrix_.labels.empty()) matrix_.labels.pop_back();
    }
  }

  std::string_view text_;
  std::string where_;
  TextMatrix matrix_;
  std::string_view labels_;
  std::string labels_place_;
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

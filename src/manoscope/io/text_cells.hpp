#pragma once

// Lines, cells and numbers of text maps: for the readers of this folder.

#include <cstring>
#include <optional>
#include <string>
#include <string_view>

namespace manoscope::io {

/// True for blank, tab and carriage return.
bool is_blank(char letter);

/// Without is_blank() letters at both ends.
std::string_view strip(std::string_view text);

/// True for a line that begins with # % or //.
bool is_comment(std::string_view line);

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

/// The value of one cell; NaN for a missing one (an empty cell, nan, Bad, -- and the like), nullopt
/// for what is neither.
std::optional<double> cell_value(std::string_view cell, bool comma_is_decimal);

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

/// The sign between the cells of a row: ';' ',' tab, or ' ' for any run of blanks.
char delimiter_of(std::string_view row);

/// The text in UTF-8 where a byte order mark says that it is UTF-16; else as it is.
std::string utf8_text(std::string bytes);

}  // namespace manoscope::io

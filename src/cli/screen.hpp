#pragma once

#include <string>

namespace manoscope::cli {

/// Columns taken where nobody tells how many there are: pipes and files, too.
inline constexpr int kUsualColumns = 80;

/// What is known of where a text will be read.
struct Screen {
  bool terminal = false;  ///< lines longer than `columns` are broken by it
  bool moves = false;     ///< a terminal that knows the codes of cursor and colour
  bool colour = false;
  int columns = kUsualColumns;
};

/// What the environment says; null where a variable is not set.
struct ScreenWishes {
  const char* columns = nullptr;   ///< COLUMNS
  const char* no_color = nullptr;  ///< NO_COLOR: no colour unless empty
  const char* term = nullptr;      ///< TERM: "dumb" knows no codes
};

/// @param own_columns  what the terminal itself says, 0 if nothing; COLUMNS goes before it.
Screen screen_from(bool terminal, int own_columns, const ScreenWishes& wishes);
/// Of an open file descriptor, now: a window may have changed since.
Screen screen_of(int descriptor);

enum class Colour { none, green, yellow, red };
/// The text in that colour if the screen shows any.
std::string coloured(const std::string& text, Colour colour, const Screen& screen);

}  // namespace manoscope::cli

#include "screen.hpp"

#include <fmt/format.h>
#include <sys/ioctl.h>
#include <unistd.h>

#include <charconv>
#include <cstdlib>
#include <string_view>
#include <system_error>

namespace manoscope::cli {
namespace {

/// A whole number of columns; 0 where the text is none.
int columns_in(const char* text) {
  if (text == nullptr) return 0;
  const std::string_view digits(text);
  int columns = 0;
  const auto [end, fault] = std::from_chars(digits.data(), digits.data() + digits.size(), columns);
  const bool whole = fault == std::errc{} && end == digits.data() + digits.size();
  return whole && columns > 0 ? columns : 0;
}

bool is_set(const char* text) { return text != nullptr && *text != '\0'; }

}  // namespace

Screen screen_from(bool terminal, int own_columns, const ScreenWishes& wishes) {
  Screen screen;
  if (!terminal) return screen;
  screen.terminal = true;
  screen.moves = is_set(wishes.term) && std::string_view(wishes.term) != "dumb";
  screen.colour = screen.moves && !is_set(wishes.no_color);
  const int wished = columns_in(wishes.columns);
  if (wished > 0 || own_columns > 0) screen.columns = wished > 0 ? wished : own_columns;
  return screen;
}

Screen screen_of(int descriptor) {
  winsize window{};
  const bool told = ioctl(descriptor, TIOCGWINSZ, &window) == 0;
  return screen_from(isatty(descriptor) == 1, told ? window.ws_col : 0,
                     {std::getenv("COLUMNS"), std::getenv("NO_COLOR"), std::getenv("TERM")});
}

std::string coloured(const std::string& text, Colour colour, const Screen& screen) {
  constexpr int kCodes[] = {0, 32, 33, 31};
  if (!screen.colour || colour == Colour::none) return text;
  return fmt::format("\033[{}m{}\033[0m", kCodes[static_cast<std::size_t>(colour)], text);
}

}  // namespace manoscope::cli

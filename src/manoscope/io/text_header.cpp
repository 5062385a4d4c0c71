#include "manoscope/io/text_header.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <array>
#include <cmath>

#include "manoscope/core/error.hpp"
#include "manoscope/core/unit_text.hpp"
#include "manoscope/io/file_text.hpp"
#include "manoscope/io/file_units.hpp"

namespace manoscope::io {
namespace {

enum class Key { none, name, size_x, size_y, pitch, pitch_x, pitch_y, unit };

struct Spelling {
  std::string_view text;  ///< small letters, words parted by one blank
  Key key;
};

constexpr std::array kSpellings{
    Spelling{"channel", Key::name},
    Spelling{"kanal", Key::name},
    Spelling{"title", Key::name},
    Spelling{"titel", Key::name},
    Spelling{"width", Key::size_x},
    Spelling{"breite", Key::size_x},
    Spelling{"size x", Key::size_x},
    Spelling{"x size", Key::size_x},
    Spelling{"xreal", Key::size_x},
    Spelling{"height", Key::size_y},
    Spelling{"h\xC3\xB6he", Key::size_y},
    Spelling{"h\xF6he", Key::size_y},
    Spelling{"hoehe", Key::size_y},
    Spelling{"size y", Key::size_y},
    Spelling{"y size", Key::size_y},
    Spelling{"yreal", Key::size_y},
    Spelling{"pitch x", Key::pitch_x},
    Spelling{"x pitch", Key::pitch_x},
    Spelling{"pixel size x", Key::pitch_x},
    Spelling{"pitch y", Key::pitch_y},
    Spelling{"y pitch", Key::pitch_y},
    Spelling{"pixel size y", Key::pitch_y},
    Spelling{"pitch", Key::pitch},
    Spelling{"pixel size", Key::pitch},
    Spelling{"unit", Key::unit},
    Spelling{"units", Key::unit},
    Spelling{"value unit", Key::unit},
    Spelling{"value units", Key::unit},
    Spelling{"height unit", Key::unit},
    Spelling{"height units", Key::unit},
    Spelling{"z unit", Key::unit},
    Spelling{"z units", Key::unit},
    Spelling{"zunits", Key::unit},
    Spelling{"einheit", Key::unit},
    Spelling{"einheiten", Key::unit},
    Spelling{"werteinheit", Key::unit},
    Spelling{"werteinheiten", Key::unit},
};

Key key_of(std::string_view text) {
  std::string key = lower_case(trimmed(text));
  for (char& letter : key) {
    if (letter == '_' || letter == '-' || letter == '\t') letter = ' ';
  }
  const auto found = std::find_if(kSpellings.begin(), kSpellings.end(),
                                  [&](const Spelling& spelling) { return spelling.text == key; });
  return found == kSpellings.end() ? Key::none : found->key;
}

/// A number with a unit of length; nullopt where the number has no unit or counts pixels.
std::optional<Length> length_of(std::string_view value, std::string_view key,
                                const std::string& where) {
  const auto fail = [&]() -> InputError {
    return {where, fmt::format("{} is \"{}\", not a length", excerpt(key), excerpt(value)),
            "Write it with its unit, e.g. 16.3 mm"};
  };
  std::string_view rest = trimmed(value);
  const auto number_end = std::min(rest.find_first_not_of("+-0123456789.,eE"), rest.size());
  std::string number(rest.substr(0, number_end));
  const std::string unit = unit_from_file(rest.substr(number_end));
  if (number.find('.') == std::string::npos) std::replace(number.begin(), number.end(), ',', '.');
  const auto amount = parse_number(number);
  if (!amount || !std::isfinite(*amount)) throw fail();
  const std::string small_unit = lower_case(unit);
  if (unit.empty() || small_unit == "px" || small_unit == "pixel" || small_unit == "pixels") {
    return std::nullopt;
  }
  const auto scale = length_scale(unit);
  if (!scale || !(std::abs(scale->factor) < 1e30) || !(std::abs(*amount) < 1e30)) throw fail();
  const double length = scale->to_si(*amount);
  if (!(length > 0.0)) throw fail();
  return Length::from_si(length);
}

template <class T>
void set_once(std::optional<T>& slot, const std::optional<T>& value, std::string_view key,
              const std::string& where) {
  if (!value) return;
  if (slot && !(*slot == *value)) {
    throw InputError(where, fmt::format("{} contradicts an earlier line", excerpt(key)),
                     "Keep one of the two");
  }
  slot = value;
}

}  // namespace

bool read_header_line(std::string_view line, TextHeader& header, const std::string& where) {
  const auto start = line.find_first_not_of("#%;/* \t\r");
  if (start == std::string_view::npos) return false;
  line.remove_prefix(start);
  const auto separator = line.find_first_of(":=");
  if (separator == std::string_view::npos || separator == 0) return false;
  const std::string_view key = line.substr(0, separator);
  const std::string_view value = trimmed(line.substr(separator + 1));
  switch (key_of(key)) {
    case Key::none:
      break;
    case Key::name:
      header.name = one_line(value);
      break;
    case Key::size_x:
      set_once(header.size_x, length_of(value, key, where), key, where);
      break;
    case Key::size_y:
      set_once(header.size_y, length_of(value, key, where), key, where);
      break;
    case Key::pitch_x:
    case Key::pitch_y:
    case Key::pitch: {
      const auto pitch = length_of(value, key, where);
      if (!pitch) {
        throw InputError(where,
                         fmt::format("{} is \"{}\", without a unit", excerpt(key), excerpt(value)),
                         "Write it with its unit, e.g. 1.5 um");
      }
      if (key_of(key) != Key::pitch_y) set_once(header.pitch_x, pitch, key, where);
      if (key_of(key) != Key::pitch_x) set_once(header.pitch_y, pitch, key, where);
      break;
    }
    case Key::unit: {
      if (!header.unit.empty() && header.unit != value) {
        throw InputError(where, fmt::format("{} contradicts an earlier line", excerpt(key)),
                         "Keep one of the two");
      }
      header.unit = std::string(value);
      break;
    }
  }
  return true;
}

}  // namespace manoscope::io

#include "manoscope/experiment/file_name_guess.hpp"

#include <algorithm>
#include <array>
#include <cctype>
#include <cmath>

#include "manoscope/core/unit_text.hpp"

namespace manoscope::experiment {
namespace {

bool is_digit(char letter) { return letter >= '0' && letter <= '9'; }
/// Bytes beyond ASCII count as letters, so that no name is cut within one.
bool is_letter(char letter) {
  return std::isalpha(static_cast<unsigned char>(letter)) != 0 ||
         static_cast<unsigned char>(letter) >= 0x80;
}

std::string lower(std::string_view text) {
  std::string result(text);
  for (char& letter : result) {
    letter = static_cast<char>(std::tolower(static_cast<unsigned char>(letter)));
  }
  return result;
}

/// Reads a name from left to right; what it takes it moves past.
class Scanner {
 public:
  explicit Scanner(std::string_view text, std::size_t at = 0) : text_(text), at_(at) {}

  std::size_t at() const { return at_; }
  char next() const { return at_ < text_.size() ? text_[at_] : '\0'; }
  char next_but(std::size_t n) const { return at_ + n < text_.size() ? text_[at_ + n] : '\0'; }

  std::string digits() {
    std::string taken;
    while (is_digit(next())) taken += text_[at_++];
    return taken;
  }
  bool take_any_of(std::string_view letters) {
    if (next() == '\0' || letters.find(next()) == std::string_view::npos) return false;
    ++at_;
    return true;
  }
  /// Capitals do not matter.
  bool take_word(std::string_view word) {
    if (lower(text_.substr(at_, word.size())) != lower(word)) return false;
    at_ += word.size();
    return true;
  }
  bool at_end_of_word() const { return !is_letter(next()) && !is_digit(next()); }

 private:
  std::string_view text_;
  std::size_t at_;
};

std::optional<double> scan_number(Scanner& scan) {
  std::string number = scan.digits();
  if (number.empty()) return std::nullopt;
  if (std::string_view(".,pP").find(scan.next()) != std::string_view::npos &&
      is_digit(scan.next_but(1))) {
    scan.take_any_of(".,pP");
    number += '.' + scan.digits();
  }
  const bool sign = scan.next_but(1) == '-' || scan.next_but(1) == '+';
  if ((scan.next() == 'e' || scan.next() == 'E') && is_digit(scan.next_but(sign ? 2 : 1))) {
    scan.take_any_of("eE");
    number += 'e';
    if (scan.next() == '-') number += '-';
    scan.take_any_of("+-");
    number += scan.digits();
  }
  const auto value = parse_number(number);
  constexpr double kAbsurd = 1e12;
  return value && std::abs(*value) < kAbsurd ? value : std::nullopt;
}

struct Unit {
  const char* word;
  const char* unit;  ///< as the unit library spells it
};

std::optional<double> scan_pressure_unit(Scanner& scan) {
  // Longer words first: "mmH2O" before any that begins it.
  static constexpr Unit kUnits[] = {
      {"mmh2o", "mmH2O"}, {"cmh2o", "cmH2O"}, {"mmhg", "mmHg"}, {"mbar", "mbar"}, {"ubar", "ubar"},
      {"µbar", "ubar"},   {"torr", "torr"},   {"bar", "bar"},   {"hpa", "hPa"},   {"kpa", "kPa"},
      {"psi", "psi"},     {"atm", "atm"},     {"mpa", "MPa"},   {"pa", "Pa"}};
  for (const Unit& unit : kUnits) {
    Scanner trial = scan;
    const bool small_m = scan.next() == 'm';
    if (!trial.take_word(unit.word) || !trial.at_end_of_word()) continue;
    if (std::string_view(unit.word) == "mpa" && small_m) return std::nullopt;
    const auto scale = unit_scale(unit.unit, "Pa");
    if (!scale) continue;
    scan = trial;
    return scale->factor;
  }
  return std::nullopt;
}

/// m3 of the volume unit that comes next.
std::optional<double> scan_volume(Scanner& scan) {
  struct Volume {
    const char* word;
    double cubic_metres;
  };
  static constexpr Volume kVolumes[] = {{"ul", 1e-9}, {"µl", 1e-9}, {"μl", 1e-9}, {"nl", 1e-12},
                                        {"ml", 1e-6}, {"cc", 1e-6}, {"l", 1e-3}};
  for (const Volume& volume : kVolumes) {
    if (scan.take_word(volume.word)) return volume.cubic_metres;
  }
  return std::nullopt;
}

std::optional<double> scan_flow_rate_unit(Scanner& scan) {
  Scanner trial = scan;
  const auto volume = scan_volume(trial);
  if (!volume) return std::nullopt;
  const Scanner after_volume = trial;
  struct TimeUnit {
    const char* word;
    double seconds;
  };
  static constexpr TimeUnit kTimes[] = {{"minute", 60.0}, {"min", 60.0}, {"sec", 1.0},
                                        {"hr", 3600.0},   {"m", 60.0},   {"s", 1.0},
                                        {"h", 3600.0}};
  for (const char* between : {"", "_per_", "-per-", " per ", "per", "p", "/", "_", "-", " "}) {
    Scanner start = after_volume;
    if (!start.take_word(between)) continue;
    for (const TimeUnit& time : kTimes) {
      Scanner end = start;
      if (!end.take_word(time.word) || !end.at_end_of_word()) continue;
      scan = end;
      return *volume / time.seconds;
    }
  }
  if (!after_volume.at_end_of_word()) return std::nullopt;
  scan = after_volume;
  return *volume / 60.0;
}

/// A sign counts only where no hyphen is expected.
bool is_sign(std::string_view stem, std::size_t at) {
  return stem[at] == '-' &&
         (at == 0 || std::string_view("_= ").find(stem[at - 1]) != std::string_view::npos);
}

FileNameGuess::List list_of_first_word(std::string_view stem) {
  using List = FileNameGuess::List;
  const auto end = std::find_if_not(stem.begin(), stem.end(), is_letter);
  const std::string word = lower(stem.substr(0, static_cast<std::size_t>(end - stem.begin())));
  const auto is_in = [&](const auto& words) {
    return std::find(words.begin(), words.end(), word) != words.end();
  };
  static constexpr std::array<std::string_view, 9> kRest{
      "h", "hydro", "hydrostatic", "static", "p", "pressure", "cal", "calib", "calibration"};
  static constexpr std::array<std::string_view, 4> kFlow{"f", "flow", "q", "run"};
  return is_in(kRest) ? List::hydrostatic : is_in(kFlow) ? List::flow : List::unknown;
}

/// Without the extension; ".5mbar" at the end is none.
std::string_view stem_of(std::string_view name) {
  const auto dot = name.rfind('.');
  if (dot == std::string_view::npos || dot == 0 || dot + 1 >= name.size()) return name;
  return is_letter(name[dot + 1]) ? name.substr(0, dot) : name;
}

template <class Q>
void note(std::optional<Q>& slot, std::string& slot_text, Q value, std::string_view text,
          bool& ambiguous) {
  ambiguous = ambiguous || (slot && !(*slot == value));
  if (!slot) slot_text = text;
  slot = value;
}

}  // namespace

FileNameGuess guess_from_file_name(std::string_view file_name) {
  const std::string_view stem = stem_of(file_name);
  FileNameGuess guess;
  for (std::size_t i = 0; i < stem.size(); ++i) {
    const bool signed_number = is_sign(stem, i);
    const std::size_t first_digit = signed_number ? i + 1 : i;
    if (first_digit >= stem.size() || !is_digit(stem[first_digit])) continue;
    if (i > 0 && is_digit(stem[i - 1])) continue;
    Scanner scan(stem, first_digit);
    const auto number = scan_number(scan);
    if (!number) {
      i = scan.at() - 1;
      continue;
    }
    scan.take_any_of(" _-");
    const double value = signed_number ? -*number : *number;
    if (const auto pascals = scan_pressure_unit(scan)) {
      note(guess.pressure, guess.pressure_text, Pressure::from_si(value * *pascals),
           stem.substr(i, scan.at() - i), guess.ambiguous);
    } else if (const auto rate = scan_flow_rate_unit(scan)) {
      note(guess.flow_rate, guess.flow_rate_text, FlowRate::from_si(*number * *rate),
           stem.substr(i, scan.at() - i), guess.ambiguous);
    } else {
      continue;
    }
    i = scan.at() - 1;
  }
  guess.list = guess.flow_rate  ? FileNameGuess::List::flow
               : guess.pressure ? FileNameGuess::List::hydrostatic
                                : list_of_first_word(stem);
  return guess;
}

}  // namespace manoscope::experiment

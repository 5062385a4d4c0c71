#include "manoscope/io/file_units.hpp"

#include <fmt/format.h>

#include <bit>
#include <cmath>
#include <cstdint>
#include <limits>

#include "manoscope/core/error.hpp"
#include "manoscope/io/file_text.hpp"

namespace manoscope::io {
namespace {

/// The text with every Latin-1 letter of units replaced by its UTF-8 form.
std::string utf8(std::string_view text) {
  std::string out;
  for (std::size_t i = 0; i < text.size(); ++i) {
    const auto byte = static_cast<unsigned char>(text[i]);
    const auto before = i > 0 ? static_cast<unsigned char>(text[i - 1]) : 0;
    const auto after = i + 1 < text.size() ? static_cast<unsigned char>(text[i + 1]) : 0;
    if (byte == 0xB5 && before < 0x80) {
      out += "\xC2\xB5";  // micro sign; inside UTF-8 it follows another byte above 0x7f
    } else if (byte == 0xC5 && after < 0x80) {
      out += "\xC3\x85";  // A with ring
    } else {
      out += text[i];
    }
  }
  return out;
}

/// False for numbers that no unit has, and that would overflow where the unit is parsed: "1e308".
bool has_plausible_numbers(std::string_view unit) {
  int n_digits = 0, n_exponent_digits = 0;
  bool in_exponent = false;
  for (const char letter : unit) {
    const bool is_digit = letter >= '0' && letter <= '9';
    n_digits += is_digit ? 1 : 0;
    if (letter == 'e' || letter == 'E') {
      in_exponent = true;
      n_exponent_digits = 0;
    } else if (is_digit && in_exponent) {
      if (++n_exponent_digits > 2) return false;
    } else if (letter != '+' && letter != '-') {
      in_exponent = false;
    }
  }
  return n_digits <= 8;
}

}  // namespace

std::string unit_from_file(std::string_view text) {
  std::string unit = utf8(trimmed(text));
  const std::string small = lower_case(unit);
  if (small == "microns" || small == "micron" || small == "micrometer" || small == "micrometers") {
    return "micron";
  }
  if (unit == "\xC3\x85" || unit == "\xE2\x84\xAB" || small == "angstroms") return "angstrom";
  if (small == "nanometers" || small == "nanometer") return "nm";
  return unit;
}

std::optional<UnitScale> length_scale(std::string_view unit) {
  if (!has_plausible_numbers(unit)) return std::nullopt;
  return unit_scale(unit_from_file(unit), "m");
}

SiUnit si_unit(std::string_view text, const std::string& where) {
  const std::string unit = unit_from_file(text);
  if (unit.empty()) return {};
  if (unit == "1" || unit == "m") return {unit, {}};
  if (!has_plausible_numbers(unit)) {
    throw InputError(where, fmt::format("names an unknown unit \"{}\"", excerpt(unit)),
                     "Write a unit such as \"nm\" in its place");
  }
  for (const char* name : {"m", "V", "A", "N", "Pa", "N/m", "s", "K", "Hz", "kg", "W", "J", "1"}) {
    if (const auto scale = unit_scale(unit, name)) return {name, *scale};
  }
  if (!is_known_unit(unit)) {
    throw InputError(where, fmt::format("names an unknown unit \"{}\"", excerpt(unit)),
                     "Write a unit such as \"nm\" in its place");
  }
  return {unit, {}};
}

void scale_values(Array2& values, const UnitScale& scale, const std::string& where) {
  if (!(std::abs(scale.factor) > 1e-30 && std::abs(scale.factor) < 1e30) ||
      !(std::abs(scale.offset) < 1e30)) {
    throw InputError(where, fmt::format("its values would be scaled by {:.3g} to SI", scale.factor),
                     "Check the unit and the scale factor that the file names");
  }
  // By their bits, which order as the sizes do: no branch, and no trap on what is not a number.
  const auto bits_of = [](double value) { return std::bit_cast<std::uint64_t>(value); };
  const std::uint64_t largest = bits_of(kLargestValue / std::abs(scale.factor));
  const std::uint64_t missing = bits_of(std::numeric_limits<double>::quiet_NaN());
  constexpr std::uint64_t kSize = ~std::uint64_t{0} >> 1;
  double* const value = values.data();
  for (Index i = 0; i < values.size(); ++i) {
    const std::uint64_t bits = bits_of(value[i]);
    const std::uint64_t good = (bits & kSize) <= largest ? ~std::uint64_t{0} : 0;
    const std::uint64_t scaled = bits_of(scale.to_si(std::bit_cast<double>(bits & good)));
    value[i] = std::bit_cast<double>((scaled & good) | (missing & ~good));
  }
}

void check_pixel_counts(double nx, double ny, const std::string& where) {
  if (!(nx >= 1.0 && ny >= 1.0)) {
    throw InputError(where, fmt::format("announces {:.10g} x {:.10g} pixels", nx, ny),
                     "Export the map again");
  }
  if (nx > kMostPixels / ny) {
    throw InputError(
        where, fmt::format("announces {:.10g} x {:.10g} pixels", nx, ny),
        fmt::format("Maps of up to {:.0e} pixels are read; crop or bin it", kMostPixels));
  }
}

std::string number_text(double value) {
  return std::isnan(value) ? std::string("nan") : fmt::format("{:.4g}", value);
}

double checked_pitch(double pitch_m, std::string_view what, const std::string& where) {
  if (!std::isfinite(pitch_m) || pitch_m < 1e-12 || pitch_m > 1e3) {
    throw InputError(where, fmt::format("{} gives a pixel of {} m", what, number_text(pitch_m)),
                     "A pixel is between 1e-12 m and 1e3 m wide; check the lateral scale");
  }
  return pitch_m;
}

}  // namespace manoscope::io

#include "fuzz/mutation.hpp"

#include <algorithm>
#include <array>
#include <cstdint>
#include <string_view>

namespace manoscope::fuzz {
namespace {

using namespace std::string_view_literals;

/// Words and marks of the formats, and numbers that are hard to take.
constexpr std::array kTokens{"-1"sv,
                             "0"sv,
                             "99999999999"sv,
                             "2147483648"sv,
                             "9223372036854775808"sv,
                             "1e308"sv,
                             "1e-320"sv,
                             "nan"sv,
                             "inf"sv,
                             "-inf"sv,
                             "0x1p9"sv,
                             "1.#QNAN"sv,
                             "Bad"sv,
                             "No Data"sv,
                             "BAD"sv,
                             "="sv,
                             ":"sv,
                             "\n"sv,
                             "\r\n"sv,
                             ","sv,
                             ";"sv,
                             "\t"sv,
                             "#"sv,
                             "*"sv,
                             "\0"sv,
                             "\xff\xfe"sv,
                             "\xc2\xb5m"sv,
                             "\xb5m"sv,
                             "nm"sv,
                             "mm"sv,
                             "m"sv,
                             "V"sv,
                             "furlong"sv,
                             "XRes"sv,
                             "YReal"sv,
                             "ZUnits"sv,
                             "xres"sv,
                             "si_unit_z"sv,
                             "GwyDataField\0"sv,
                             "GwyContainer\0"sv,
                             "/0/data"sv,
                             "/0/mask"sv,
                             "data\0D"sv,
                             "DIGITAL SURF"sv,
                             "DSCOMPRESSED"sv,
                             "Directory"sv,
                             "RAW_DATA"sv,
                             "Image"sv,
                             "Mult"sv,
                             "Wavelength"sv,
                             "Pixel_size"sv,
                             "2D_Data"sv,
                             "1D_Data"sv,
                             "Matrix"sv,
                             "Array"sv,
                             "DataScale"sv,
                             "Dimension1Extent"sv,
                             "AliconaImaging\0\r\n"sv,
                             "DepthImageOffset"sv,
                             "TextureImageOffset"sv,
                             "Cols"sv,
                             "Rows"sv,
                             "VK4_"sv,
                             "VK6"sv,
                             "FRTM_GLIDERV1.01"sv,
                             "bISO-1.0"sv,
                             "aISO-2.0"sv,
                             "NumPoints = "sv,
                             "Zscale = "sv,
                             "Wyko ASCII Data File Format"sv,
                             "X Size"sv,
                             "ImageJ="sv,
                             "unit=um"sv,
                             "c1="sv,
                             "images="sv,
                             "CDF\1"sv,
                             "CDF\5"sv,
                             "PK\3\4"sv,
                             "PK\5\6"sv,
                             "<"sv,
                             "/>"sv,
                             "</"sv,
                             "<!--"sv,
                             "<![CDATA["sv,
                             "&amp;"sv,
                             "<Datum>"sv,
                             "<SizeX>"sv,
                             "</SizeX>"sv,
                             "<SizeZ>9</SizeZ>"sv,
                             "<DataList>"sv,
                             "<AxisType>A</AxisType>"sv,
                             "<DataType>I</DataType>"sv,
                             "LAYER_1"sv,
                             "IMAGE_SIZE_X"sv,
                             "Scan Data"sv,
                             "X;Y;valid"sv};

constexpr std::array<std::uint64_t, 14> kExtremes{
    0,
    1,
    0xffff'ffff'ffff'ffffULL,
    std::uint64_t{1} << 15,
    0x7fff,
    0x7fff'ffff,
    std::uint64_t{1} << 31,
    std::uint64_t{1} << 32,
    0xffff'fffe,
    std::uint64_t{1} << 63,
    0x7fff'ffff'ffff'ffffULL,
    0x7ff0'0000'0000'0000ULL,  // infinity as 64-bit float
    0x7ff4'0000'0000'0001ULL,  // a signalling NaN
    0x7f80'0001};              // one of 32 bits

template <class Items>
const auto& any_of(const Items& items, RandomStream& random) {
  return items[static_cast<std::size_t>(random.below(static_cast<Index>(items.size())))];
}

/// A place in [0, n); half of them in the first 600 bytes.
std::size_t place(std::size_t n, RandomStream& random) {
  const std::size_t within = random.below(2) == 0 ? std::min<std::size_t>(n, 600) : n;
  return static_cast<std::size_t>(random.below(static_cast<Index>(within)));
}

/// A length from 1 to `most`: short ones are as frequent as long ones.
std::size_t length(std::size_t most, RandomStream& random) {
  std::size_t scale = 4;
  while (scale < most && random.below(2) == 0) scale *= 4;
  return 1 + static_cast<std::size_t>(random.below(static_cast<Index>(std::min(scale, most))));
}

void set_number(std::string& bytes, std::size_t at, RandomStream& random) {
  constexpr std::array<std::size_t, 4> kWidths{1, 2, 4, 8};
  const std::size_t width = any_of(kWidths, random);
  if (random.below(2) == 0) at -= at % width;
  std::uint64_t value = any_of(kExtremes, random);
  if (random.below(3) == 0) value += static_cast<std::uint64_t>(random.below(5)) - 2;
  const bool little = random.below(2) == 0;
  for (std::size_t i = 0; i < width && at + i < bytes.size(); ++i) {
    const std::size_t shift = 8 * (little ? i : width - 1 - i);
    bytes[at + i] = static_cast<char>(value >> shift & 0xff);
  }
}

/// Another number in place of the next one that is written in digits.
void set_written_number(std::string& bytes, std::size_t at, RandomStream& random) {
  constexpr auto kDigits = "0123456789"sv;
  const std::size_t begin = bytes.find_first_of(kDigits, at);
  if (begin == std::string::npos) return set_number(bytes, at, random);
  const std::size_t end =
      std::min(bytes.find_first_not_of("0123456789.eE+-"sv, begin), bytes.size());
  constexpr std::array kNumbers{"0"sv,
                                "-1"sv,
                                "1"sv,
                                "65536"sv,
                                "2147483647"sv,
                                "2147483648"sv,
                                "4294967296"sv,
                                "1e9"sv,
                                "9223372036854775807"sv,
                                "1e308"sv,
                                "1e-310"sv,
                                "nan"sv,
                                "-inf"sv,
                                "99999999999999999999999999"sv};
  bytes.replace(begin, end - begin, any_of(kNumbers, random));
}

void wound(std::string& bytes, const std::string& other, RandomStream& random) {
  const std::size_t at = place(bytes.size(), random);
  const std::size_t rest = bytes.size() - at;
  switch (random.below(13)) {
    case 0:
    case 1:
      bytes[at] = static_cast<char>(bytes[at] ^ (1 << random.below(8)));
      return;
    case 2: {
      constexpr std::array<char, 5> kFills{'\0', '\xff', '\x7f', '\x80', ' '};
      const std::size_t n = std::min(length(256, random), rest);
      const char fill =
          random.below(2) == 0 ? any_of(kFills, random) : static_cast<char>(random.below(256));
      std::fill_n(bytes.begin() + static_cast<std::ptrdiff_t>(at), n, fill);
      return;
    }
    case 3:
    case 4:
    case 5:
      return set_number(bytes, at, random);
    case 6:
      return set_written_number(bytes, at, random);
    case 7:
      bytes.resize(at + 1);
      return;
    case 8:
      bytes.erase(at, length(rest, random));
      return;
    case 9: {
      const std::size_t n = std::min(length(4096, random), rest);
      bytes.insert(place(bytes.size(), random), bytes.substr(at, n));
      return;
    }
    case 10: {
      const std::size_t from = place(other.size(), random);
      const std::string block = other.substr(from, length(4096, random));
      if (random.below(2) == 0) {
        bytes.insert(at, block);
      } else {
        bytes.replace(at, std::min(block.size(), rest), block);
      }
      return;
    }
    case 11:
      if (random.below(4) == 0) {
        bytes = bytes.substr(0, at + 1) + other.substr(place(other.size(), random));
        return;
      }
      [[fallthrough]];
    default: {
      const std::string_view token = any_of(kTokens, random);
      if (random.below(2) == 0) {
        bytes.insert(at, token);
      } else {
        bytes.replace(at, std::min(token.size(), rest), token);
      }
    }
  }
}

}  // namespace

std::string mutated(std::string bytes, const std::string& other, RandomStream& random) {
  const Index n_wounds = random.below(2) == 0 ? 1 : 2 + random.below(3);
  for (Index i = 0; i < n_wounds && !bytes.empty(); ++i) wound(bytes, other, random);
  return bytes;
}

}  // namespace manoscope::fuzz

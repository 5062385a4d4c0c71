#pragma once

// For the tests of this folder only: TIFF files laid out by hand from revision 6.0.

#include <map>
#include <string>
#include <vector>

#include "manoscope/io/test_bytes.hpp"

namespace manoscope::io::testing {

struct TiffPage {
  std::uint32_t nx = 3, ny = 2;
  int bits = 32, format = 3, samples = 1, compression = 1, resolution_unit = 1, orientation = 1;
  double per_unit_x = 0.0, per_unit_y = 0.0;  ///< 0 = no resolution tags
  std::string description, data;
};

/// All pages in one file, little- or big-endian.
inline std::string tiff_file(const std::vector<TiffPage>& pages, bool is_little = true) {
  const auto number = [is_little](std::uint64_t value, int n) {
    return is_little ? little(value, n) : big(value, n);
  };
  std::string bytes = (is_little ? "II" : "MM") + number(42, 2) + number(0, 4);
  std::size_t link = 4;  // where the offset of the next page goes
  for (const TiffPage& page : pages) {
    const auto place = [&](const std::string& content) {
      if (bytes.size() % 2 == 1) bytes += '\0';
      const std::size_t at = bytes.size();
      bytes += content;
      return at;
    };
    std::map<int, std::string> entries;
    const auto shorts = [&](int tag, int value) {
      entries[tag] =
          number(3, 2) + number(1, 4) + number(static_cast<std::uint64_t>(value), 2) + number(0, 2);
    };
    const auto longs = [&](int tag, std::uint64_t value) {
      entries[tag] = number(4, 2) + number(1, 4) + number(value, 4);
    };
    const auto rational = [&](int tag, double value) {
      const std::size_t at =
          place(number(static_cast<std::uint64_t>(value * 1000), 4) + number(1000, 4));
      entries[tag] = number(5, 2) + number(1, 4) + number(at, 4);
    };
    longs(256, page.nx);
    longs(257, page.ny);
    shorts(258, page.bits);
    shorts(259, page.compression);
    shorts(262, 1);
    if (!page.description.empty()) {
      const std::string text = page.description + '\0';
      const std::size_t at = place(text);
      entries[270] = number(2, 2) + number(text.size(), 4) + number(at, 4);
    }
    longs(273, place(page.data));
    shorts(274, page.orientation);
    shorts(277, page.samples);
    longs(278, page.ny);
    longs(279, page.data.size());
    if (page.per_unit_x > 0.0) rational(282, page.per_unit_x);
    if (page.per_unit_y > 0.0) rational(283, page.per_unit_y);
    shorts(296, page.resolution_unit);
    shorts(339, page.format);
    std::string directory = number(entries.size(), 2);
    for (const auto& [tag, entry] : entries) {
      directory += number(static_cast<std::uint64_t>(tag), 2) + entry;
    }
    const std::size_t at = place(directory + number(0, 4));
    bytes.replace(link, 4, number(at, 4));
    link = at + directory.size();
  }
  return bytes;
}

/// Six 32-bit floats: first, 2, 3, 4, 5 and a NaN.
inline std::string tiff_floats(float first, bool is_little = true) {
  std::string data;
  for (const float value : {first, 2.0F, 3.0F, 4.0F, 5.0F}) {
    data += is_little ? little(value) : big(value);
  }
  return data + (is_little ? little(0x7fc00000U, 4) : big(0x7fc00000U, 4));
}

}  // namespace manoscope::io::testing

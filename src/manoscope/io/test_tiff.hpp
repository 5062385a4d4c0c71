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
  std::size_t strip_bytes = 0;             ///< that the tags tell of; 0 = all of `data`
  std::uint32_t tile_nx = 0, tile_ny = 0;  ///< 0 = one strip, which is `data`
  std::vector<std::string> tiles;          ///< row by row
};

/// All pages in one file, little- or big-endian, as TIFF or as BigTIFF.
inline std::string tiff_file(const std::vector<TiffPage>& pages, bool is_little = true,
                             bool is_bigtiff = false) {
  const auto number = [is_little](std::uint64_t value, int n) {
    return is_little ? little(value, n) : big(value, n);
  };
  const int word = is_bigtiff ? 8 : 4;  // bytes of an offset, and what an entry holds itself
  constexpr int kAscii = 2, kShort = 3, kLong = 4, kRational = 5;
  std::string bytes = is_little ? "II" : "MM";
  bytes += is_bigtiff ? number(43, 2) + number(8, 2) + number(0, 2) : number(42, 2);
  std::size_t link = bytes.size();  // where the offset of the next page goes
  bytes += number(0, word);
  for (const TiffPage& page : pages) {
    const auto place = [&](const std::string& content) {
      if (bytes.size() % 2 == 1) bytes += '\0';
      const std::size_t at = bytes.size();
      bytes += content;
      return at;
    };
    std::map<int, std::string> entries;
    const auto entry = [&](int tag, int type, std::size_t count, std::string content) {
      const auto room = static_cast<std::size_t>(word);
      if (content.size() > room) content = number(place(content), word);
      entries[tag] =
          number(static_cast<std::uint64_t>(type), 2) + number(count, word) + padded(content, room);
    };
    const auto shorts = [&](int tag, int value) {
      entry(tag, kShort, 1, number(static_cast<std::uint64_t>(value), 2));
    };
    const auto longs = [&](int tag, const std::vector<std::uint64_t>& values) {
      std::string content;
      for (const std::uint64_t value : values) content += number(value, 4);
      entry(tag, kLong, values.size(), content);
    };
    const auto rational = [&](int tag, double value) {
      entry(tag, kRational, 1,
            number(static_cast<std::uint64_t>(value * 1000), 4) + number(1000, 4));
    };
    longs(256, {page.nx});
    longs(257, {page.ny});
    shorts(258, page.bits);
    shorts(259, page.compression);
    shorts(262, 1);
    if (!page.description.empty()) {
      const std::string text = page.description + '\0';
      entry(270, kAscii, text.size(), text);
    }
    shorts(274, page.orientation);
    shorts(277, page.samples);
    if (page.tile_nx == 0) {
      longs(273, {place(page.data)});
      longs(278, {page.ny});
      longs(279, {page.strip_bytes > 0 ? page.strip_bytes : page.data.size()});
    } else {
      std::vector<std::uint64_t> offsets, sizes;
      for (const std::string& tile : page.tiles) {
        offsets.push_back(place(tile));
        sizes.push_back(tile.size());
      }
      longs(322, {page.tile_nx});
      longs(323, {page.tile_ny});
      longs(324, offsets);
      longs(325, sizes);
    }
    if (page.per_unit_x > 0.0) rational(282, page.per_unit_x);
    if (page.per_unit_y > 0.0) rational(283, page.per_unit_y);
    shorts(296, page.resolution_unit);
    shorts(339, page.format);
    std::string directory = number(entries.size(), is_bigtiff ? 8 : 2);
    for (const auto& [tag, content] : entries) {
      directory += number(static_cast<std::uint64_t>(tag), 2) + content;
    }
    const std::size_t at = place(directory + number(0, word));
    bytes.replace(link, static_cast<std::size_t>(word), number(at, word));
    link = at + directory.size();
  }
  return bytes;
}

/// The bytes as TIFF's LZW packs them at worst: each as a code of its own, 9 bits, the first bit of
/// a code in the highest free bit; no more of them than the first table holds.
inline std::string literal_lzw(const std::string& bytes) {
  constexpr unsigned kClear = 256, kEnd = 257, kBits = 9;
  std::string packed;
  unsigned long long pending = 0;
  unsigned n_pending = 0;
  const auto put_code = [&](unsigned code) {
    pending = pending << kBits | code;
    for (n_pending += kBits; n_pending >= 8; n_pending -= 8) {
      packed += static_cast<char>(pending >> (n_pending - 8) & 0xffU);
    }
  };
  put_code(kClear);
  for (const char byte : bytes) put_code(static_cast<unsigned char>(byte));
  put_code(kEnd);
  if (n_pending > 0) packed += static_cast<char>(pending << (8 - n_pending) & 0xffU);
  return packed;
}

/// PackBits of a row of up to 128 bytes, all of them literal; no run goes on in the next row.
inline std::string literal_packbits(const std::string& bytes) {
  return std::string(1, static_cast<char>(bytes.size() - 1)) + bytes;
}

/// A page of floats 0, 1, 2 ... row by row in tiles of 16 x 16, the smallest that TIFF allows.
inline TiffPage tiled_page(std::uint32_t nx, std::uint32_t ny, bool is_little = true) {
  constexpr std::uint32_t kTile = 16;
  TiffPage page;
  page.nx = nx;
  page.ny = ny;
  page.tile_nx = page.tile_ny = kTile;
  for (std::uint32_t y0 = 0; y0 < ny; y0 += kTile) {
    for (std::uint32_t x0 = 0; x0 < nx; x0 += kTile) {
      std::string tile;
      for (std::uint32_t iy = y0; iy < y0 + kTile; ++iy) {
        for (std::uint32_t ix = x0; ix < x0 + kTile; ++ix) {
          // Beyond the image a tile holds whatever its writer left there.
          const float value = ix < nx && iy < ny ? static_cast<float>(iy * nx + ix) : -1.0F;
          tile += is_little ? little(value) : big(value);
        }
      }
      page.tiles.push_back(tile);
    }
  }
  return page;
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

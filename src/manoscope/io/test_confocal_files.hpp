#pragma once

// Small files of confocal, focus-variation and stylus instruments, laid out from the formats'
// public descriptions. For tests only.

#include "manoscope/io/test_instrument_files.hpp"

namespace manoscope::io::testing {

/// Alicona .al3d: 3 x 2 pixels, rows padded to 16 bytes of depth and 8 of texture.
struct AliconaAl3d {
  std::string cols = "3", invalid = "3.0000e+15", pitch = "4e-07", tag_end = "\r\n";
  int n_planes = 2;

  static std::string tag(const std::string& key, const std::string& value,
                         const std::string& end = "\r\n") {
    return padded(key, 20) + padded(value, 30) + end;
  }

  std::string bytes() const {
    std::string out =
        std::string("AliconaImaging\0\r\n", 17) + tag("Version", "1") + tag("TagCount", "10");
    const std::size_t depth_offset = out.size() + 10 * 52 + 256;
    const std::size_t texture_offset = depth_offset + 32;
    out += tag("Cols", cols) + tag("Rows", "2", tag_end) +
           tag("DepthImageOffset", std::to_string(depth_offset)) +
           tag("TextureImageOffset", std::to_string(texture_offset)) +
           tag("NumberOfPlanes", std::to_string(n_planes)) + tag("TexturePtr", "0;1") +
           tag("InvalidPixelValue", invalid) + tag("PixelSizeXMeter", pitch) +
           tag("PixelSizeYMeter", "5e-07") + tag("CreatingApplication", "Measure 5");
    out += padded("", 254) + "\r\n";
    const float depths[6] = {1e-3F, 2e-3F, 3e-3F, 4e-3F, 3e15F, 6e-3F};
    for (int row = 0; row < 2; ++row) {
      for (int i = 0; i < 3; ++i) out += little(depths[3 * row + i]);
      out += "pad.";
    }
    for (int i = 0; i < 2 * 2 * 8; ++i) out += static_cast<char>(i);
    return out;
  }
};

/// Sensofar .plu: layers of 3 x 2 heights in um.
struct SensofarPlu {
  std::string date = "Fri Mar 10 16:35:59 2023";
  std::uint64_t type = 3, nx = 3, ny = 2;
  int n_layers = 1;

  std::string bytes() const {
    std::string out(500, '\0');
    put(out, 0, date);
    put(out, 132, "a comment");
    put(out, 388,
        little(ny, 4) + little(nx, 4) + little(3, 4) + little(0.0F) + little(1.5F) + little(-2.5F));
    put(out, 428, little(type, 4) + little(3, 4) + little(0, 4) + little(14, 4));
    put(out, 489, std::string(1, static_cast<char>(n_layers)));
    for (int layer = 0; layer < std::max(n_layers, 1); ++layer) {
      out += little(ny, 4) + little(nx, 4);
      for (const float height : {1.0F, 2.0F, 3.0F, 4.0F, 1000001.0F, 6.0F}) {
        out += little(height + (height > 1e6F ? 0.0F : static_cast<float>(layer)));
      }
      out += little(1.0F) + little(6.0F);
    }
    return out;
  }
};

/// TrueMap .tmd: 3 x 2 heights in mm.
struct TrueMapTmd {
  std::string comment = "Created by TrueMap v6\r\n";
  float size_x = 6.0F;
  std::string tail;

  std::string bytes() const {
    std::string out = padded("Binary TrueMap Data File v2.0\r\n", 32) + comment + '\0' +
                      little(3, 4) + little(2, 4) + little(size_x) + little(8.0F) + little(0.0F) +
                      little(0.0F);
    for (int i = 1; i <= 6; ++i) out += little(static_cast<float>(i));
    return out + tail;
  }
};

/// NanoFocus .nms: 3 x 2 heights between -1 um and 1 um, and their reflection.
struct NanoFocusNms {
  double least = -1.0, most = 1.0;
  bool with_reflection = true;

  std::string bytes() const {
    std::string out(3468, '\0');
    put(out, 0,
        little(2, 4) + little(1, 4) + little(0, 4) + little(65535, 4) + little(least) +
            little(most) + padded("OM_MS_2.0", 20) + "Confocal Height Image");
    put(out, 1076, "2022-02-09T13:25");
    put(out, 1368, little(3, 4) + little(2, 4) + little(1500.0) + little(2500.0));
    for (const std::uint64_t height : {0U, 16384U, 32767U, 49151U, 65534U, 100U}) {
      out += little(height, 2);
    }
    if (with_reflection) out += std::string("\x10\x20\x30\x40\x50\x00", 6);
    return out;
  }
};

/// FRT .frt: 3 x 2 pixels, the bottom row first.
struct FrtMicroprof {
  std::string version = "1.00";
  int bits = 16;
  bool with_images = true, with_valid_range = true;
  std::vector<std::uint64_t> numbers{0, 1, 5, 100, 200, 65530};

  std::string block(std::uint64_t kind, const std::string& data) const {
    return little(kind, 2) + little(data.size(), version == "1.00" ? 4 : 8) + data;
  }

  std::string bytes() const {
    std::string heights, intensities;
    for (const std::uint64_t number : numbers) {
      heights += little(number, bits / 8);
      intensities += little(number / 2, bits / 8);
    }
    const auto depth = static_cast<std::uint64_t>(bits);
    const std::string counts = little(3, 4) + little(2, 4) + little(depth, 4);
    std::string out = "FRTM_GLIDERV" + version + little(6, 2) + block(0x65, "a comment") +
                      block(0x66, counts) +
                      block(0x67, little(6e-3) + little(8e-3) + std::string(28, '\0')) +
                      block(0x6c, little(5, 4) + little(1e-8)) + block(0x0b, heights);
    if (with_valid_range) out += block(0x70, little(5, 4) + little(65529, 4));
    if (with_images) {
      out += block(0x7d, little(2, 4) + little(4, 4) + little(4, 4) + counts + heights +
                             little(2, 4) + counts + intensities);
    }
    return out.replace(16, 2, little(5U + (with_valid_range ? 1 : 0) + (with_images ? 1 : 0), 2));
  }
};

/// Keyence .vk4: 3 x 2 heights in steps of 100 pm and an image of the light.
struct KeyenceVk4 {
  int height_bits = 32;
  std::uint64_t nx = 3, compression = 0;
  bool with_images = true;
  std::string magic = "VK4_";
  std::uint64_t n_offsets = 18;

  std::string image(int bits) const {
    std::string out = little(nx, 4) + little(2, 4) + little(static_cast<std::uint64_t>(bits), 4) +
                      little(compression, 4) + little(6 * static_cast<std::uint64_t>(bits) / 8, 4) +
                      little(0, 4) + little(255, 4) + std::string(768, '\0');
    for (std::uint64_t i = 10; i < 16; ++i) out += little(i, bits / 8);
    return out;
  }

  std::string bytes() const {
    std::string conditions(304, '\0');
    put(conditions, 0,
        little(304, 4) + little(2015, 4) + little(7, 4) + little(8, 4) + little(9, 4) +
            little(10, 4) + little(11, 4));
    put(conditions, 4 * 24, little(200, 4));
    put(conditions, 4 * 42, little(1380000, 4) + little(1390000, 4) + little(100, 4));
    const std::string light = image(16), height = image(height_bits);
    std::string out =
        magic + little(0x10000000, 4) + little(0, 4) + std::string(4 * n_offsets, '\0');
    const std::size_t begin = out.size();
    put(out, 12, little(begin, 4));
    if (with_images) {
      put(out, 12 + 4 * 3, little(begin + 304, 4));
      put(out, 12 + 4 * 6, little(begin + 304 + light.size(), 4));
    }
    return out + conditions + light + height;
  }
};

}  // namespace manoscope::io::testing

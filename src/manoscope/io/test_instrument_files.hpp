#pragma once

// Small instrument files, laid out from the formats' public descriptions. For tests only.

#include <cmath>
#include <cstdint>
#include <string>
#include <vector>

#include "manoscope/io/test_bytes.hpp"

namespace manoscope::io::testing {

/// Zygo MetroPro: a phase window of 3 x 2 pixels and one intensity image of 4 x 2.
struct ZygoDat {
  std::uint32_t magic = 0x881b036f;
  std::uint32_t header_size = 834;
  int phase_resolution = 1, sign = 0, n_buckets = 1;
  std::uint32_t extra_intensity_bytes = 0;
  float scale_factor = 0.5F, obliquity = 1.0F, wavelength = 632.8e-9F;
  float lateral_resolution = 1.5e-6F;
  std::vector<std::int32_t> phases{-2000, -1000, 0, 1000, 2000, 3000};
  std::vector<std::uint16_t> intensities{100, 101, 102, 103, 104, 105, 106, 107};

  std::string bytes() const {
    std::string out(header_size < 834 ? 834 : header_size, '\0');
    put(out, 0, big(magic, 4) + big(1, 2) + big(header_size, 4));
    const std::uint32_t intensity_bytes =
        n_buckets == 0 ? 0 : static_cast<std::uint32_t>(2 * intensities.size());
    put(out, 52,
        big(4, 2) + big(2, 2) + big(n_buckets, 2) + big(255, 2) +
            big(intensity_bytes + extra_intensity_bytes, 4));
    put(out, 64, big(139, 2) + big(38, 2) + big(3, 2) + big(2, 2) + big(4 * phases.size(), 4));
    put(out, 80, "a comment");
    put(out, 164, big(scale_factor) + big(wavelength));
    put(out, 176, big(obliquity) + big(0.0F) + big(lateral_resolution));
    put(out, 218, big(phase_resolution, 2));
    put(out, 232, big(sign, 2) + big(640, 2) + big(480, 2));
    put(out, 246, "20X Mirau");
    if (n_buckets > 0) {
      for (const std::uint16_t intensity : intensities) out += big(intensity, 2);
    }
    for (const std::int32_t phase : phases) out += big(static_cast<std::uint32_t>(phase), 4);
    return out;
  }
};

/// Wyko Vision: a height array of 3 x 2 and an image of as many bytes.
struct WykoOpd {
  int nx = 3, element_bytes = 2, mult = 16;
  bool bad_float = false;
  std::string pixel_size_name = "Pixel_size";
  std::vector<int> elements{0, 1, 2, 3, 4, 5};

  std::string bytes() const {
    std::string heights = little(static_cast<std::uint64_t>(nx), 2) + little(2, 2) +
                          little(static_cast<std::uint64_t>(element_bytes), 2);
    for (const int element : elements) {
      heights += element_bytes == 4 ? little(static_cast<float>(element))
                                    : little(static_cast<std::uint64_t>(element), element_bytes);
    }
    if (bad_float) heights.replace(heights.size() - 4, 4, little(1e38F));
    std::string image = little(3, 2) + little(2, 2) + little(1, 2);
    for (const int element : {10, 11, 12, 13, 14, 15}) image += static_cast<char>(element);
    struct Entry {
      std::string name;
      std::uint64_t type;
      std::string data;
    };
    const std::vector<Entry> entries{{"Mult", 6, little(static_cast<std::uint64_t>(mult), 2)},
                                     {"RAW_DATA", 3, heights},
                                     {"Image", 3, image},
                                     {"MeasMode", 5, padded("VSI", 10)},
                                     {"Aspect", 7, little(1.25F)},
                                     {pixel_size_name, 7, little(0.0016F)},
                                     {"Wavelength", 7, little(80.0F)},
                                     {"TurretPos", 12, little(2, 4)},
                                     {"", 0, ""}};
    std::string directory = std::string("\1\0", 2) + padded("Directory", 16) + little(1, 2) +
                            little(24 * (entries.size() + 1), 4) + little(0xffff, 2);
    std::string data;
    for (const Entry& entry : entries) {
      directory += padded(entry.name, 16) + little(entry.type, 2) + little(entry.data.size(), 4) +
                   little(8, 2);
      data += entry.data;
    }
    return directory + data;
  }
};

/// The bytes as a zlib stream of one stored block: no compressor needed.
inline std::string stored_zlib(const std::string& bytes) {
  std::uint32_t a = 1, b = 0;
  for (const char byte : bytes) {
    a = (a + static_cast<unsigned char>(byte)) % 65521;
    b = (b + a) % 65521;
  }
  return std::string("\x78\x01\x01", 3) + little(bytes.size(), 2) +
         little(~bytes.size() & 0xffffU, 2) + bytes + big(b << 16 | a, 4);
}

/// One object of a Digital Surf file.
struct SurfObject {
  bool compressed = false, special_points = false;
  int type = 2, n_objects = 1, n_channels = 1, bits = 32, nx = 3, ny = 2, n = 6;
  int least = 10, most = 15, format = 0, inverted = 0;
  float spacing_z = 2.0F, offset_z = 100.0F;
  std::string name_z = "Z", unit_z = "nm";
  std::vector<int> points{10, 11, 12, 13, 14, 15};

  std::string bytes() const {
    const auto number = [&](auto value, int n_bytes) {
      const auto raw = static_cast<std::uint64_t>(static_cast<std::int64_t>(value));
      return format == 0 ? little(raw, n_bytes) : big(raw, n_bytes);
    };
    const auto real = [&](float value) { return format == 0 ? little(value) : big(value); };
    std::string data;
    for (const int point : points) data += number(point, bits / 8);
    if (compressed) {
      const std::string zipped = stored_zlib(data);
      data = number(1, 4) + number(data.size(), 4) + number(zipped.size(), 4) + zipped;
    }
    std::string header(512, '\0');
    put(header, 0, compressed ? "DSCOMPRESSED" : "DIGITAL SURF");
    put(header, 12,
        number(format, 2) + number(n_objects, 2) + number(1, 2) + number(type, 2) +
            padded("plate", 30, ' ') + padded("", 30, ' ') + number(n_channels, 2));
    put(header, 86, number(special_points ? 1 : 0, 2));
    put(header, 98,
        number(bits, 2) + number(least, 4) + number(most, 4) + number(nx, 4) + number(ny, 4) +
            number(n, 4) + real(1.5F) + real(2.5F) + real(spacing_z));
    put(header, 132,
        padded("X", 16, ' ') + padded("Y", 16, ' ') + padded(name_z, 16, ' ') +
            padded("\xb5m", 16, ' ') + padded("\xb5m", 16, ' ') + padded(unit_z, 16));
    put(header, 290, number(inverted, 2));
    put(header, 306,
        number(5, 2) + number(4, 2) + number(3, 2) + number(2, 2) + number(1, 2) + number(2024, 2));
    put(header, 334, number(9, 2) + number(3, 2));
    put(header, 474, real(offset_z));
    return header + "a comment" + "\1\2\3" + data;
  }
};

/// Items of a Bruker data set.
inline std::string vca_name(const std::string& name) { return little(name.size(), 4) + name; }
inline std::string vca_item(const std::string& name, int type, const std::string& value) {
  return vca_name(name) + static_cast<char>(type) + value;
}
/// A length of 4 bytes and the bytes.
inline std::string vca_counted(const std::string& value) {
  return little(4, 1) + little(value.size(), 4) + value;
}
inline std::string vca_quantity(const std::string& name, double value, const std::string& unit) {
  return vca_item(name, 0x13,
                  vca_counted(little(value) + vca_name("Micrometer") + vca_name(unit) +
                              little(1e6) + std::string(12, '\0')));
}

/// Bruker .opdx: a map of 3 x 2 samples and a profile of 5.
struct BrukerOpdx {
  bool anonymous_matrix = false, f64_samples = false;
  std::string unit = "\xc2\xb5m";
  double data_scale = 0.5, stylus_force = 3.0;
  std::uint64_t nx = 3;
  std::vector<float> samples{1.0F, 2.0F, 3.0F, 4.0F, std::nanf(""), 6.0F};

  std::string bytes() const {
    std::string data = little(2, 4) + little(nx, 4);
    for (const float sample : samples) {
      data += f64_samples ? little(static_cast<double>(sample)) : little(sample);
    }
    const std::string matrix =
        anonymous_matrix ? vca_item("Matrix", 0x45, vca_name("Matrix<float>") + vca_counted(data))
                         : vca_item("Matrix", 0x00,
                                    vca_name("Matrix<float>") + little(0, 4) + vca_name("x") +
                                        vca_counted(data));
    const std::string end = vca_item("", 0x7f, "\xff\xff");
    const std::string map = vca_item("DataKind", 0x12, vca_counted("Height")) +
                            vca_quantity("DataScale", data_scale, unit) +
                            vca_quantity("Dimension1Extent", 1.5, unit) +
                            vca_quantity("Dimension2Extent", 4.0, unit) + matrix + end;
    std::string array = little(0x0d, 1) + little(8, 4);
    for (int i = 0; i < 5; ++i) array += little(static_cast<double>(i));
    const std::string profile =
        vca_quantity("DataScale", 10.0, "nm") + vca_quantity("Extent", 8.0, unit) +
        vca_item("Array", 0x40, vca_name("double *") + vca_counted(array)) + end;
    const std::string meta =
        vca_item("Date", 0x12, vca_counted("2/11/2021")) +
        vca_item("Settings", 0x7d,
                 vca_counted(vca_quantity("StylusForce", stylus_force, "mg") +
                             vca_item("Samples", 0x0b, little(3001, 8)) + end)) +
        end;
    return std::string("VCA DATA\x01\0\0\x55", 12) +
           vca_item("1D_Data", 0x7d,
                    vca_counted(vca_item("Raw", 0x46, vca_counted(profile)) + end)) +
           vca_item("2D_Data", 0x7d, vca_counted(vca_item("Raw", 0x47, vca_counted(map)) + end)) +
           vca_item("MetaData", 0x7d, vca_counted(meta)) + end;
  }
};

}  // namespace manoscope::io::testing

// Surface data file (.sdf) of ISO 25178-71 and its forerunner BCR (EUNA 15178), as text and binary.
//
// Source: ISO 25178-71, and the description in the manual of the National Physical Laboratory's
// softgauges. Header: version (a = text, b = binary), maker, dates, points a profile, profiles,
// scales in m, type of number; then the heights profile by profile, times Zscale; then a trailer.
// Missing: BAD in text, the least number of the type in binary. The first profile is the top row;
// heights are positive upwards.
#include <fmt/format.h>

#include <algorithm>
#include <array>
#include <cmath>
#include <limits>
#include <map>

#include "manoscope/core/error.hpp"
#include "manoscope/core/provenance.hpp"
#include "manoscope/core/unit_text.hpp"
#include "manoscope/io/byte_cursor.hpp"
#include "manoscope/io/file_text.hpp"
#include "manoscope/io/file_units.hpp"
#include "manoscope/io/formats.hpp"
#include "manoscope/io/sample_block.hpp"

namespace manoscope::io {
namespace {

constexpr double kMissing = std::numeric_limits<double>::quiet_NaN();
constexpr const char* kExportAgain = "Export the map to .sdf again";

constexpr std::array<std::string_view, 4> kFamilies{"ISO-1.0", "ISO-2.0", "BCR-1.0", "NIST-1.0"};

/// The family of a header's first letters; "" if it is none.
std::string_view family_of(std::string_view head) {
  if (!head.starts_with('a') && !head.starts_with('b')) return {};
  for (const std::string_view family : kFamilies) {
    if (head.substr(1).starts_with(family)) return family;
  }
  return {};
}

struct Header {
  double nx = 0.0, ny = 0.0;
  double x_scale = 0.0, y_scale = 0.0, z_scale = 1.0;  ///< m
  double compression = 0.0, data_type = 7.0;
  std::vector<std::pair<std::string, std::string>> settings;

  void add(const char* name, std::string_view value) {
    if (!trimmed(value).empty())
      settings.emplace_back(name, one_line(trimmed(value).substr(0, 200)));
  }
};

void check(const Header& header, const std::string& where) {
  for (const double count : {header.nx, header.ny}) {
    if (!(count >= 1.0 && count <= kMostPixels) || count != std::floor(count)) {
      throw InputError(where,
                       fmt::format("announces {:.10g} x {:.10g} points", header.nx, header.ny),
                       kExportAgain);
    }
  }
  check_pixel_counts(header.nx, header.ny, where);
  if (header.compression != 0.0) {
    throw InputError(where,
                     fmt::format("its heights are packed (compression {})", header.compression),
                     "Export the map without compression");
  }
  if (!std::isfinite(header.z_scale) || header.z_scale == 0.0) {
    throw InputError(where, fmt::format("its Zscale is {}", number_text(header.z_scale)),
                     kExportAgain);
  }
}

Length pitch(double scale, double n, const char* name, const std::string& where) {
  if (scale == 0.0 || (n == 1.0 && !std::isfinite(scale))) return {};
  return Length::from_si(checked_pitch(scale, name, where));
}

Channel new_channel(Header header, const std::string& where) {
  Channel channel;
  channel.name = "height";
  channel.unit = channel.file_unit = "m";
  channel.grid.nx = static_cast<Index>(header.nx);
  channel.grid.ny = static_cast<Index>(header.ny);
  channel.grid.pitch_x = pitch(header.x_scale, header.nx, "Xscale", where);
  channel.grid.pitch_y = pitch(header.y_scale, header.ny, "Yscale", where);
  channel.settings = std::move(header.settings);
  return channel;
}

/// "name = value" lines up to a line that begins with '*'.
Header text_header(std::string_view& rest, const std::string& where) {
  Header header;
  std::map<std::string, std::string_view> fields;
  for (bool ended = false; !ended;) {
    if (rest.empty()) throw InputError(where, "no * ends its header", kExportAgain);
    const auto end = rest.find('\n');
    const std::string_view line = trimmed(rest.substr(0, end));
    rest.remove_prefix(end == std::string_view::npos ? rest.size() : end + 1);
    ended = line.starts_with('*');
    const auto equals = line.find('=');
    if (ended || equals == std::string_view::npos) continue;
    fields[lower_case(trimmed(line.substr(0, equals)))] = trimmed(line.substr(equals + 1));
  }
  const auto number = [&](const char* name, std::optional<double> otherwise) {
    const auto found = fields.find(lower_case(name));
    if (found == fields.end() && otherwise) return *otherwise;
    const auto value = found == fields.end() ? std::nullopt : parse_number(found->second);
    if (!value || !std::isfinite(*value)) {
      throw InputError(where,
                       found == fields.end() ? fmt::format("its header has no {}", name)
                                             : fmt::format("{} is \"{}\", not a number", name,
                                                           excerpt(found->second)),
                       kExportAgain);
    }
    return *value;
  };
  header.nx = number("NumPoints", std::nullopt);
  header.ny = number("NumProfiles", std::nullopt);
  header.x_scale = number("Xscale", std::nullopt);
  header.y_scale = number("Yscale", 0.0);
  header.z_scale = number("Zscale", std::nullopt);
  header.compression = number("Compression", 0.0);
  header.add("maker", fields["manufacid"]);
  header.add("created", fields["createdate"]);
  header.add("changed", fields["moddate"]);
  header.add("height resolution", fields["zresolution"]);
  return header;
}

Channel read_text(std::string_view text, const std::string& where) {
  std::string_view rest = text;
  Header header = text_header(rest, where);
  check(header, where);
  rest = rest.substr(0, rest.find('*'));
  // A height takes a digit and a blank.
  if (header.nx * header.ny > 0.5 * static_cast<double>(rest.size()) + 1.0) {
    throw InputError(
        where,
        fmt::format("announces {:.10g} x {:.10g} points, but {} bytes of heights follow", header.nx,
                    header.ny, rest.size()),
        "The file is incomplete; copy or export it again");
  }
  const double z_scale = header.z_scale;
  Channel channel = new_channel(std::move(header), where);
  channel.values.resize(channel.grid.ny, channel.grid.nx);
  Index n = 0;
  constexpr std::string_view kBlanks = " \t\r\n";
  for (;;) {
    const auto begin = rest.find_first_not_of(kBlanks);
    if (begin == std::string_view::npos) break;
    rest.remove_prefix(begin);
    const std::string_view word = rest.substr(0, rest.find_first_of(kBlanks));
    rest.remove_prefix(word.size());
    const bool missing = lower_case(word) == "bad" || lower_case(word) == "nan";
    const auto value = missing ? std::optional(kMissing) : parse_number(word);
    if (!value) {
      throw InputError(where, fmt::format("height {} is \"{}\"", n + 1, excerpt(word)),
                       "Write heights as numbers and missing ones as BAD");
    }
    if (n < channel.values.size()) channel.values.data()[n] = *value;
    ++n;
  }
  if (n != channel.values.size()) {
    throw InputError(where,
                     fmt::format("has {} heights where {} x {} are announced", n, channel.grid.nx,
                                 channel.grid.ny),
                     "The file is incomplete or damaged; copy or export it again");
  }
  scale_values(channel.values, UnitScale{z_scale, 0.0}, where);
  return channel;
}

struct NumberType {
  SampleType sample{};
  double missing = kMissing;  ///< the number that marks a missing height
};

NumberType number_type(double code, const std::string& where) {
  switch (static_cast<int>(code)) {
    case 0:
      return {SampleType::u8};
    case 1:
      return {SampleType::u16, 65535.0};
    case 2:
      return {SampleType::u32, 4294967295.0};
    case 3:
      return {SampleType::f32, std::numeric_limits<float>::lowest()};
    case 4:
      return {SampleType::i8, -128.0};
    case 5:
      return {SampleType::i16, -32768.0};
    case 6:
      return {SampleType::i32, -2147483648.0};
    case 7:
      return {SampleType::f64, std::numeric_limits<double>::lowest()};
    default:
      throw InputError(where, fmt::format("its DataType is {}", code),
                       "Types 0 to 7 are read: integers of 8 to 32 bits, float and double");
  }
}

Channel read_binary(ByteCursor& cursor, std::string_view family) {
  const std::string& where = cursor.where();
  cursor.skip(8);
  Header header;
  header.add("maker", cursor.text(10));
  header.add("created", cursor.text(12));
  header.add("changed", cursor.text(12));
  const bool wide = family == "ISO-2.0";
  header.nx = wide ? cursor.u32(Endian::little) : cursor.u16(Endian::little);
  header.ny = wide ? cursor.u32(Endian::little) : cursor.u16(Endian::little);
  header.x_scale = cursor.f64(Endian::little);
  header.y_scale = cursor.f64(Endian::little);
  header.z_scale = cursor.f64(Endian::little);
  const double resolution = cursor.f64(Endian::little);
  if (std::isfinite(resolution)) header.add("height resolution", fmt::format("{:g}", resolution));
  header.compression = cursor.u8();
  const int code = cursor.u8();
  cursor.skip(1);  // checksum: 0, no other is defined
  check(header, where);
  const NumberType type = number_type(code, where);
  const auto n_points = static_cast<std::uint64_t>(header.nx * header.ny);
  const std::uint64_t n_bytes = n_points * sample_bytes(type.sample);
  // Some writers of Olympus put two more numbers, 5 and 1, before the heights.
  if (cursor.remaining() == n_bytes + 8) {
    const std::uint64_t start = cursor.offset();
    const std::uint32_t first = cursor.u32(Endian::little), second = cursor.u32(Endian::little);
    if (first != 5 || second != 1) cursor.seek(start);
  }
  const double z_scale = header.z_scale;
  Channel channel = new_channel(std::move(header), where);
  channel.values =
      read_block(cursor, type.sample, Endian::little, static_cast<std::uint64_t>(channel.grid.nx),
                 static_cast<std::uint64_t>(channel.grid.ny), "heights");
  mark_missing(channel.values, [&](double value) { return value == type.missing; });
  scale_values(channel.values, UnitScale{z_scale, 0.0}, where);
  return channel;
}

class SdfReader final : public Reader {
 public:
  std::string_view name() const override { return "sdf"; }
  std::string_view description() const override { return "ISO 25178-71 SDF"; }
  std::vector<std::string> extensions() const override { return {".sdf"}; }
  int score(const Probe& probe) const override { return family_of(probe.head).empty() ? 0 : 100; }

  std::vector<Channel> read(const std::filesystem::path& path, const ReadOptions&) const override {
    const std::string where = path.string();
    ByteCursor cursor(path);
    const std::string head(cursor.bytes(std::min<std::uint64_t>(cursor.size(), 8)));
    const std::string_view family = family_of(head);
    if (family.empty()) {
      throw InputError(where, "does not begin as an SDF file does, e.g. with aISO-1.0",
                       kExportAgain);
    }
    std::vector<Channel> channels;
    cursor.seek(0);
    channels.push_back(head.front() == 'a' ? read_text(read_file(path), where)
                                           : read_binary(cursor, family));
    return channels;
  }
};

}  // namespace

const Reader& sdf_reader() {
  static const SdfReader reader;
  return reader;
}

}  // namespace manoscope::io

// Digital Surf (.sur, .pro).
//
// Source: "Surface data file format", Digital Surf, and the field list that HyperSpy's RosettaSciIO
// documents for its module digitalsurf. Objects follow one another, each a header of 512 bytes, a
// comment, a private zone and the points: plain ("DIGITAL SURF") or as zlib streams
// ("DSCOMPRESSED"). Rows run from the top.
//
//   height = point * Z spacing + Z offset, in the unit of the Z step
//
// Where the header says that special points occur, points outside [Zmin, Zmax] are no heights:
// Zmin - 2 was not measured, the neighbours of the range are saturated.
#include <fmt/format.h>

#include <array>
#include <cmath>
#include <vector>

#include "manoscope/core/error.hpp"
#include "manoscope/io/file_text.hpp"
#include "manoscope/io/file_units.hpp"
#include "manoscope/io/formats.hpp"
#include "manoscope/io/sample_block.hpp"
#include "manoscope/io/zlib_stream.hpp"

namespace manoscope::io {
namespace {

constexpr std::string_view kPlain = "DIGITAL SURF", kCompressed = "DSCOMPRESSED";
constexpr std::uint64_t kHeaderBytes = 512;
constexpr const char* kSaveAgain = "Save it again as a surface (.sur)";

enum ObjectType {
  profile = 1,
  surface = 2,
  binary_image = 3,
  intensity_image = 10,
  intensity_surface = 11,
  rgb_image = 12,
  rgb_surface = 13,
  rgb_intensity_surface = 16,
  rgb_image_series = 18,
  hyperspectral_card = 21,
};

struct Axis {
  std::string name, unit;
  double spacing = 0.0, offset = 0.0;
};

struct Header {
  bool compressed = false;
  Endian order = Endian::little;
  int n_objects = 0, type = 0, n_channels = 0, bits = 0;
  bool special_points = false;
  int inverted = 0;
  std::int32_t least = 0, most = 0;
  std::uint64_t nx = 0, ny = 0;
  Axis x, y, z;
  std::string object_name, operator_name, date, comment;
};

/// Latin-1 letters and blanks around a unit are the file's habit; a NUL may cut it short.
std::string text(ByteCursor& cursor, std::uint64_t n_bytes) {
  return std::string(trimmed(cursor.text(n_bytes)));
}

Header read_header(ByteCursor& cursor) {
  const std::uint64_t start = cursor.offset();
  Header header;
  const std::string_view magic = cursor.bytes(12);
  header.compressed = magic == kCompressed;
  if (!header.compressed && magic != kPlain) {
    cursor.seek(start);
    cursor.fail("no object begins here with \"DIGITAL SURF\" or \"DSCOMPRESSED\"", kSaveAgain);
  }
  const std::uint16_t format = cursor.u16(Endian::little);
  if (format != 0 && format != 257) {
    cursor.fail(fmt::format("is of byte order {}; known are 0 and 257", format), kSaveAgain);
  }
  const Endian order = header.order = format == 0 ? Endian::little : Endian::big;
  header.n_objects = cursor.u16(order);
  cursor.skip(2);  // version
  header.type = cursor.u16(order);
  header.object_name = text(cursor, 30);
  header.operator_name = text(cursor, 30);
  header.n_channels = cursor.u16(order);
  cursor.skip(4);  // acquisition, range
  header.special_points = cursor.u16(order) != 0;
  cursor.skip(2 + 4 + 4);  // absolute, resolution of the gauge, size in w
  header.bits = cursor.u16(order);
  header.least = cursor.i32(order);
  header.most = cursor.i32(order);
  const std::int32_t nx = cursor.i32(order), ny = cursor.i32(order), n = cursor.i32(order);
  check_pixel_counts(nx, ny, cursor.where());
  header.nx = static_cast<std::uint64_t>(nx);
  header.ny = static_cast<std::uint64_t>(ny);
  if (static_cast<double>(n) != static_cast<double>(nx) * static_cast<double>(ny)) {
    cursor.fail(fmt::format("announces {} x {} = {} points", nx, ny, n), kSaveAgain);
  }
  for (Axis* axis : {&header.x, &header.y, &header.z}) axis->spacing = cursor.f32(order);
  for (Axis* axis : {&header.x, &header.y, &header.z}) axis->name = text(cursor, 16);
  for (Axis* axis : {&header.x, &header.y, &header.z}) axis->unit = text(cursor, 16);
  cursor.seek(start + 290);
  header.inverted = cursor.u16(order);
  cursor.seek(start + 306);
  std::array<int, 6> when{};  // s, min, h, day, month, year
  for (int& part : when) part = cursor.u16(order);
  if (when[5] > 0) {
    header.date = fmt::format("{:04}-{:02}-{:02} {:02}:{:02}:{:02}", when[5], when[4], when[3],
                              when[2], when[1], when[0]);
  }
  cursor.seek(start + 334);
  const std::uint16_t n_comment = cursor.u16(order), n_private = cursor.u16(order);
  cursor.seek(start + 466);
  for (Axis* axis : {&header.x, &header.y, &header.z}) axis->offset = cursor.f32(order);
  cursor.seek(start + kHeaderBytes);
  header.comment = cursor.text(n_comment);
  cursor.skip(n_private);
  return header;
}

SampleType sample_type(const Header& header, const std::string& where) {
  if (header.bits == 16) return SampleType::i16;
  if (header.bits == 32) return SampleType::i32;
  throw InputError(where, fmt::format("has points of {} bits; known are 16 and 32", header.bits),
                   kSaveAgain);
}

Array2 read_points(ByteCursor& cursor, const Header& header) {
  const SampleType type = sample_type(header, cursor.where());
  if (!header.compressed) {
    return read_block(cursor, type, header.order, header.nx, header.ny, "points");
  }
  struct Stream {
    std::uint64_t n_raw = 0, n_zipped = 0;
  };
  const std::uint32_t n_streams = cursor.u32(header.order);
  cursor.require(n_streams, 8, "compressed streams");
  std::vector<Stream> streams;
  streams.reserve(n_streams);
  std::uint64_t n_zipped = 0;
  for (std::uint32_t i = 0; i < n_streams; ++i) {
    Stream stream;
    stream.n_raw = cursor.u32(header.order);
    stream.n_zipped = cursor.u32(header.order);
    n_zipped += stream.n_zipped;
    streams.push_back(stream);
  }
  cursor.require(n_zipped, 1, "compressed bytes");
  ZlibOutput output(header.nx * header.ny * sample_bytes(type), n_zipped, cursor.where());
  for (const Stream& stream : streams) output.append(cursor.bytes(stream.n_zipped), stream.n_raw);
  ByteCursor points(output.bytes(), cursor.where());
  return read_block(points, type, header.order, header.nx, header.ny, "points");
}

void drop_special_points(Array2& points, const Header& header) {
  if (!header.special_points) return;
  const double least = header.least, most = header.most;
  if (least < most) {
    mark_missing(points, [&](double point) { return point < least || point > most; });
  } else {
    mark_missing(points, [&](double point) { return point == least - 2.0; });
  }
}

/// m per step of an axis, 0 if the axis is no length.
double pitch(const Axis& axis) {
  const auto scale = length_scale(axis.unit);
  return scale && std::isfinite(axis.spacing) ? std::abs(axis.spacing) * scale->factor : 0.0;
}

bool is_image(int type) {
  return type == binary_image || type == intensity_image || type == rgb_image ||
         type == rgb_image_series;
}

Channel make_surface(Array2 points, const Header& header, const std::string& where) {
  drop_special_points(points, header);
  if (!std::isfinite(header.z.spacing) || !std::isfinite(header.z.offset)) {
    throw InputError(where, "its spacing or offset in Z is not a finite number", kSaveAgain);
  }
  // An unknown unit ("a.u.") is no length, which is all that matters here.
  const std::string& written = header.z.unit;
  SiUnit unit{written, {}};
  if (written.empty()) {
    unit = {};
  } else if (const auto length = length_scale(written)) {
    unit = {"m", *length};
  }
  if (written.empty() && is_image(header.type)) unit.name = "1";
  // A binary image has no scale.
  const double spacing = header.z.spacing == 0.0 && is_image(header.type) ? 1.0 : header.z.spacing;
  const std::string name = header.z.name.empty() ? std::string("height") : header.z.name;
  Channel channel =
      make_channel(name, unit.name, std::move(points), spacing * unit.scale.factor, where);
  channel.file_unit = written;
  const double offset = unit.scale.to_si(header.z.offset);
  if (std::abs(offset) > kLargestValue) {
    throw InputError(where, fmt::format("its offset in Z is {:.3g}", offset), kSaveAgain);
  }
  channel.values += offset;
  set_pitch(channel, pitch(header.x), pitch(header.y), where);
  add_setting(channel, "object", header.object_name);
  add_setting(channel, "operator", header.operator_name);
  add_setting(channel, "date", header.date);
  add_setting(channel, "x offset", header.x.offset, header.x.unit);
  add_setting(channel, "y offset", header.y.offset, header.y.unit);
  add_setting(channel, "comment", header.comment.substr(0, 1000));
  if (header.inverted != 0) {
    channel.warnings.emplace_back(
        "the file says that its heights were inverted or mirrored before they were saved; they are "
        "taken as they are");
  }
  return channel;
}

/// What the objects of one file are called, by the type of the first.
std::string object_name(const Channel& channel, int type, std::size_t i, std::size_t n_objects) {
  static constexpr std::array<const char*, 3> kColours{"red", "green", "blue"};
  if (type == rgb_image) return i < 3 ? kColours[i] : fmt::format("image {}", i + 1);
  if (type == rgb_image_series) return fmt::format("{} {}", kColours[i % 3], i / 3 + 1);
  if (type == rgb_surface || type == rgb_intensity_surface) {
    if (i == 0) return channel.name;
    return i < 4 ? kColours[i - 1] : "intensity";
  }
  if (type == intensity_surface) return i == 0 ? channel.name : "intensity";
  return n_objects == 1 ? channel.name : fmt::format("{} {}", channel.name, i + 1);
}

class DigitalSurfReader final : public Reader {
 public:
  std::string_view name() const override { return "digital-surf"; }
  std::string_view description() const override { return "Digital Surf"; }
  std::vector<std::string> extensions() const override { return {".sur", ".pro"}; }
  int score(const Probe& probe) const override {
    return probe.head.starts_with(kPlain) || probe.head.starts_with(kCompressed) ? 100 : 0;
  }

  std::vector<Channel> read(const std::filesystem::path& path, const ReadOptions&) const override {
    ByteCursor cursor(path);
    std::vector<Channel> channels;
    std::size_t n_objects = 1;
    int type = 0;
    for (std::size_t i = 0; i < n_objects; ++i) {
      const Header header = read_header(cursor);
      if (i == 0) {
        type = header.type;
        n_objects = static_cast<std::size_t>(std::max(header.n_objects, 1)) *
                    static_cast<std::size_t>(std::max(header.n_channels, 1));
      }
      if (header.type == hyperspectral_card) {
        throw InputError(path.string(), "holds a map of spectra, which has no heights", kSaveAgain);
      }
      channels.push_back(make_surface(read_points(cursor, header), header, path.string()));
      channels.back().name = object_name(channels.back(), type, i, n_objects);
      // `n_channels` is 1 for most files and means nothing for some.
      if (cursor.remaining() == 0 && i + 1 >= static_cast<std::size_t>(header.n_objects)) break;
    }
    return channels;
  }
};

}  // namespace

const Reader& digital_surf_reader() {
  static const DigitalSurfReader reader;
  return reader;
}

}  // namespace manoscope::io

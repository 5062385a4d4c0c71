// The points of an .x3p file: a binary file with an optional bit a point that says whether it is
// valid (least significant bit first), or a list of <Datum>x;y;z</Datum> in the XML.
#include <fmt/format.h>

#include <cmath>
#include <limits>

#include "manoscope/core/error.hpp"
#include "manoscope/core/unit_text.hpp"
#include "manoscope/io/byte_cursor.hpp"
#include "manoscope/io/file_text.hpp"
#include "manoscope/io/file_units.hpp"
#include "manoscope/io/md5.hpp"
#include "manoscope/io/sample_block.hpp"
#include "manoscope/io/x3p.hpp"

namespace manoscope::io::x3p {
namespace {

constexpr double kMissing = std::numeric_limits<double>::quiet_NaN();
constexpr const char* kExportAgain = "Export the map to .x3p again";

Axis read_axis(const pugi::xml_node& axes, const char* name, const std::string& where) {
  const pugi::xml_node node = child_of(axes, name);
  Axis axis;
  if (!node) throw InputError(where, fmt::format("has no axis {}", name), kExportAgain);
  const std::string_view kind = text_of(node, "AxisType"), type = text_of(node, "DataType");
  if (kind != "I" && kind != "A") {
    throw InputError(where, fmt::format("axis {} is of type \"{}\"", name, excerpt(kind)),
                     "It must be I (incremental) or A (absolute)");
  }
  axis.incremental = kind == "I";
  if (type.size() == 1 && std::string_view("ILFD").find(type) != std::string_view::npos) {
    axis.type = type.front();
  } else if (!type.empty()) {
    throw InputError(where, fmt::format("axis {} has numbers of type \"{}\"", name, excerpt(type)),
                     "It must be I, L, F or D");
  }
  axis.increment = number_of(node, "Increment", where).value_or(1.0);
  axis.offset = number_of(node, "Offset", where).value_or(0.0);
  if (std::abs(axis.increment) > 1e30 || std::abs(axis.offset) > 1e30) {
    throw InputError(where,
                     fmt::format("axis {} has the increment {:.4g} m and the offset {:.4g} m", name,
                                 axis.increment, axis.offset),
                     kExportAgain);
  }
  return axis;
}

Index read_count(const pugi::xml_node& parent, const char* name, const std::string& where) {
  const double count = number_of(parent, name, where).value_or(0.0);
  if (!(count >= 1.0 && count <= kMostPixels) || count != std::floor(count)) {
    throw InputError(where, fmt::format("{} is {:.10g}, not a number of points", name, count),
                     kExportAgain);
  }
  return static_cast<Index>(count);
}

std::uint64_t bytes_of(char type) { return type == 'I' ? 2 : type == 'D' ? 8 : 4; }

double next_number(ByteCursor& cursor, char type) {
  switch (type) {
    case 'I':
      return cursor.i16(Endian::little);
    case 'L':
      return cursor.i32(Endian::little);
    case 'F':
      return cursor.f32(Endian::little);
    default:
      return cursor.f64(Endian::little);
  }
}

/// In m; what is not finite, or beyond belief, is missing.
double placed(const Axis& axis, double stored) {
  if (!std::isfinite(stored) || std::abs(stored) > 1e60) return kMissing;
  return axis.position(stored);
}

void compare_md5(std::string_view expected, std::string_view bytes, const std::string& name,
                 Points& points) {
  if (expected.empty()) return;
  const std::string found = md5(bytes);
  if (lower_case(expected) != found) {
    points.warnings.push_back(
        fmt::format("the MD5 checksum of {} is {}, but the file says {}: it was changed or damaged",
                    name, found, excerpt(expected)));
  }
}

/// Room for what every point carries; nothing is known of it yet.
void make_room(Points& points, const Layout& layout) {
  for (std::size_t i = 0; i < 2; ++i) {
    if (layout.stored[i]) points.position[i].assign(layout.n_points(), kMissing);
  }
  points.height = layout.matrix ? Array2::Constant(layout.n[1] * layout.n[2], layout.n[0], kMissing)
                                : Array2::Constant(1, layout.n[0], kMissing);
}

/// The unpacked bytes of a linked file of exactly `n_bytes`.
std::string linked(const ZipArchive& archive, std::string_view name, std::uint64_t n_bytes,
                   const std::string& where) {
  const auto entry = archive.find(name);
  if (!entry) {
    throw InputError(where, fmt::format("links to {}, which is not in the archive", excerpt(name)),
                     kExportAgain);
  }
  if (entry->size != n_bytes) {
    throw InputError(archive.place(*entry),
                     fmt::format("has {} bytes where its points need {}", entry->size, n_bytes),
                     "The archive is incomplete or of another layout; export the map again");
  }
  return archive.read(*entry, n_bytes);
}

}  // namespace

Layout read_layout(const pugi::xml_node& root, const std::string& where) {
  const pugi::xml_node axes = child_of(child_of(root, "Record1"), "Axes");
  const pugi::xml_node record3 = child_of(root, "Record3");
  if (!axes || !record3) {
    throw InputError(where, axes ? "has no Record3 with points" : "has no Record1 with axes",
                     kExportAgain);
  }
  Layout layout;
  layout.axes = {read_axis(axes, "CX", where), read_axis(axes, "CY", where),
                 read_axis(axes, "CZ", where)};
  layout.n = {1, 1, 1};
  if (const pugi::xml_node size = child_of(record3, "MatrixDimension")) {
    layout.n = {read_count(size, "SizeX", where), read_count(size, "SizeY", where),
                child_of(size, "SizeZ") ? read_count(size, "SizeZ", where) : 1};
  } else {
    layout.matrix = false;
    layout.n[0] = read_count(record3, "ListDimension", where);
  }
  check_channel_count(static_cast<std::uint64_t>(layout.n[2]), where);
  check_pixel_counts(static_cast<double>(layout.n[0]),
                     static_cast<double>(layout.n[1]) * static_cast<double>(layout.n[2]), where);
  for (std::size_t i = 0; i < 2; ++i) {
    layout.stored[i] = !layout.matrix || !layout.axes[i].incremental;
  }
  return layout;
}

Points read_binary(const Layout& layout, const pugi::xml_node& link, const ZipArchive& archive,
                   const std::string& where) {
  Points points;
  const std::size_t n_points = layout.n_points();
  std::uint64_t n_bytes = 0;
  for (std::size_t i = 0; i < 3; ++i) {
    if (layout.stored[i]) n_bytes += n_points * bytes_of(layout.axes[i].type);
  }
  const std::string_view valid_name = text_of(link, "ValidPointsLink");
  std::string valid;
  if (!valid_name.empty()) {
    valid = linked(archive, valid_name, (n_points + 7) / 8, where);
    compare_md5(text_of(link, "MD5ChecksumValidPoints"), valid, std::string(valid_name), points);
  }
  const std::string_view data_name = text_of(link, "PointDataLink");
  const std::string data = linked(archive, data_name, n_bytes, where);
  compare_md5(text_of(link, "MD5ChecksumPointData"), data, std::string(data_name), points);

  ByteCursor cursor(data, where + ": " + one_line(data_name));
  make_room(points, layout);
  for (std::size_t k = 0; k < n_points; ++k) {
    for (std::size_t i = 0; i < 3; ++i) {
      if (!layout.stored[i]) continue;
      const Axis& axis = layout.axes[i];
      points.coordinate(i)[k] = placed(axis, next_number(cursor, axis.type));
    }
    const bool is_valid =
        valid.empty() || (static_cast<unsigned char>(valid[k / 8]) >> (k % 8) & 1U) != 0;
    if (!is_valid) points.height.data()[k] = kMissing;
  }
  return points;
}

Points read_list(Layout& layout, const pugi::xml_node& list, const std::string& where) {
  const std::size_t n_points = layout.n_points();
  // Counted before anyone makes room for them.
  std::size_t n_data = 0, n_fields = 0;
  for (const pugi::xml_node& datum : list.children()) {
    if (local_name(datum) != "Datum") continue;
    ++n_data;
    const std::string_view text = trimmed(datum.text().get());
    if (n_fields == 0 && !text.empty()) {
      n_fields = 1;
      for (const char letter : text) n_fields += letter == ';' ? 1 : 0;
    }
  }
  if (n_data != n_points) {
    throw InputError(where,
                     fmt::format("its list has {} points where {} are announced", n_data, n_points),
                     kExportAgain);
  }
  if (n_fields == 0) n_fields = 1;  // every point is missing
  std::size_t n_stored = 0;
  for (const bool stored : layout.stored) n_stored += stored ? 1 : 0;
  if (n_fields == 3) {
    layout.stored = {true, true, true};
  } else if (!layout.matrix && n_fields < 3) {  // a profile: x;z or z alone
    layout.stored = {n_fields == 2, false, true};
  } else if (n_fields != n_stored) {
    throw InputError(
        where,
        fmt::format("its list has {} numbers a point where its axes need {}", n_fields, n_stored),
        kExportAgain);
  }
  Points points;
  make_room(points, layout);
  std::size_t k = 0;
  for (const pugi::xml_node& datum : list.children()) {
    if (local_name(datum) != "Datum") continue;
    std::string_view rest = trimmed(datum.text().get());
    const bool is_empty = rest.empty();
    for (std::size_t i = 0; i < 3 && !is_empty; ++i) {
      if (!layout.stored[i]) continue;
      const auto end = rest.find(';');
      const std::string_view cell = trimmed(rest.substr(0, end));
      const auto value = parse_number(cell);
      if (!value) {
        throw InputError(where,
                         fmt::format("point {} has \"{}\" for a number", k + 1, excerpt(cell)),
                         kExportAgain);
      }
      points.coordinate(i)[k] = placed(layout.axes[i], *value);
      rest = end == std::string_view::npos ? std::string_view() : rest.substr(end + 1);
    }
    ++k;
  }
  return points;
}

}  // namespace manoscope::io::x3p

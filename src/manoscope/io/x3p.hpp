#pragma once

// What the parts of the .x3p reader share: the axes and the points of ISO 25178-72.

#include <array>
#include <string>
#include <vector>

#include "manoscope/core/index.hpp"
#include "manoscope/io/xml_file.hpp"
#include "manoscope/io/zip_archive.hpp"

namespace manoscope::io::x3p {

/// One of the axes CX, CY, CZ.
struct Axis {
  bool incremental = false;  ///< position = offset + increment * index; else as stored
  char type = 'D';           ///< I int16, L int32, F float32, D float64
  double increment = 1.0, offset = 0.0;

  /// Position in m of a stored number (of an index, for an incremental x or y).
  double position(double stored) const {
    return offset + (incremental ? increment * stored : stored);
  }
};

/// What main.xml says of the points.
struct Layout {
  std::array<Axis, 3> axes;                        ///< x, y, z
  bool matrix = true;                              ///< else a list of `n[0]` points
  std::array<Index, 3> n{};                        ///< columns, rows, layers
  std::array<bool, 3> stored{false, false, true};  ///< coordinates that every point carries

  std::size_t n_points() const { return static_cast<std::size_t>(n[0] * n[1] * n[2]); }
};

/// @throws InputError(where, ...) for what is absent, absurd or unknown.
Layout read_layout(const pugi::xml_node& root, const std::string& where);

/// The stored coordinates of all points in m, NaN where a point is not valid; a coordinate that is
/// not stored stays empty.
struct Points {
  std::array<std::vector<double>, 2> position;  ///< x and y
  Array2 height;                                ///< the layers below each other; a list in one row

  /// Where coordinate `i` of every point lies.
  double* coordinate(std::size_t i) { return i < 2 ? position[i].data() : height.data(); }
  std::vector<std::string> warnings;  ///< checksums that do not agree
};

/// From the binary files that Record3 links to. @throws InputError as ZipArchive does.
Points read_binary(const Layout& layout, const pugi::xml_node& link, const ZipArchive& archive,
                   const std::string& where);

/// From the list in main.xml; sets `layout.stored` by what the list holds.
Points read_list(Layout& layout, const pugi::xml_node& list, const std::string& where);

}  // namespace manoscope::io::x3p

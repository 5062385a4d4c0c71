#pragma once

#include <filesystem>
#include <string>
#include <utility>
#include <vector>

#include "manoscope/core/arrays.hpp"
#include "manoscope/core/colour_map.hpp"
#include "manoscope/core/grid.hpp"

namespace manoscope::io {

/// A small picture of a map, the top row first.
struct MapPicture {
  int width = 0, height = 0;
  std::vector<Rgb> pixels;  ///< row by row
};

/// The mean of the good pixels under each picture element, the top row first; NaN where there is
/// none.
///
/// The sides are as the map's lengths (as its pixel counts where it has no scale); the longer one
/// has `longest` elements, the shorter one at least 8.
Array2 picture_means(const CameraGrid& grid, const Array2& values, int longest);

/// Draws the mean of the good pixels under each picture element in viridis, from the 0.5th to the
/// 99.5th percentile of these means, so that a spike does not hide the rest. Missing: grey.
/// Sides as of picture_means().
MapPicture picture_of(const CameraGrid& grid, const Array2& values, int longest);

/// From the 0.5th to the 99.5th percentile of the finite means: the ends of the colours. {0, 0}
/// without any.
std::pair<double, double> colour_ends(const Array2& means);

/// Writes a picture as PNG.
/// @throws InputError if the file cannot be written.
void write_png(const std::filesystem::path& path, const MapPicture& picture);

/// The picture for a terminal of 24-bit colours: two elements a letter, one over the other.
std::string terminal_text(const MapPicture& picture);

}  // namespace manoscope::io

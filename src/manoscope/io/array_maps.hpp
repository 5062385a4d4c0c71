#pragma once

#include <cstdint>
#include <functional>
#include <optional>
#include <string>
#include <utility>
#include <vector>

#include "manoscope/io/reader.hpp"

namespace manoscope::io {

/// An array of numbers in a file that keeps arrays by name and says little else of them: MATLAB,
/// plain HDF5.
struct NamedArray {
  std::string name;                  ///< with its groups or structs: "scan/height"
  std::vector<std::uint64_t> shape;  ///< slowest index first, as it lies in the file
  /// False: rows follow one another, (frame, y, x). True: columns do, (frame, x, y), as in MATLAB.
  bool by_columns = false;
  std::string unit;            ///< as the file writes it, "" if it names none
  std::optional<double> fill;  ///< marks a missing sample
  std::vector<std::pair<std::string, std::string>> settings;
  /// Puts the values into room for all of them, or for those of one index of the slowest dimension.
  std::function<void(std::optional<std::uint64_t> frame, double* values)> read;

  /// "512 x 1024", columns first, or "512 x 1024, 20 frames".
  std::string size_text() const;
};

/// The maps among the arrays of a file.
///
/// A map is an array of two dimensions of at least 2 x 2 numbers; one of three is a series of maps,
/// its frames. Dimensions of length 1 do not count. `options.channel` chooses an array by its name,
/// with or without what stands before the last '/'; `options.page` a frame, or, where no array has
/// frames, the n-th map. Vectors "x" and "y" beside a map, of as many values as it has columns and
/// rows, give its scale if they or `options.lateral_unit` name a unit.
/// @throws InputError(where, ...) if there is none, if the one named is not there, or if all that
///         fit are more than can be meant (listing them with their sizes).
std::vector<Channel> array_channels(const std::vector<NamedArray>& arrays,
                                    const ReadOptions& options, const std::string& where);

}  // namespace manoscope::io

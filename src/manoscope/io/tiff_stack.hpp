#pragma once

#include <cstdint>
#include <filesystem>
#include <string>

#include "manoscope/core/arrays.hpp"
#include "manoscope/io/sample_block.hpp"
#include "manoscope/io/tiff_handle.hpp"

namespace manoscope::io {

/// Frames that follow one another in a file with one page alone. ImageJ saves stacks beyond 4 GB
/// so, which TIFF's own offsets cannot reach, and its description of the page counts them.
///
/// Source: ImageJ's TiffEncoder and TiffDecoder: one uncompressed strip, frames behind one another
/// from its offset on, the page's tags in front of them.
struct TiffStack {
  std::uint64_t offset = 0;  ///< of the first frame
  std::uint64_t n_frames = 1;
  std::uint64_t frame_bytes = 0;
};

/// The frames of the page at hand, which is the only one of its file: 1 where it is packed, in
/// tiles or in strips that do not follow one another, or where the file has no room for a second
/// one, as when an image was taken out of a stack and kept its description.
///
/// @param n_announced  by the description.
/// @param frame_bytes  of the page, unpacked.
/// @throws InputError(where, ...) if there is room for some of the frames and not for all.
TiffStack find_tiff_stack(TIFF* tiff, std::uint64_t file_bytes, double n_announced,
                          std::uint64_t frame_bytes, const std::string& where);

/// Frame `number` from 0, as stored.
Array2 read_tiff_frame(const std::filesystem::path& path, TIFF* tiff, const TiffStack& stack,
                       std::uint64_t number, SampleType type, std::uint64_t nx, std::uint64_t ny);

}  // namespace manoscope::io

#include "manoscope/io/tiff_stack.hpp"

#include <fmt/format.h>

#include "manoscope/core/error.hpp"

namespace manoscope::io {

TiffStack find_tiff_stack(TIFF* tiff, std::uint64_t file_bytes, double n_announced,
                          std::uint64_t frame_bytes, const std::string& where) {
  TiffStack stack;
  stack.frame_bytes = frame_bytes;
  std::uint16_t compression = COMPRESSION_NONE;
  TIFFGetFieldDefaulted(tiff, TIFFTAG_COMPRESSION, &compression);
  if (!(n_announced >= 2.0) || frame_bytes == 0 || compression != COMPRESSION_NONE ||
      TIFFIsTiled(tiff) != 0) {
    return stack;
  }
  std::uint64_t end_of_strips = stack.offset = TIFFGetStrileOffset(tiff, 0);
  for (std::uint32_t i = 0; i < TIFFNumberOfStrips(tiff); ++i) {
    if (TIFFGetStrileOffset(tiff, i) != end_of_strips) return stack;
    end_of_strips += TIFFGetStrileByteCount(tiff, i);
  }
  if (end_of_strips - stack.offset != frame_bytes) return stack;
  // Frames end where the page's tags begin, if these stand behind them.
  const std::uint64_t tags = TIFFCurrentDirOffset(tiff);
  const std::uint64_t end = tags > stack.offset ? std::min(tags, file_bytes) : file_bytes;
  const std::uint64_t n_there = end > stack.offset ? (end - stack.offset) / frame_bytes : 0;
  if (n_there < 2) return stack;
  if (static_cast<double>(n_there) < n_announced) {
    throw InputError(where,
                     fmt::format("a stack of {:g} images is announced, the file has room for {}",
                                 n_announced, n_there),
                     "The file is incomplete: copy it again, or save the stack again");
  }
  stack.n_frames = static_cast<std::uint64_t>(n_announced);
  return stack;
}

Array2 read_tiff_frame(const std::filesystem::path& path, TIFF* tiff, const TiffStack& stack,
                       std::uint64_t number, SampleType type, std::uint64_t nx, std::uint64_t ny) {
  ByteCursor cursor(path);
  cursor.seek(stack.offset + number * stack.frame_bytes);
  return read_block(cursor, type, TIFFIsBigEndian(tiff) != 0 ? Endian::big : Endian::little, nx, ny,
                    "pixels");
}

}  // namespace manoscope::io

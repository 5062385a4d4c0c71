#pragma once

#include <cstdint>
#include <filesystem>
#include <memory>
#include <span>

#include "manoscope/core/grid.hpp"

namespace manoscope::io {

/// A file of nothing but the little-endian 32-bit floats of one map, row by row: a frame grabber's.
struct RawFloats {
  CameraGrid grid;
  double metres_per_unit = 1.0;

  std::uint64_t row_bytes() const { return 4 * static_cast<std::uint64_t>(grid.nx); }
};

/// Where the pieces of a map lie while they are looked at. Lent from one FloatRows to the next, so
/// that a series of maps is read into the same few lines of the cache.
class PieceBuffer {
 public:
  char* data() { return data_; }
  std::size_t capacity() const { return capacity_; }
  /// Makes it larger, if it is not so large, and keeps its first `n_kept` bytes.
  void make_room(std::size_t n_bytes, std::size_t n_kept);

 private:
  std::unique_ptr<char[]> space_;
  char* data_ = nullptr;  ///< in it, aligned to a line of the cache
  std::size_t capacity_ = 0;
};

/// The rows of a map of 32-bit floats as they lie in its file, a piece at a time, so that whoever
/// sums over them finds them in the processor's cache, and a map of any size takes the memory of
/// one piece.
///
/// Reads Gwyddion Simple Fields (.gsf) and raw floats. The system is asked to read ahead.
class FloatRows {
 public:
  /// A Gwyddion Simple Field of heights.
  /// @param lent  outlives the rows; without one they have their own.
  /// @throws InputError as the reader of .gsf, and if the file has no lateral scale, or its
  ///         heights are not in a unit of length.
  explicit FloatRows(const std::filesystem::path& path, PieceBuffer* lent = nullptr);
  /// Raw floats on a grid that is known.
  /// @throws InputError if the size of the file is not that of the grid.
  FloatRows(const std::filesystem::path& path, const RawFloats& layout,
            PieceBuffer* lent = nullptr);

  const CameraGrid& grid() const { return layout_.grid; }
  double metres_per_unit() const { return layout_.metres_per_unit; }
  /// The next whole rows; empty after the last.
  /// @throws InputError if the file cannot be read, or has become shorter meanwhile.
  std::span<const char> next();

  FloatRows(const FloatRows&) = delete;
  FloatRows& operator=(const FloatRows&) = delete;
  ~FloatRows() = default;

 private:
  /// Closes what it opened.
  struct Descriptor {
    int number = -1;
    Descriptor() = default;
    Descriptor(const Descriptor&) = delete;
    Descriptor& operator=(const Descriptor&) = delete;
    ~Descriptor();
  };

  void open();
  void fill(std::size_t up_to);

  std::filesystem::path path_;
  RawFloats layout_;
  Descriptor descriptor_;
  std::uint64_t file_bytes_ = 0;
  Index n_left_ = 0;  ///< rows not handed over
  PieceBuffer own_;
  PieceBuffer* buffer_;
  std::size_t begin_ = 0, end_ = 0;  ///< of what is in the buffer
};

}  // namespace manoscope::io

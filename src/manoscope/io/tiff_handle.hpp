#pragma once

// For the reader and the writer of TIFF; includes libtiff, so not for other headers.

#include <tiffio.h>

#include <cstdint>
#include <filesystem>
#include <memory>
#include <string>

namespace manoscope::io {

/// A TIFF file. libtiff never prints: its first complaint is kept, and thrown as an
/// InputError where asked for.
class TiffHandle {
 public:
  /// Reads from a file, a strip or a tile at a time.
  /// @throws InputError if the file cannot be opened or does not begin as TIFF files do.
  explicit TiffHandle(const std::filesystem::path& path);
  /// Writes into `*bytes`, which outlives the object; in BigTIFF if `big`.
  TiffHandle(std::string* bytes, bool big, const std::string& where);
  ~TiffHandle();
  TiffHandle(const TiffHandle&) = delete;
  TiffHandle& operator=(const TiffHandle&) = delete;

  TIFF* get() const;
  /// libtiff's first complaint since the last call, "" if none; forgets it.
  std::string complaint() const;

 private:
  struct State;
  std::unique_ptr<State> state_;
};

}  // namespace manoscope::io

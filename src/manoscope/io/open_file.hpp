#pragma once

#include <cstdint>
#include <filesystem>
#include <string>

namespace manoscope::io {

/// A regular file opened for reading at any place, without holding its bytes.
///
/// Several threads may read at once. A file that shrinks while it is read gives an InputError, not
/// a signal as a mapped file would.
class OpenFile {
 public:
  /// @throws InputError if the file is missing, not a regular file or must not be read.
  explicit OpenFile(const std::filesystem::path& path);
  ~OpenFile();
  OpenFile(const OpenFile&) = delete;
  OpenFile& operator=(const OpenFile&) = delete;

  /// Bytes of the file when it was opened.
  std::uint64_t size() const { return size_; }

  /// Copies bytes [offset, offset + n_bytes), which must lie within size(), to `to`.
  /// @throws InputError if the file has become shorter or the device fails.
  void read(std::uint64_t offset, char* to, std::uint64_t n_bytes) const;

 private:
  std::string where_;
  int descriptor_ = -1;
  std::uint64_t size_ = 0;
};

}  // namespace manoscope::io

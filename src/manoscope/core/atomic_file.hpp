#pragma once

#include <filesystem>
#include <string_view>

namespace manoscope {

/// A file that appears whole or not at all.
///
/// The content goes to `temporary()`, an empty file made in the target's folder; commit() syncs it
/// to the disk and renames it over the target. Without commit() the destructor removes it, so that
/// a failed write leaves the old target untouched. A target that is a symbolic link keeps being
/// one.
class AtomicFile {
 public:
  /// @throws InputError naming the target if its folder is missing or cannot be written, if it is
  ///         itself a folder, or an existing file without write permission.
  explicit AtomicFile(const std::filesystem::path& target);
  ~AtomicFile();
  AtomicFile(const AtomicFile&) = delete;
  AtomicFile& operator=(const AtomicFile&) = delete;

  const std::filesystem::path& target() const { return target_; }
  /// Where to write before commit(): an existing, empty file that only this object knows.
  const std::filesystem::path& temporary() const { return temporary_; }

  /// Publishes what was written. To be called once, after the temporary file was closed.
  /// @throws InputError naming the target if the disk is full or refuses.
  void commit();

 private:
  std::filesystem::path target_, temporary_;
};

/// Writes `bytes` to `path` through an AtomicFile.
/// @throws InputError naming the file if it cannot be written (permissions, full disk).
void write_file_atomically(const std::filesystem::path& path, std::string_view bytes);

}  // namespace manoscope

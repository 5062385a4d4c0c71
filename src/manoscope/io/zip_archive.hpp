#pragma once

#include <cstdint>
#include <filesystem>
#include <memory>
#include <optional>
#include <string>
#include <string_view>
#include <vector>

namespace manoscope::io {

/// The files of an untrusted zip archive.
///
/// Nothing is unpacked before its declared size was found possible: no larger than asked for, and
/// no more than deflate can make of the bytes it has. The archive itself is not held in memory.
class ZipArchive {
 public:
  struct Entry {
    std::uint64_t index = 0;
    std::uint64_t size = 0;  ///< unpacked, as declared
  };

  /// @param offset  where in the file the archive begins.
  /// @throws InputError if the file cannot be read or is no zip archive.
  explicit ZipArchive(const std::filesystem::path& path, std::uint64_t offset = 0);
  ~ZipArchive();
  ZipArchive(const ZipArchive&) = delete;
  ZipArchive& operator=(const ZipArchive&) = delete;

  /// Looks for `name` at the top or, failing that, in the one folder that holds it; names from then
  /// on are within that folder.
  /// @return false if no file of that name is in the archive.
  bool enter_folder_of(std::string_view name);

  /// The file of that name (case ignored, "./" and "\" understood), if it is there.
  std::optional<Entry> find(std::string_view name) const;

  /// The unpacked bytes of a file; its CRC is checked.
  /// @throws InputError naming archive and file if it is larger than `largest`, packed beyond
  ///         belief, encrypted, of a packing method other than "deflate" and "stored", or damaged.
  std::string read(const Entry& entry, std::uint64_t largest) const;

  std::uint64_t n_bytes() const { return n_bytes_; }   ///< of the archive
  const std::string& where() const { return where_; }  ///< the file's name

  /// "scan.x3p: main.xml", for messages.
  std::string place(const Entry& entry) const;

 private:
  struct Handle;
  std::string where_, folder_;
  std::uint64_t n_bytes_ = 0;
  std::unique_ptr<Handle> handle_;
  std::vector<std::string> names_;  ///< as find() compares them, by index
};

/// True for the head of a file that begins as zip archives do.
bool looks_like_zip(std::string_view head);

/// True if `name` is the name of one of the archive's first files, as far as `head` reaches.
bool zip_head_names(std::string_view head, std::string_view name);

}  // namespace manoscope::io

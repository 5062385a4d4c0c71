#pragma once

#include <cstdint>
#include <filesystem>
#include <optional>
#include <string>
#include <vector>

#include "manoscope/serve/descriptor.hpp"

namespace manoscope::serve {

/// The folder that is served: nothing outside of it is opened, whatever a path or a symbolic link
/// in it says.
///
/// The kernel holds that itself (openat2 with RESOLVE_BENEATH): a link that leads out ends in an
/// error, and so does an absolute one. Relative paths come from relative_parts().
class Folder {
 public:
  /// @throws InputError if it is no folder, cannot be opened, or the system is too old (Linux 5.6).
  explicit Folder(const std::filesystem::path& path);

  const std::filesystem::path& path() const { return path_; }

  enum class Kind { file, folder };
  /// Opens what is there for reading; an open descriptor of nothing else but that kind.
  /// @return nothing if there is nothing of that kind beneath the folder.
  Descriptor open(const std::string& relative, Kind kind) const;
  bool has(const std::string& relative, Kind kind) const { return bool(open(relative, kind)); }
  /// Whether a path leads out of the folder, or round in circles; not so where nothing is there
  /// yet. The path may hold `..`: it means what it means to the kernel, also behind a link.
  bool leads_out(const std::string& relative) const;
  /// Where the links of a path end, beneath the folder; the path itself where nothing is there.
  /// @throws InputError if that is outside.
  std::string without_links(const std::string& relative) const;
  /// The path for those who open files by name: the readers of maps and results, and the
  /// measurement. It was looked at before, and is followed again then: in a folder that other users
  /// may write to, they can put a link to a file of this user in its place between the two.
  std::filesystem::path absolute(const std::string& relative) const {
    return relative.empty() ? path_ : path_ / relative;
  }
  /// Makes the folders of a path that are missing, and opens the last.
  /// @throws InputError if that cannot be done.
  Descriptor make_folders(const std::vector<std::string>& parts) const;

 private:
  std::filesystem::path path_;
  Descriptor descriptor_;
};

/// Status of what is open.
struct Opened {
  bool is_file = false;
  std::uint64_t size = 0;
  double modified = 0.0;  ///< Unix time, s
};
Opened status_of(const Descriptor& descriptor);

}  // namespace manoscope::serve

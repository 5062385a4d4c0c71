#pragma once

#include <filesystem>
#include <functional>
#include <string_view>
#include <vector>

namespace manoscope::results {

/// A set of files that appears in a folder together, or not at all.
///
/// Files are collected in a hidden folder `.manoscope-publication` inside the target, each synced
/// to the disk. publish() then withdraws the earlier files in the order given and renames the new
/// ones into place in the order added. If a step fails, what was withdrawn is put back; if the
/// process is killed before publish(), the target is untouched; if it is killed inside publish() (a
/// few renames), the first withdrawn file is gone and the last added one not yet there: a reader
/// who looks for that file sees the old set or none. The hidden folder a killed process leaves is
/// cleared by the next one. A lock keeps two processes out of each other's way; it ends with its
/// process.
class Publication {
 public:
  /// Makes the target folder (with its parents) if it is missing, and locks it.
  /// @throws InputError naming the folder if it cannot be made or written, or is being written.
  explicit Publication(std::filesystem::path folder);
  ~Publication();
  Publication(const Publication&) = delete;
  Publication& operator=(const Publication&) = delete;

  /// Collects one file; `name` is relative to the folder and may hold subfolders.
  /// @throws InputError naming the file if the disk is full or refuses.
  void add(const std::filesystem::path& name, std::string_view bytes);
  /// The same for a file that `write` makes itself at the path it is given.
  void add(const std::filesystem::path& name,
           const std::function<void(const std::filesystem::path&)>& write);

  /// Puts the collected files in the place of the earlier ones. To be called once.
  /// @param earlier  names to withdraw where they exist, in this order.
  void publish(const std::vector<std::filesystem::path>& earlier);

 private:
  std::filesystem::path folder_, staging_;
  std::vector<std::filesystem::path> names_;
  int lock_ = -1;
};

}  // namespace manoscope::results

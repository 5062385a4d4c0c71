#pragma once

#include <cstdint>
#include <string>
#include <string_view>
#include <vector>

#include "manoscope/serve/folder.hpp"

namespace manoscope::serve {

/// A file that grows under a hidden name in the folder of its target, whose place it then takes
/// whole; the target itself is not opened. Without that it leaves nothing.
class StagedFile {
 public:
  /// Makes the folders on the way.
  /// @throws InputError if it cannot be written.
  StagedFile(const Folder& folder, const std::vector<std::string>& parts);
  ~StagedFile();
  StagedFile(const StagedFile&) = delete;
  StagedFile& operator=(const StagedFile&) = delete;

  const std::string& file() const { return file_; }
  std::uint64_t size() const { return size_; }
  /// Whether something of the target's name is there.
  bool is_taken() const;

  /// @throws InputError if the disk is full or refuses.
  void write(std::string_view bytes);
  /// Gives it the permissions and, where the system lets, the owner of the target, if that is
  /// there.
  /// @throws InputError if its owner has protected the target.
  void resemble_target();
  /// To be called once all is written: it is on the disk from here on.
  void finish();

  /// Gives it its name; nothing is replaced.
  /// @return false if something of that name is there. @throws InputError.
  bool appear();
  /// Puts it in the place of the target. @throws InputError.
  void replace();

 private:
  void settle();

  std::string file_, name_, temporary_;
  Descriptor folder_, out_;
  std::uint64_t size_ = 0;
};

}  // namespace manoscope::serve

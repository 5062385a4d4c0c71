#pragma once

#include <string>
#include <string_view>
#include <vector>

#include "manoscope/serve/folder.hpp"

namespace manoscope::serve {

/// A file that grows under another name and appears whole, or not at all; it replaces nothing.
class Upload {
 public:
  /// @throws ApiError 409 if something of that name is there; InputError if it cannot be written.
  Upload(const Folder& folder, const std::vector<std::string>& parts);
  ~Upload();
  Upload(const Upload&) = delete;
  Upload& operator=(const Upload&) = delete;

  /// @throws InputError if the disk is full or refuses.
  void write(std::string_view bytes);
  /// Gives the file its name.
  /// @throws ApiError 409 if something of that name is there by now; InputError.
  void finish();

  const std::string& file() const { return file_; }
  std::uint64_t size() const { return size_; }

 private:
  std::string file_, name_, temporary_;
  Descriptor folder_, out_;
  std::uint64_t size_ = 0;
};

}  // namespace manoscope::serve

#pragma once

#include <string>
#include <string_view>
#include <vector>

#include "manoscope/serve/staged_file.hpp"

namespace manoscope::serve {

/// A file that comes from outside and appears whole, or not at all; it replaces nothing.
class Upload {
 public:
  /// @throws ApiError 409 if something of that name is there; InputError if it cannot be written.
  Upload(const Folder& folder, const std::vector<std::string>& parts);

  /// @throws InputError if the disk is full or refuses.
  void write(std::string_view bytes) { staged_.write(bytes); }
  /// Gives the file its name.
  /// @throws ApiError 409 if something of that name is there by now; InputError.
  void finish();

  const std::string& file() const { return staged_.file(); }
  std::uint64_t size() const { return staged_.size(); }

 private:
  StagedFile staged_;
};

}  // namespace manoscope::serve

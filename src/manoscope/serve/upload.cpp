#include "manoscope/serve/upload.hpp"

#include "manoscope/serve/address.hpp"
#include "manoscope/serve/api_error.hpp"

namespace manoscope::serve {
namespace {

[[noreturn]] void refuse(const std::string& file) {
  throw ApiError(409, file, "something of that name is there already",
                 "Rename the file; nothing is replaced");
}

const std::vector<std::string>& checked(const std::vector<std::string>& parts) {
  for (const std::string& part : parts) {
    if (!is_plain_name(part)) {
      throw ApiError(400, "", "a name that no file here may have",
                     "Leave out dots at the front, slashes and control characters");
    }
  }
  return parts;
}

}  // namespace

Upload::Upload(const Folder& folder, const std::vector<std::string>& parts)
    : staged_(folder, checked(parts)) {
  if (staged_.is_taken()) refuse(staged_.file());
}

void Upload::finish() {
  staged_.finish();
  if (!staged_.appear()) refuse(staged_.file());
}

}  // namespace manoscope::serve

#include "manoscope/serve/upload.hpp"

#include <fcntl.h>
#include <stdio.h>
#include <sys/stat.h>

#include <cerrno>
#include <system_error>

#include "manoscope/core/error.hpp"
#include "manoscope/serve/address.hpp"
#include "manoscope/serve/api_error.hpp"
#include "manoscope/serve/secret.hpp"

namespace manoscope::serve {
namespace {

[[noreturn]] void fail(const std::string& file, int error) {
  const bool full = error == ENOSPC || error == EDQUOT || error == EFBIG;
  throw InputError(
      file, "cannot be written: " + std::error_code(error, std::generic_category()).message(),
      full ? "Free some space" : "Check the permissions of its folder");
}

[[noreturn]] void refuse(const std::string& file) {
  throw ApiError(409, file, "something of that name is there already",
                 "Rename the file; nothing is replaced");
}

}  // namespace

Upload::Upload(const Folder& folder, const std::vector<std::string>& parts)
    : file_(join(parts)), name_(parts.back()) {
  for (const std::string& part : parts) {
    if (!is_plain_name(part)) {
      throw ApiError(400, "", "a name that no file here may have",
                     "Leave out dots at the front, slashes and control characters");
    }
  }
  folder_ = folder.make_folders({parts.begin(), parts.end() - 1});
  struct stat status {};
  if (::fstatat(folder_.number(), name_.c_str(), &status, AT_SYMLINK_NOFOLLOW) == 0) refuse(file_);
  temporary_ = ".manoscope-" + new_secret().substr(0, 16) + ".part";
  out_ = Descriptor(::openat(folder_.number(), temporary_.c_str(),
                             O_CREAT | O_EXCL | O_WRONLY | O_CLOEXEC | O_NOFOLLOW, 0666));
  if (!out_) {
    const int error = errno;
    temporary_.clear();
    fail(file_, error);
  }
}

Upload::~Upload() {
  if (!temporary_.empty()) ::unlinkat(folder_.number(), temporary_.c_str(), 0);
}

void Upload::write(std::string_view bytes) {
  size_ += bytes.size();
  while (!bytes.empty()) {
    const ssize_t written = ::write(out_.number(), bytes.data(), bytes.size());
    if (written < 0 && errno == EINTR) continue;
    if (written < 0) fail(file_, errno);
    bytes.remove_prefix(static_cast<std::size_t>(written));
  }
}

void Upload::finish() {
  if (::fsync(out_.number()) != 0) fail(file_, errno);
  out_.close();
  int status = ::renameat2(folder_.number(), temporary_.c_str(), folder_.number(), name_.c_str(),
                           RENAME_NOREPLACE);
  if (status == 0) {
    temporary_.clear();
    return;
  }
  // File systems that know no such renaming know links, which replace nothing, either.
  if (errno == EINVAL || errno == ENOSYS) {
    status = ::linkat(folder_.number(), temporary_.c_str(), folder_.number(), name_.c_str(), 0);
    if (status == 0) return;
  }
  if (errno == EEXIST) refuse(file_);
  fail(file_, errno);
}

}  // namespace manoscope::serve

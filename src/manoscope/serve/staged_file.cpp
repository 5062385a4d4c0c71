#include "manoscope/serve/staged_file.hpp"

#include <fcntl.h>
#include <stdio.h>
#include <sys/stat.h>

#include <cerrno>
#include <system_error>

#include "manoscope/core/error.hpp"
#include "manoscope/serve/address.hpp"
#include "manoscope/serve/secret.hpp"

namespace manoscope::serve {
namespace {

[[noreturn]] void fail(const std::string& file, int error) {
  const bool full = error == ENOSPC || error == EDQUOT || error == EFBIG;
  throw InputError(
      file, "cannot be written: " + std::error_code(error, std::generic_category()).message(),
      full ? "Free some space" : "Check the permissions of its folder");
}

}  // namespace

StagedFile::StagedFile(const Folder& folder, const std::vector<std::string>& parts)
    : file_(join(parts)),
      name_(parts.back()),
      folder_(folder.make_folders({parts.begin(), parts.end() - 1})) {
  constexpr std::size_t kDigits = 16;
  temporary_ = ".manoscope-" + new_secret().substr(0, kDigits) + ".part";
  out_ = Descriptor(::openat(folder_.number(), temporary_.c_str(),
                             O_CREAT | O_EXCL | O_WRONLY | O_CLOEXEC | O_NOFOLLOW, 0666));
  if (!out_) {
    const int error = errno;
    temporary_.clear();
    fail(file_, error);
  }
}

StagedFile::~StagedFile() {
  if (!temporary_.empty()) ::unlinkat(folder_.number(), temporary_.c_str(), 0);
}

bool StagedFile::is_taken() const {
  struct stat status {};
  return ::fstatat(folder_.number(), name_.c_str(), &status, AT_SYMLINK_NOFOLLOW) == 0;
}

void StagedFile::write(std::string_view bytes) {
  size_ += bytes.size();
  while (!bytes.empty()) {
    const ssize_t written = ::write(out_.number(), bytes.data(), bytes.size());
    if (written < 0 && errno == EINTR) continue;
    if (written < 0) fail(file_, errno);
    bytes.remove_prefix(static_cast<std::size_t>(written));
  }
}

void StagedFile::resemble_target() {
  constexpr mode_t kPermissions = 0777;
  // A rename would replace even a file that its owner has protected.
  if (::faccessat(folder_.number(), name_.c_str(), W_OK, AT_EACCESS) != 0) {
    if (errno == ENOENT) return;
    fail(file_, errno);
  }
  struct stat status {};
  if (::fstatat(folder_.number(), name_.c_str(), &status, 0) != 0) fail(file_, errno);
  static_cast<void>(::fchown(out_.number(), status.st_uid, status.st_gid) == 0);
  if (::fchmod(out_.number(), status.st_mode & kPermissions) != 0) fail(file_, errno);
}

void StagedFile::finish() {
  if (::fsync(out_.number()) != 0) fail(file_, errno);
  out_.close();
}

bool StagedFile::appear() {
  int status = ::renameat2(folder_.number(), temporary_.c_str(), folder_.number(), name_.c_str(),
                           RENAME_NOREPLACE);
  // File systems that know no such renaming know links, which replace nothing, either.
  const bool unknown = status != 0 && (errno == EINVAL || errno == ENOSYS);
  if (unknown) {
    status = ::linkat(folder_.number(), temporary_.c_str(), folder_.number(), name_.c_str(), 0);
  }
  if (status != 0 && errno == EEXIST) return false;
  if (status != 0) fail(file_, errno);
  if (!unknown) temporary_.clear();
  settle();
  return true;
}

void StagedFile::replace() {
  if (::renameat(folder_.number(), temporary_.c_str(), folder_.number(), name_.c_str()) != 0) {
    fail(file_, errno);
  }
  temporary_.clear();
  settle();
}

/// The new name reaches the disk with its folder; file systems that cannot sync a folder (some
/// network ones) order it themselves.
void StagedFile::settle() { static_cast<void>(::fsync(folder_.number())); }

}  // namespace manoscope::serve

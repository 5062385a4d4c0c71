#include "manoscope/core/atomic_file.hpp"

#include <fcntl.h>
#include <fmt/format.h>
#include <unistd.h>

#include <cerrno>
#include <string>
#include <system_error>

#include "manoscope/core/error.hpp"

namespace manoscope {
namespace {

constexpr int kAttempts = 1000;  // names tried before giving up: as many files open at once

[[noreturn]] void fail(const std::filesystem::path& target, int error) {
  std::string mend = "Check the path and the permissions of its folder";
  if (error == ENOSPC || error == EDQUOT || error == EFBIG) {
    mend = "Free some space or choose another folder";
  } else if (error == ENOENT || error == ENOTDIR) {
    mend = "Make the folder first or choose another";
  }
  throw InputError(target.string(),
                   fmt::format("cannot be written: {}",
                               std::error_code(error, std::generic_category()).message()),
                   mend);
}

/// A file descriptor that is closed on every way out.
class Descriptor {
 public:
  explicit Descriptor(int number) : number_(number) {}
  ~Descriptor() { close(); }
  Descriptor(const Descriptor&) = delete;
  Descriptor& operator=(const Descriptor&) = delete;

  int number() const { return number_; }
  bool close() {
    if (number_ < 0) return true;
    const bool closed = ::close(number_) == 0;
    number_ = -1;
    return closed;
  }

 private:
  int number_;
};

}  // namespace

AtomicFile::AtomicFile(const std::filesystem::path& target) : target_(target) {
  std::error_code ignored;
  if (std::filesystem::is_symlink(target, ignored)) {
    const auto behind = std::filesystem::weakly_canonical(target, ignored);
    if (!ignored) target_ = behind;
  }
  if (target_.filename().empty() || std::filesystem::is_directory(target_, ignored)) {
    throw InputError(target.string(), "is a folder", "Name a file to write");
  }
  // A rename would replace even a file that its owner has protected.
  if (::access(target_.c_str(), F_OK) == 0 &&
      ::faccessat(AT_FDCWD, target_.c_str(), W_OK, AT_EACCESS) != 0) {
    fail(target_, errno);
  }
  for (int attempt = 0; attempt < kAttempts; ++attempt) {
    temporary_ = target_.parent_path() / fmt::format(".manoscope-{}-{}.tmp", ::getpid(), attempt);
    Descriptor file(::open(temporary_.c_str(), O_CREAT | O_EXCL | O_WRONLY | O_CLOEXEC, 0666));
    if (file.number() >= 0) return;
    if (errno != EEXIST) fail(target_, errno);
  }
  throw InputError(target_.string(),
                   fmt::format("{} temporary files lie in its folder already", kAttempts),
                   "Remove the files .manoscope-*.tmp there");
}

AtomicFile::~AtomicFile() {
  if (!temporary_.empty()) ::unlink(temporary_.c_str());
}

void AtomicFile::commit() {
  MANO_ASSERT(!temporary_.empty());
  {
    Descriptor file(::open(temporary_.c_str(), O_RDONLY | O_CLOEXEC));
    if (file.number() < 0 || ::fsync(file.number()) != 0 || !file.close()) fail(target_, errno);
  }
  if (::rename(temporary_.c_str(), target_.c_str()) != 0) fail(target_, errno);
  temporary_.clear();
  // The rename itself reaches the disk with its folder; file systems that cannot sync a folder
  // (some network ones) order it themselves.
  const auto parent = target_.parent_path();
  const Descriptor folder(
      ::open(parent.empty() ? "." : parent.c_str(), O_RDONLY | O_DIRECTORY | O_CLOEXEC));
  if (folder.number() >= 0) static_cast<void>(::fsync(folder.number()));
}

void write_file_atomically(const std::filesystem::path& path, std::string_view bytes) {
  AtomicFile file(path);
  {
    Descriptor out(::open(file.temporary().c_str(), O_WRONLY | O_CLOEXEC));
    if (out.number() < 0) fail(file.target(), errno);
    while (!bytes.empty()) {
      const ssize_t written = ::write(out.number(), bytes.data(), bytes.size());
      if (written < 0 && errno == EINTR) continue;
      if (written < 0) fail(file.target(), errno);
      bytes.remove_prefix(static_cast<std::size_t>(written));
    }
    if (!out.close()) fail(file.target(), errno);
  }
  file.commit();
}

}  // namespace manoscope

#include "manoscope/results/publication.hpp"

#include <fcntl.h>
#include <fmt/format.h>
#include <sys/file.h>
#include <unistd.h>

#include <cerrno>
#include <system_error>
#include <utility>

#include "manoscope/core/error.hpp"

namespace manoscope::results {
namespace {

namespace fs = std::filesystem;

const char* const kStaging = ".manoscope-publication";

[[noreturn]] void refuse(const fs::path& path, const std::error_code& reason) {
  const int number = reason.value();
  const bool full = number == ENOSPC || number == EDQUOT || number == EFBIG;
  throw InputError(path.string(), fmt::format("cannot be written: {}", reason.message()),
                   full ? "Free some space or choose another folder"
                        : "Check the permissions or choose another folder");
}

[[noreturn]] void refuse(const fs::path& path, int error) {
  refuse(path, std::error_code(error, std::generic_category()));
}

/// Brings a file, or the names in a folder, to the disk.
void sync(const fs::path& path, const fs::path& shown_as) {
  const int file = ::open(path.c_str(), O_RDONLY | O_CLOEXEC);
  if (file < 0) refuse(shown_as, errno);
  const int failed = ::fsync(file) == 0 ? 0 : errno;
  ::close(file);
  // Some network file systems cannot sync a folder (EINVAL) and order renames themselves.
  if (failed != 0 && failed != EINVAL) refuse(shown_as, failed);
}

void write_bytes(const fs::path& path, const fs::path& shown_as, std::string_view bytes) {
  const int file = ::open(path.c_str(), O_CREAT | O_TRUNC | O_WRONLY | O_CLOEXEC, 0666);
  if (file < 0) refuse(shown_as, errno);
  int failed = 0;
  while (!bytes.empty() && failed == 0) {
    const ssize_t written = ::write(file, bytes.data(), bytes.size());
    if (written < 0) {
      failed = errno == EINTR ? 0 : errno;
    } else {
      bytes.remove_prefix(static_cast<std::size_t>(written));
    }
  }
  if (::close(file) != 0 && failed == 0) failed = errno;
  if (failed != 0) refuse(shown_as, failed);
}

void make_folder(const fs::path& path, const fs::path& shown_as) {
  std::error_code failure;
  fs::create_directories(path, failure);
  if (failure) refuse(shown_as, failure);
}

void move(const fs::path& from, const fs::path& to, const fs::path& shown_as) {
  std::error_code failure;
  fs::rename(from, to, failure);
  if (failure) refuse(shown_as, failure);
}

}  // namespace

Publication::Publication(fs::path folder)
    : folder_(std::move(folder)), staging_(folder_ / kStaging) {
  std::error_code ignored;
  if (fs::exists(folder_, ignored) && !fs::is_directory(folder_, ignored)) {
    throw InputError(folder_.string(), "is not a folder", "Name a folder for the result");
  }
  make_folder(folder_, folder_);
  lock_ = ::open(folder_.c_str(), O_RDONLY | O_DIRECTORY | O_CLOEXEC);
  if (lock_ < 0) refuse(folder_, errno);
  // File systems without locks answer otherwise; there the user keeps two runs apart.
  if (::flock(lock_, LOCK_EX | LOCK_NB) != 0 && errno == EWOULDBLOCK) {
    ::close(lock_);
    throw InputError(folder_.string(), "is being written by another process",
                     "Wait until it has finished or choose another folder");
  }
  try {
    fs::remove_all(staging_, ignored);
    make_folder(staging_ / "new", folder_);
    make_folder(staging_ / "old", folder_);
  } catch (...) {
    fs::remove_all(staging_, ignored);
    ::close(lock_);
    throw;
  }
}

Publication::~Publication() {
  std::error_code ignored;
  fs::remove_all(staging_, ignored);
  if (lock_ >= 0) ::close(lock_);
}

void Publication::add(const fs::path& name, std::string_view bytes) {
  add(name, [&](const fs::path& path) { write_bytes(path, folder_ / name, bytes); });
}

void Publication::add(const fs::path& name, const std::function<void(const fs::path&)>& write) {
  const fs::path path = staging_ / "new" / name;
  make_folder(path.parent_path(), (folder_ / name).parent_path());
  write(path);
  sync(path, folder_ / name);
  names_.push_back(name);
}

void Publication::publish(const std::vector<fs::path>& earlier) {
  // What must be refused is refused before anything moves.
  for (const fs::path& name : names_) {
    make_folder((folder_ / name).parent_path(), (folder_ / name).parent_path());
    std::error_code ignored;
    if (fs::is_directory(folder_ / name, ignored)) {
      throw InputError((folder_ / name).string(), "is a folder where a file is to be written",
                       "Remove the folder or choose another place for the result");
    }
  }
  std::vector<fs::path> withdrawn, published;
  const auto withdraw = [&](const fs::path& name) {
    std::error_code ignored;
    const auto status = fs::symlink_status(folder_ / name, ignored);
    if (!fs::exists(status) || fs::is_directory(status)) return;
    const fs::path place = staging_ / "old" / name;
    make_folder(place.parent_path(), folder_ / name);
    move(folder_ / name, place, folder_ / name);
    withdrawn.push_back(name);
  };
  try {
    for (const fs::path& name : earlier) withdraw(name);
    for (const fs::path& name : names_) withdraw(name);
    // Nothing slow from here to the last rename: a process killed in between leaves no result.
    for (const fs::path& name : names_) {
      move(staging_ / "new" / name, folder_ / name, folder_ / name);
      published.push_back(name);
    }
    for (const fs::path& name : names_) sync((folder_ / name).parent_path(), folder_ / name);
  } catch (...) {
    std::error_code ignored;
    for (const fs::path& name : published) fs::remove(folder_ / name, ignored);
    for (auto name = withdrawn.rbegin(); name != withdrawn.rend(); ++name) {
      fs::rename(staging_ / "old" / *name, folder_ / *name, ignored);
    }
    throw;
  }
}

}  // namespace manoscope::results

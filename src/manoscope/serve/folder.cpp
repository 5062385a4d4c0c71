#include "manoscope/serve/folder.hpp"

#include <fcntl.h>
#include <linux/openat2.h>
#include <sys/stat.h>
#include <sys/syscall.h>

#include <cerrno>
#include <string>
#include <system_error>

#include "manoscope/core/error.hpp"
#include "manoscope/serve/address.hpp"

namespace manoscope::serve {
namespace {

/// glibc has no function for this call yet. -1 and errno as with open().
int open_beneath(int folder, const std::string& relative, int flags) {
  open_how how{};
  how.flags = static_cast<std::uint64_t>(flags | O_CLOEXEC);
  how.resolve = RESOLVE_BENEATH | RESOLVE_NO_MAGICLINKS;
  const std::string path = relative.empty() ? "." : relative;
  int tries = 3;  // EAGAIN: a folder on the way was renamed meanwhile
  while (true) {
    const long opened = ::syscall(SYS_openat2, folder, path.c_str(), &how, sizeof(how));
    if (opened >= 0 || (errno != EINTR && (errno != EAGAIN || --tries == 0))) {
      return static_cast<int>(opened);
    }
  }
}

std::string message(int error) { return std::error_code(error, std::generic_category()).message(); }

}  // namespace

Folder::Folder(const std::filesystem::path& path) {
  std::error_code error;
  path_ = std::filesystem::canonical(path, error);
  if (!error) {
    descriptor_ = Descriptor(::open(path_.c_str(), O_RDONLY | O_DIRECTORY | O_CLOEXEC));
    if (!descriptor_) error = {errno, std::generic_category()};
  }
  if (error) {
    throw InputError(path.string(), "the folder cannot be opened: " + error.message(),
                     "Name a folder that you may read");
  }
  if (Descriptor(open_beneath(descriptor_.number(), "", O_RDONLY | O_DIRECTORY)).number() < 0) {
    throw InputError(path.string(), "files cannot be kept beneath it: openat2: " + message(errno),
                     "manoscope serve needs Linux 5.6 or newer");
  }
}

Descriptor Folder::open(const std::string& relative, Kind kind) const {
  // A pipe without a writer would hold whoever opens it.
  const int flags = O_RDONLY | (kind == Kind::folder ? O_DIRECTORY : O_NONBLOCK | O_NOCTTY);
  Descriptor opened(open_beneath(descriptor_.number(), relative, flags));
  if (opened && kind == Kind::file && !status_of(opened).is_file) opened.close();
  return opened;
}

bool Folder::leads_out(const std::string& relative) const {
  const Descriptor opened(open_beneath(descriptor_.number(), relative, O_PATH));
  return !opened && errno != ENOENT && errno != ENOTDIR;
}

std::string Folder::without_links(const std::string& relative) const {
  const Descriptor opened(open_beneath(descriptor_.number(), relative, O_PATH));
  if (!opened && (errno == ENOENT || errno == ENOTDIR)) return relative;
  std::error_code error;
  const auto target =
      std::filesystem::read_symlink("/proc/self/fd/" + std::to_string(opened.number()), error);
  std::string inside = target.lexically_relative(path_).string();
  if (!opened || error || inside.empty() || inside.starts_with("..")) {
    throw InputError(relative, "lies outside the folder that is served",
                     "Copy it into the folder, or serve the folder above");
  }
  return inside;
}

Descriptor Folder::make_folders(const std::vector<std::string>& parts) const {
  Descriptor folder(open_beneath(descriptor_.number(), "", O_RDONLY | O_DIRECTORY));
  std::string path;
  for (const std::string& part : parts) {
    path = under(path, part);
    ::mkdirat(folder.number(), part.c_str(), 0777);  // there already: it is opened all the same
    folder = Descriptor(open_beneath(descriptor_.number(), path, O_RDONLY | O_DIRECTORY));
    if (!folder) {
      throw InputError(path, "the folder cannot be made or opened: " + message(errno),
                       "Choose another name, or check the permissions");
    }
  }
  return folder;
}

Opened status_of(const Descriptor& descriptor) {
  struct stat status {};
  if (::fstat(descriptor.number(), &status) != 0) return {};
  return {S_ISREG(status.st_mode), static_cast<std::uint64_t>(status.st_size),
          static_cast<double>(status.st_mtim.tv_sec) +
              1e-9 * static_cast<double>(status.st_mtim.tv_nsec)};
}

}  // namespace manoscope::serve

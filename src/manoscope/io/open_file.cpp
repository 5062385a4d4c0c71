#include "manoscope/io/open_file.hpp"

#include <fcntl.h>
#include <fmt/format.h>
#include <sys/stat.h>
#include <unistd.h>

#include <cerrno>
#include <cstring>

#include "manoscope/core/error.hpp"

namespace manoscope::io {
namespace {

InputError unreadable(const std::string& where, int reason) {
  if (reason == ENOENT || reason == ENOTDIR) {
    return {where, "there is no such file", "Check the name and the folder"};
  }
  return {where, fmt::format("cannot be read: {}", std::strerror(reason)),
          "Check that you have permission to read the file"};
}

}  // namespace

OpenFile::OpenFile(const std::filesystem::path& path) : where_(path.string()) {
  // Without O_NONBLOCK the opening of a pipe would wait for whoever writes into it.
  descriptor_ = ::open(path.c_str(), O_RDONLY | O_CLOEXEC | O_NONBLOCK);
  if (descriptor_ < 0) throw unreadable(where_, errno);
  struct stat status {};
  const bool known = ::fstat(descriptor_, &status) == 0;
  if (!known || !S_ISREG(status.st_mode)) {
    const int reason = errno;
    ::close(descriptor_);
    if (!known) throw unreadable(where_, reason);
    throw InputError(where_, "is not a regular file", "Give the name of a file");
  }
  size_ = static_cast<std::uint64_t>(status.st_size);
}

OpenFile::~OpenFile() { ::close(descriptor_); }

void OpenFile::read(std::uint64_t offset, char* to, std::uint64_t n_bytes) const {
  MANO_ASSERT(offset <= size_ && n_bytes <= size_ - offset);
  while (n_bytes > 0) {
    const ssize_t n_read = ::pread(descriptor_, to, n_bytes, static_cast<off_t>(offset));
    if (n_read < 0 && errno == EINTR) continue;
    if (n_read < 0) throw unreadable(where_, errno);
    if (n_read == 0) {
      throw InputError(where_,
                       fmt::format("became shorter than its {} bytes while it was read", size_),
                       "Wait until it is written or copied, then try again");
    }
    to += n_read;
    offset += static_cast<std::uint64_t>(n_read);
    n_bytes -= static_cast<std::uint64_t>(n_read);
  }
}

}  // namespace manoscope::io

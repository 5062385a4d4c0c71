#include "manoscope/io/zlib_stream.hpp"

#include <fmt/format.h>
#include <zlib.h>

#include <algorithm>
#include <new>
#include <utility>

#include "manoscope/core/error.hpp"

namespace manoscope::io {
namespace {

constexpr const char* kCopyAgain = "The file is incomplete or damaged; copy or export it again";
constexpr std::uint64_t kBestRatio = 1032;

/// One zlib stream, unpacked piece by piece.
class Inflater {
 public:
  explicit Inflater(std::string_view zipped) : rest_(zipped) {
    if (::inflateInit(&stream_) != Z_OK) throw std::bad_alloc();
  }
  ~Inflater() { ::inflateEnd(&stream_); }
  Inflater(const Inflater&) = delete;
  Inflater& operator=(const Inflater&) = delete;

  /// Unpacks at most `room` bytes to `to`. `outcome` is Z_OK while there is more to come.
  /// @return how many.
  std::uint64_t next(char* to, std::uint64_t room, int& outcome) {
    constexpr std::uint64_t kMost = std::uint64_t{1} << 30;  // zlib counts in 32 bits
    const auto n_in = static_cast<uInt>(std::min<std::uint64_t>(rest_.size(), kMost));
    const auto n_out = static_cast<uInt>(std::min(room, kMost));
    // zlib promises not to write to its input.
    stream_.next_in = reinterpret_cast<Bytef*>(const_cast<char*>(rest_.data()));
    stream_.avail_in = n_in;
    stream_.next_out = reinterpret_cast<Bytef*>(to);
    stream_.avail_out = n_out;
    outcome = ::inflate(&stream_, Z_NO_FLUSH);
    rest_.remove_prefix(n_in - stream_.avail_in);
    return n_out - stream_.avail_out;
  }

 private:
  z_stream stream_{};
  std::string_view rest_;
};

}  // namespace

ZlibOutput::ZlibOutput(std::uint64_t n_bytes, std::uint64_t n_zipped, std::string where)
    : where_(std::move(where)) {
  if (n_bytes / kBestRatio > n_zipped) {
    throw InputError(
        where_,
        fmt::format("{} compressed bytes cannot hold the {} bytes it announces", n_zipped, n_bytes),
        kCopyAgain);
  }
  size_ = n_bytes;
  first_room_ = std::max(std::uint64_t{1} << 16, 2 * n_zipped);
}

void ZlibOutput::append(std::string_view zipped, std::uint64_t n_bytes) {
  if (n_bytes > size_ - n_filled_) {
    throw InputError(where_,
                     fmt::format("its compressed streams announce more than {} bytes", size_),
                     kCopyAgain);
  }
  const std::uint64_t end = n_filled_ + n_bytes;
  Inflater inflater(zipped);
  // Room grows with what really unpacks: an announced size alone fills no memory.
  int outcome = Z_OK;
  while (n_filled_ < end && outcome == Z_OK) {
    if (n_filled_ == bytes_.size()) {
      bytes_.resize(std::min(size_, std::max(first_room_, 2 * n_filled_)));
    }
    const std::uint64_t room = std::min<std::uint64_t>(end, bytes_.size()) - n_filled_;
    n_filled_ += inflater.next(bytes_.data() + n_filled_, room, outcome);
  }
  // One call more meets the end of the stream and its checksum; a byte more would be too many.
  char beyond = 0;
  if (outcome == Z_OK && inflater.next(&beyond, 1, outcome) > 0) outcome = Z_BUF_ERROR;
  if (outcome != Z_STREAM_END || n_filled_ != end) {
    throw InputError(where_, "a compressed stream does not unpack to the bytes it announces",
                     kCopyAgain);
  }
}

std::string_view ZlibOutput::bytes() const {
  if (n_filled_ != size_) {
    throw InputError(where_,
                     fmt::format("its compressed streams hold {} of {} bytes", n_filled_, size_),
                     kCopyAgain);
  }
  return bytes_;
}

std::string ZlibOutput::take() {
  static_cast<void>(bytes());
  return std::move(bytes_);
}

std::string unzip_head(std::string_view zipped, std::size_t n_bytes, const std::string& where) {
  std::string head(n_bytes, '\0');
  z_stream stream{};
  if (inflateInit(&stream) != Z_OK) throw InternalError("zlib cannot be started");
  // A few bytes more than any stream of so short a text takes.
  constexpr std::size_t kMostNeeded = 1 << 16;
  stream.next_in = reinterpret_cast<Bytef*>(const_cast<char*>(zipped.data()));
  stream.avail_in = static_cast<uInt>(std::min(zipped.size(), kMostNeeded));
  stream.next_out = reinterpret_cast<Bytef*>(head.data());
  stream.avail_out = static_cast<uInt>(n_bytes);
  inflate(&stream, Z_SYNC_FLUSH);
  const bool whole = stream.avail_out == 0;
  inflateEnd(&stream);
  if (!whole) throw InputError(where, "a compressed stream cannot be unpacked", kCopyAgain);
  return head;
}

}  // namespace manoscope::io

#include "manoscope/io/float_rows.hpp"

#include <fcntl.h>
#include <fmt/format.h>
#include <sys/stat.h>
#include <unistd.h>

#include <algorithm>
#include <bit>
#include <cerrno>
#include <cstring>

#include "manoscope/core/error.hpp"
#include "manoscope/core/provenance.hpp"
#include "manoscope/io/gsf.hpp"

namespace manoscope::io {
namespace {

/// A piece: small enough for the processor's second cache, large enough that calls cost little.
constexpr std::size_t kPiece = std::size_t{256} << 10;
/// Enough for a header.
constexpr std::size_t kHead = 4096;
/// Rows are handed over by so many where there are, which suits whoever takes several at a time.
constexpr std::uint64_t kTogether = 8;

}  // namespace

void PieceBuffer::make_room(std::size_t n_bytes, std::size_t n_kept) {
  constexpr std::size_t kLine = 64;
  if (capacity_ >= n_bytes) return;
  auto larger = std::make_unique_for_overwrite<char[]>(n_bytes + kLine);
  const auto over = reinterpret_cast<std::uintptr_t>(larger.get()) % kLine;
  char* const to = larger.get() + (over == 0 ? 0 : kLine - over);
  if (n_kept > 0) std::memcpy(to, data_, n_kept);
  space_ = std::move(larger);
  data_ = to;
  capacity_ = n_bytes;
}

FloatRows::FloatRows(const std::filesystem::path& path, PieceBuffer* lent)
    : path_(path), buffer_(lent != nullptr ? lent : &own_) {
  open();
  buffer_->make_room(kPiece, 0);
  char* const head = buffer_->data();
  fill(kHead);
  const void* const nul = std::memchr(head, 0, end_);
  if (nul == nullptr || static_cast<const char*>(nul) + 4 > head + end_) {
    fill(kPiece);  // a header longer than any we know
  }
  const std::string where = path.string();
  const GsfLayout layout = read_gsf_header({head, end_}, file_bytes_, where);
  if (layout.grid.pitch_x <= Length{} || layout.grid.pitch_y <= Length{}) {
    throw InputError(where, "has no lateral scale", "Add XReal and YReal to its header");
  }
  if (layout.unit.name != "m") {
    throw InputError(where, "does not say in which unit of length its heights are",
                     "Add ZUnits = m to its header");
  }
  layout_ = {layout.grid, layout.unit.scale.factor};
  n_left_ = layout.grid.ny;
  // What was read of the heights is moved to where they begin on a line of the cache.
  end_ -= layout.data;
  std::memmove(head, head + layout.data, end_);
}

FloatRows::FloatRows(const std::filesystem::path& path, const RawFloats& layout, PieceBuffer* lent)
    : path_(path),
      layout_(layout),
      n_left_(layout.grid.ny),
      buffer_(lent != nullptr ? lent : &own_) {
  const CameraGrid& grid = layout.grid;
  const std::string where = path.string();
  check_pixel_counts(static_cast<double>(grid.nx), static_cast<double>(grid.ny), where);
  open();
  const std::uint64_t expected = layout.row_bytes() * static_cast<std::uint64_t>(grid.ny);
  if (file_bytes_ == expected) return;
  throw InputError(where,
                   fmt::format("has {} bytes, but {} x {} floats need {}", file_bytes_, grid.nx,
                               grid.ny, expected),
                   "Check the size of the map against the file");
}

FloatRows::Descriptor::~Descriptor() {
  if (number >= 0) ::close(number);
}

void FloatRows::open() {
  if (std::endian::native != std::endian::little) {
    throw InputError(path_.string(), "cannot be read piece by piece on a big-endian machine",
                     "Reduce it with `manoscope measure`");
  }
  descriptor_.number = ::open(path_.c_str(), O_RDONLY | O_CLOEXEC | O_NONBLOCK);
  struct stat status {};
  if (descriptor_.number < 0 || ::fstat(descriptor_.number, &status) != 0 ||
      !S_ISREG(status.st_mode)) {
    const std::string reason = std::strerror(errno);
    static_cast<void>(read_file(path_));  // says why it cannot be read
    throw InputError(path_.string(), "cannot be read: " + reason, "Check the file");
  }
  file_bytes_ = static_cast<std::uint64_t>(status.st_size);
  ::posix_fadvise(descriptor_.number, 0, 0, POSIX_FADV_SEQUENTIAL);
}

/// Fills the buffer behind what it holds.
void FloatRows::fill(std::size_t up_to) {
  while (end_ < up_to) {
    const ssize_t got = ::read(descriptor_.number, buffer_->data() + end_, up_to - end_);
    if (got < 0 && errno == EINTR) continue;
    if (got < 0) {
      throw InputError(path_.string(), fmt::format("cannot be read: {}", std::strerror(errno)),
                       "Check the disk or the connection it lies on");
    }
    if (got == 0) break;
    end_ += static_cast<std::size_t>(got);
  }
}

std::span<const char> FloatRows::next() {
  if (n_left_ == 0) return {};
  const std::uint64_t row_bytes = layout_.row_bytes();
  if (end_ - begin_ < std::min(kTogether, static_cast<std::uint64_t>(n_left_)) * row_bytes) {
    const std::size_t kept = end_ - begin_;
    if (begin_ > 0) std::memmove(buffer_->data(), buffer_->data() + begin_, kept);
    begin_ = 0;
    end_ = kept;
    const auto piece = std::max<std::uint64_t>(kPiece, kTogether * row_bytes);
    buffer_->make_room(piece, end_);
    fill(piece);
    if (end_ < row_bytes) {
      throw InputError(path_.string(), "has become shorter while it was read",
                       "Wait until the file is written");
    }
  }
  std::uint64_t n = (end_ - begin_) / row_bytes;
  if (n > kTogether) n = n / kTogether * kTogether;
  n = std::min(n, static_cast<std::uint64_t>(n_left_));
  const std::span<const char> rows(buffer_->data() + begin_, n * row_bytes);
  begin_ += rows.size();
  n_left_ -= static_cast<Index>(n);
  return rows;
}

}  // namespace manoscope::io

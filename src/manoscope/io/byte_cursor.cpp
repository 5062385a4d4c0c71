#include "manoscope/io/byte_cursor.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <bit>
#include <cstring>
#include <limits>

namespace manoscope::io {
namespace {

constexpr const char* kCopyAgain = "The file is incomplete or damaged; copy or export it again";
constexpr std::uint64_t kWindowBytes = std::uint64_t{1} << 16;

/// The byte order is known to the compiler, so that it takes several values at a time.
template <Endian order>
void widen(const char* from, std::span<double> to) {
  constexpr bool kSwapped =
      (order == Endian::little) != (std::endian::native == std::endian::little);
  for (std::size_t i = 0; i < to.size(); ++i) {
    std::uint32_t bits = 0;
    std::memcpy(&bits, from + 4 * i, sizeof bits);
    if constexpr (kSwapped) {
      bits = bits >> 24 | (bits >> 8 & 0xff00U) | (bits << 8 & 0xff0000U) | bits << 24;
    }
    to[i] = double_from_f32_bits(bits);
  }
}

}  // namespace

double double_from_f32_bits(std::uint32_t bits) {
  // No branch: a loop over it then works on several at a time.
  const bool nan = (bits & 0x7fffffffU) > 0x7f800000U;
  return std::bit_cast<float>(nan ? 0x7fc00000U : bits);
}

double double_from_f64_bits(std::uint64_t bits) {
  if ((bits & ~(std::uint64_t{1} << 63)) > 0x7ff0000000000000ULL) {
    return std::numeric_limits<double>::quiet_NaN();
  }
  return std::bit_cast<double>(bits);
}

void ByteCursor::fail(const std::string& found, const std::string& mend) const {
  throw InputError(where_, fmt::format("{} (at byte {})", found, offset_), mend);
}

ByteCursor::ByteCursor(const std::filesystem::path& path)
    : file_(std::make_unique<const OpenFile>(path)), size_(file_->size()), where_(path.string()) {}

void ByteCursor::seek(std::uint64_t offset) {
  if (offset > size_) {
    fail(fmt::format("points to byte {}, but the file ends at byte {}", offset, size_), kCopyAgain);
  }
  offset_ = offset;
}

void ByteCursor::skip(std::uint64_t n_bytes) {
  check_length(n_bytes);
  offset_ += n_bytes;
}

void ByteCursor::align(std::uint64_t n_bytes) {
  MANO_ASSERT(n_bytes > 0);
  const std::uint64_t over = offset_ % n_bytes;
  if (over != 0) skip(n_bytes - over);
}

void ByteCursor::check_length(std::uint64_t n_bytes) const {
  if (n_bytes > remaining()) {
    fail(fmt::format("ends too early: {} more bytes are needed and {} are there", n_bytes,
                     remaining()),
         kCopyAgain);
  }
}

std::string_view ByteCursor::view(std::uint64_t offset, std::uint64_t n_bytes) {
  const bool at_hand = offset >= window_begin_ && offset - window_begin_ <= window_.size() &&
                       n_bytes <= window_.size() - (offset - window_begin_);
  if (!at_hand) {
    MANO_ASSERT(file_ != nullptr);
    const std::uint64_t n_held = std::min(std::max(n_bytes, kWindowBytes), size_ - offset);
    if (buffer_.size() < n_held) {
      buffer_ = std::string();  // not held beside the larger one
      buffer_.resize(n_held);
    }
    window_ = {};
    file_->read(offset, buffer_.data(), n_held);
    window_ = std::string_view(buffer_).substr(0, n_held);
    window_begin_ = offset;
  }
  return window_.substr(offset - window_begin_, n_bytes);
}

std::string_view ByteCursor::take(std::uint64_t n_bytes) {
  check_length(n_bytes);
  const std::string_view taken = view(offset_, n_bytes);
  offset_ += n_bytes;
  return taken;
}

bool ByteCursor::file_begins_with(std::string_view mark) {
  return mark.size() <= size_ && view(0, mark.size()) == mark;
}

std::uint64_t ByteCursor::unsigned_number(unsigned n_bytes, Endian order) {
  const std::string_view taken = take(n_bytes);
  std::uint64_t value = 0;
  for (unsigned i = 0; i < n_bytes; ++i) {
    const unsigned at = order == Endian::big ? i : n_bytes - 1 - i;
    value = value << 8 | static_cast<unsigned char>(taken[at]);
  }
  return value;
}

void ByteCursor::f32_array(Endian order, std::span<double> values) {
  require(values.size(), 4, "32-bit floats");
  constexpr std::size_t kAtOnce = kWindowBytes / 4;
  for (std::size_t first = 0; first < values.size(); first += kAtOnce) {
    const auto part = values.subspan(first, std::min(kAtOnce, values.size() - first));
    const char* const at = take(4 * part.size()).data();
    order == Endian::little ? widen<Endian::little>(at, part) : widen<Endian::big>(at, part);
  }
}

std::string ByteCursor::text(std::uint64_t n_bytes) {
  std::string_view field = take(n_bytes);
  field = field.substr(0, field.find('\0'));
  const auto last = field.find_last_not_of(" \t\r\n");
  return std::string(field.substr(0, last == std::string_view::npos ? 0 : last + 1));
}

std::string_view ByteCursor::zero_terminated() {
  const std::uint64_t start = offset_;
  for (std::uint64_t at = start; at < size_;) {
    const std::uint64_t n_bytes = file_ ? std::min(kWindowBytes, size_ - at) : size_ - at;
    const auto end = view(at, n_bytes).find('\0');
    if (end != std::string_view::npos) {
      offset_ = at + end + 1;
      return view(start, at + end - start);
    }
    at += n_bytes;
  }
  fail("a name or text has no end", kCopyAgain);
}

void ByteCursor::require(std::uint64_t count, std::uint64_t item_bytes,
                         std::string_view what) const {
  MANO_ASSERT(item_bytes > 0);
  if (count > remaining() / item_bytes) {
    fail(fmt::format("announces {} {} of {} bytes each, but only {} bytes follow", count, what,
                     item_bytes, remaining()),
         kCopyAgain);
  }
}

}  // namespace manoscope::io

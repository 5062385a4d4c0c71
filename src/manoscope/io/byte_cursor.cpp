#include "manoscope/io/byte_cursor.hpp"

#include <fmt/format.h>

#include <bit>
#include <limits>

namespace manoscope::io {
namespace {

constexpr const char* kCopyAgain = "The file is incomplete or damaged; copy or export it again";

std::uint32_t f32_bits(const char* at, Endian order) {
  const auto byte = [at](int i) { return std::uint32_t{static_cast<unsigned char>(at[i])}; };
  return order == Endian::little ? byte(0) | byte(1) << 8 | byte(2) << 16 | byte(3) << 24
                                 : byte(3) | byte(2) << 8 | byte(1) << 16 | byte(0) << 24;
}

}  // namespace

double double_from_f32_bits(std::uint32_t bits) {
  if ((bits & 0x7fffffffU) > 0x7f800000U) return std::numeric_limits<double>::quiet_NaN();
  return std::bit_cast<float>(bits);
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

void ByteCursor::seek(std::uint64_t offset) {
  if (offset > bytes_.size()) {
    fail(fmt::format("points to byte {}, but the file ends at byte {}", offset, bytes_.size()),
         kCopyAgain);
  }
  offset_ = offset;
}

void ByteCursor::align(std::uint64_t n_bytes) {
  MANO_ASSERT(n_bytes > 0);
  const std::uint64_t over = offset_ % n_bytes;
  if (over != 0) skip(n_bytes - over);
}

std::string_view ByteCursor::take(std::uint64_t n_bytes) {
  if (n_bytes > remaining()) {
    fail(fmt::format("ends too early: {} more bytes are needed and {} are there", n_bytes,
                     remaining()),
         kCopyAgain);
  }
  const std::string_view taken = bytes_.substr(offset_, n_bytes);
  offset_ += n_bytes;
  return taken;
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
  const char* at = take(4 * values.size()).data();
  for (double& value : values) {
    value = double_from_f32_bits(f32_bits(at, order));
    at += 4;
  }
}

std::string ByteCursor::text(std::uint64_t n_bytes) {
  std::string_view field = take(n_bytes);
  field = field.substr(0, field.find('\0'));
  const auto last = field.find_last_not_of(" \t\r\n");
  return std::string(field.substr(0, last == std::string_view::npos ? 0 : last + 1));
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

#pragma once

#include <cstdint>
#include <filesystem>
#include <memory>
#include <span>
#include <string>
#include <string_view>

#include "manoscope/core/error.hpp"
#include "manoscope/io/open_file.hpp"

namespace manoscope::io {

enum class Endian { little, big };

/// The value of an IEEE 754 bit pattern; every NaN becomes the quiet one.
///
/// Files hold signalling NaN (a mutated or a marked pixel), and touching one as a float raises the
/// invalid-operation exception.
double double_from_f32_bits(std::uint32_t bits);
double double_from_f64_bits(std::uint64_t bits);

/// Reads the bytes of an untrusted file, front to back, without ever leaving them.
///
/// Every number names its byte order. A read or a jump past the end throws an InputError that names
/// the file, the offset, what was wanted and what is there.
class ByteCursor {
 public:
  /// Over bytes in memory, which outlive the cursor and every view that it hands out.
  /// @param where  the file's name, for messages.
  ByteCursor(std::string_view bytes, std::string where)
      : window_(bytes), size_(bytes.size()), where_(std::move(where)) {}
  /// Over a file, of which no more than 64 KiB are held at a time, or the longest run of bytes that
  /// was asked for at once. A view that bytes() or zero_terminated() hands out holds until the next
  /// call that reads.
  /// @throws InputError if the file cannot be opened.
  explicit ByteCursor(const std::filesystem::path& path);
  ByteCursor(const ByteCursor&) = delete;
  ByteCursor& operator=(const ByteCursor&) = delete;

  std::uint64_t size() const { return size_; }
  std::uint64_t offset() const { return offset_; }
  std::uint64_t remaining() const { return size_ - offset_; }
  const std::string& where() const { return where_; }

  void seek(std::uint64_t offset);
  void skip(std::uint64_t n_bytes);
  /// Skips to the next offset that is a multiple of `n_bytes`.
  void align(std::uint64_t n_bytes);

  std::uint8_t u8() { return static_cast<std::uint8_t>(take(1)[0]); }
  std::uint16_t u16(Endian order) { return static_cast<std::uint16_t>(unsigned_number(2, order)); }
  std::uint32_t u32(Endian order) { return static_cast<std::uint32_t>(unsigned_number(4, order)); }
  std::uint64_t u64(Endian order) { return unsigned_number(8, order); }
  std::int8_t i8() { return static_cast<std::int8_t>(u8()); }
  std::int16_t i16(Endian order) { return static_cast<std::int16_t>(u16(order)); }
  std::int32_t i32(Endian order) { return static_cast<std::int32_t>(u32(order)); }
  std::int64_t i64(Endian order) { return static_cast<std::int64_t>(u64(order)); }
  double f32(Endian order) { return double_from_f32_bits(u32(order)); }
  double f64(Endian order) { return double_from_f64_bits(u64(order)); }
  /// Fills `values` with as many 32-bit floats.
  void f32_array(Endian order, std::span<double> values);

  /// True if the file, wherever the cursor stands, begins with `mark`.
  bool file_begins_with(std::string_view mark);

  /// The next `n_bytes`, as they are.
  std::string_view bytes(std::uint64_t n_bytes) { return take(n_bytes); }
  /// A text field of fixed width: up to the first NUL, without trailing blanks.
  std::string text(std::uint64_t n_bytes);
  /// The bytes up to the next NUL, which is passed over.
  std::string_view zero_terminated();

  /// Makes sure that `count` items of `item_bytes` each still follow, before anyone makes room for
  /// them. `what` names them in the message: "heights".
  void require(std::uint64_t count, std::uint64_t item_bytes, std::string_view what) const;
  /// An InputError of this file that names the current offset.
  [[noreturn]] void fail(const std::string& found, const std::string& mend) const;

 private:
  void check_length(std::uint64_t n_bytes) const;
  std::string_view take(std::uint64_t n_bytes);
  /// The `n_bytes` from `offset` on, which are in the file.
  std::string_view view(std::uint64_t offset, std::uint64_t n_bytes);
  std::uint64_t unsigned_number(unsigned n_bytes, Endian order);

  std::unique_ptr<const OpenFile> file_;  ///< none over bytes in memory
  std::string buffer_;                    ///< of a file: what `window_` looks at
  std::string_view window_;               ///< the bytes at hand
  std::uint64_t window_begin_ = 0, size_ = 0;
  std::string where_;
  std::uint64_t offset_ = 0;
};

}  // namespace manoscope::io

#pragma once

#include <cstdint>
#include <string>
#include <string_view>

namespace manoscope::io {

/// Unpacks zlib streams that follow one another into one run of bytes of known length.
///
/// Announced sizes are believed only if the streams can hold as much (zlib never shrinks data below
/// 1/1032), and room grows with what really unpacks. Whatever the streams hold, no more than
/// `n_bytes` are ever written.
class ZlibOutput {
 public:
  /// @param n_zipped  bytes of all streams together.
  /// @throws InputError(where, ...) if `n_zipped` bytes cannot unpack to `n_bytes`.
  ZlibOutput(std::uint64_t n_bytes, std::uint64_t n_zipped, std::string where);

  /// @throws InputError(where, ...) unless the stream is whole and unpacks to `n_bytes` that still
  ///         fit.
  void append(std::string_view zipped, std::uint64_t n_bytes);

  /// All bytes.
  /// @throws InputError(where, ...) if bytes are missing.
  std::string_view bytes() const;
  /// All bytes, handed over.
  std::string take();

 private:
  std::string where_;
  std::string bytes_;  ///< room for what is unpacked so far
  std::uint64_t size_ = 0, n_filled_ = 0, first_room_ = 0;
};

/// The first `n_bytes` that a zlib stream unpacks to, where it tells its own length there.
/// @throws InputError(where, ...) if it holds fewer.
std::string unzip_head(std::string_view zipped, std::size_t n_bytes, const std::string& where);

}  // namespace manoscope::io

#include "manoscope/report/packed.hpp"

#include <fmt/format.h>
#include <zlib.h>

#include <cstdlib>

#include "manoscope/core/base64.hpp"
#include "manoscope/core/error.hpp"

namespace manoscope::report {
namespace {

std::uint16_t folded(int difference) {
  return static_cast<std::uint16_t>(difference >= 0 ? 2 * difference : -2 * difference - 1);
}

/// Low bytes of the folded differences, then the high bytes.
std::string differences(const Counts2& counts) {
  const auto n = static_cast<std::size_t>(counts.size());
  std::string bytes(2 * n, '\0');
  int last = 0;
  for (std::size_t i = 0; i < n; ++i) {
    const int count = counts.data()[i];
    std::uint16_t code = kMissingCode;
    if (count != MapPicture::kMissing) {
      MANO_ASSERT(std::abs(count) <= MapPicture::kLargest);
      code = folded(count - last);
      last = count;
    }
    bytes[i] = static_cast<char>(code & 0xFF);
    bytes[n + i] = static_cast<char>(code >> 8);
  }
  return bytes;
}

std::string deflated(std::string_view bytes, int strategy) {
  constexpr int kLevel = 9, kWindow = 15, kMemory = 9;
  z_stream stream{};
  if (deflateInit2(&stream, kLevel, Z_DEFLATED, kWindow, kMemory, strategy) != Z_OK) {
    throw InternalError("zlib cannot begin");
  }
  std::string packed(deflateBound(&stream, static_cast<uLong>(bytes.size())), '\0');
  stream.next_in = reinterpret_cast<Bytef*>(const_cast<char*>(bytes.data()));
  stream.avail_in = static_cast<uInt>(bytes.size());
  stream.next_out = reinterpret_cast<Bytef*>(packed.data());
  stream.avail_out = static_cast<uInt>(packed.size());
  const int status = deflate(&stream, Z_FINISH);
  packed.resize(stream.total_out);
  deflateEnd(&stream);
  if (status != Z_STREAM_END) throw InternalError(fmt::format("zlib stopped with {}", status));
  return packed;
}

}  // namespace

std::string pack_text(std::string_view text) { return base64(deflated(text, Z_DEFAULT_STRATEGY)); }

std::string pack_counts(const Counts2& counts) {
  // Noise repeats nothing: codes by frequency and runs of zeros are all there is to gain.
  return base64(deflated(differences(counts), Z_RLE));
}

}  // namespace manoscope::report

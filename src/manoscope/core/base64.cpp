#include "manoscope/core/base64.hpp"

#include <openssl/evp.h>

#include <algorithm>

namespace manoscope {

std::string base64(std::string_view bytes) {
  constexpr std::size_t kPiece = 3 << 20;  // EVP counts in int; whole groups of three leave no "="
  std::string text;
  text.reserve((bytes.size() + 2) / 3 * 4);
  std::string encoded(kPiece / 3 * 4 + 1, '\0');  // and the zero that EVP adds
  for (std::size_t start = 0; start < bytes.size(); start += kPiece) {
    const std::size_t n = std::min(kPiece, bytes.size() - start);
    const int length = EVP_EncodeBlock(reinterpret_cast<unsigned char*>(encoded.data()),
                                       reinterpret_cast<const unsigned char*>(bytes.data() + start),
                                       static_cast<int>(n));
    text.append(encoded, 0, static_cast<std::size_t>(length));
  }
  return text;
}

}  // namespace manoscope

#include "manoscope/io/md5.hpp"

#include <fmt/format.h>
#include <openssl/evp.h>

#include <array>

#include "manoscope/core/error.hpp"

namespace manoscope::io {

std::string md5(std::string_view bytes) {
  std::array<unsigned char, 16> digest{};
  unsigned int length = 0;
  const int done =
      EVP_Digest(bytes.data(), bytes.size(), digest.data(), &length, EVP_md5(), nullptr);
  if (done != 1 || length != digest.size()) throw InternalError("MD5 is not available");
  std::string text;
  for (const unsigned char byte : digest) text += fmt::format("{:02x}", byte);
  return text;
}

}  // namespace manoscope::io

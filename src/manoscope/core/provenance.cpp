#include "manoscope/core/provenance.hpp"

#include <fmt/format.h>
#include <openssl/evp.h>

#include <array>
#include <cerrno>
#include <cstring>
#include <fstream>

#include "generated/manoscope_revision.inc"
#include "manoscope/core/error.hpp"

namespace manoscope {

std::string_view program_version() { return MANOSCOPE_VERSION; }
std::string_view source_revision() { return MANOSCOPE_REVISION; }

std::string sha256(std::string_view bytes) {
  std::array<unsigned char, 32> digest{};
  unsigned int length = 0;
  const int done =
      EVP_Digest(bytes.data(), bytes.size(), digest.data(), &length, EVP_sha256(), nullptr);
  if (done != 1 || length != digest.size()) throw InternalError("SHA-256 is not available");
  std::string text;
  for (const unsigned char byte : digest) text += fmt::format("{:02x}", byte);
  return text;
}

std::string read_file(const std::filesystem::path& path, std::uintmax_t largest) {
  std::error_code failure;
  const auto status = std::filesystem::status(path, failure);
  if (status.type() == std::filesystem::file_type::not_found) {
    throw InputError(path.string(), "there is no such file", "Check the name and the folder");
  }
  if (failure) {
    throw InputError(path.string(), "cannot be reached: " + failure.message(),
                     "Check the permissions of the folder");
  }
  if (!std::filesystem::is_regular_file(status)) {
    throw InputError(path.string(), "is not a regular file", "Give the name of a file");
  }
  const std::uintmax_t size = std::filesystem::file_size(path, failure);
  if (failure || size > largest) {
    throw InputError(path.string(), failure ? failure.message() : fmt::format("has {} bytes", size),
                     fmt::format("Give a file of at most {} bytes", largest));
  }
  std::ifstream stream(path, std::ios::binary);
  std::string bytes(size, '\0');
  if (!stream || !stream.read(bytes.data(), static_cast<std::streamsize>(size))) {
    throw InputError(path.string(), fmt::format("cannot be read: {}", std::strerror(errno)),
                     "Check that you have permission to read the file");
  }
  return bytes;
}

}  // namespace manoscope

#include "manoscope/report/packed.hpp"

#include <gtest/gtest.h>
#include <zlib.h>

#include <cmath>
#include <string>
#include <vector>

#include "manoscope/core/random.hpp"

namespace manoscope::report {
namespace {

std::string from_base64(const std::string& text) {
  static const std::string kLetters =
      "ABCDEFGHIJKLMNOPQRSTUVWXYZabcdefghijklmnopqrstuvwxyz0123456789+/";
  std::string bytes;
  unsigned bits = 0, n_bits = 0;
  for (const char letter : text) {
    if (letter == '=') break;
    bits = (bits << 6) | static_cast<unsigned>(kLetters.find(letter));
    n_bits += 6;
    if (n_bits < 8) continue;
    n_bits -= 8;
    bytes += static_cast<char>((bits >> n_bits) & 0xFF);
  }
  return bytes;
}

/// What a page does with a map, written anew.
std::vector<int> unpacked(const std::string& text, std::size_t n) {
  const std::string packed = from_base64(text);
  std::vector<unsigned char> bytes(2 * n + 16);
  uLongf length = bytes.size();
  EXPECT_EQ(uncompress(bytes.data(), &length, reinterpret_cast<const Bytef*>(packed.data()),
                       packed.size()),
            Z_OK);
  EXPECT_EQ(length, 2 * n);
  std::vector<int> counts;
  int last = 0;
  for (std::size_t i = 0; i < n; ++i) {
    const int code = bytes[i] + 256 * bytes[n + i];
    if (code == kMissingCode) {
      counts.push_back(MapPicture::kMissing);
      continue;
    }
    last += code % 2 == 0 ? code / 2 : -(code + 1) / 2;
    counts.push_back(last);
  }
  return counts;
}

void expect_same(const Counts2& counts) {
  const auto back = unpacked(pack_counts(counts), static_cast<std::size_t>(counts.size()));
  for (Index i = 0; i < counts.size(); ++i) {
    ASSERT_EQ(back[static_cast<std::size_t>(i)], counts.data()[i]) << i;
  }
}

Counts2 noise(Index n_z, Index n_x, double deviation) {
  RandomStream stream(11, "packed");
  return Counts2::NullaryExpr(n_z, n_x, [&](Index, Index) {
    return static_cast<std::int16_t>(std::lround(deviation * stream.normal()));
  });
}

TEST(PackText, GivesBackTheText) {
  for (const std::string& text :
       std::vector<std::string>{"", "</script><!-- µ", std::string(100000, 'a')}) {
    const std::string packed = from_base64(pack_text(text));
    std::string back(text.size() + 1, '\0');
    uLongf length = back.size();
    EXPECT_EQ(uncompress(reinterpret_cast<Bytef*>(back.data()), &length,
                         reinterpret_cast<const Bytef*>(packed.data()), packed.size()),
              Z_OK);
    EXPECT_EQ(back.substr(0, length), text);
  }
}

TEST(PackCounts, GivesBackEveryCount) {
  Counts2 counts = noise(37, 53, 40.0);
  counts(0, 0) = counts(36, 52) = counts(4, 7) = MapPicture::kMissing;
  counts.block(10, 10, 5, 20).setConstant(MapPicture::kMissing);
  counts(20, 1) = MapPicture::kLargest;
  counts(20, 2) = -MapPicture::kLargest;
  counts(20, 3) = MapPicture::kLargest;
  expect_same(counts);
  expect_same(Counts2::Constant(3, 4, MapPicture::kMissing));
  expect_same(Counts2::Zero(1, 1));
}

TEST(PackCounts, OfNoiseIsNearItsEntropy) {
  // Differences of normal noise of two steps: log2(sqrt(2 pi e) * 2 sqrt 2) = 3.55 bits; base64
  // adds a third. A tenth more is the price of whole bits a code.
  const std::string packed = pack_counts(noise(192, 1024, 2.0));
  EXPECT_LT(static_cast<double>(packed.size()), 1.1 * 4.0 / 3.0 * 3.55 / 8.0 * 192 * 1024);
}

TEST(PackCounts, HasTheSameBytesEveryTime) {
  const Counts2 counts = noise(50, 60, 3.0);
  EXPECT_EQ(pack_counts(counts), pack_counts(counts));
}

}  // namespace
}  // namespace manoscope::report

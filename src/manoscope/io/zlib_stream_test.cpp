#include "manoscope/io/zlib_stream.hpp"

#include <gtest/gtest.h>

#include "manoscope/core/error.hpp"
#include "manoscope/io/test_files.hpp"

namespace manoscope::io {
namespace {

/// zlib.compress(b"abcabcabcabc", 9), by another program.
const std::string kTwelveLetters("\x78\xda\x4b\x4c\x4a\x4e\x84\x21\x00\x1d\xe0\x04\x99", 13);

TEST(ZlibStream, StreamsAreUnpackedOneAfterTheOther) {
  ZlibOutput output(24, 2 * kTwelveLetters.size(), "a.sur");
  output.append(kTwelveLetters, 12);
  EXPECT_THROW(static_cast<void>(output.bytes()), InputError);  // half of it is missing
  output.append(kTwelveLetters, 12);
  EXPECT_EQ(output.bytes(), "abcabcabcabcabcabcabcabc");
}

TEST(ZlibStream, AStreamThatIsLongerShorterOrBrokenIsRefused) {
  ZlibOutput output(24, 100, "a.sur");
  EXPECT_THROW(output.append(kTwelveLetters, 11), InputError);
  EXPECT_THROW(output.append(kTwelveLetters, 13), InputError);
  EXPECT_THROW(output.append(kTwelveLetters, 25), InputError);
  EXPECT_THROW(output.append(kTwelveLetters.substr(0, 10), 12), InputError);
  EXPECT_THROW(output.append("", 12), InputError);
}

TEST(ZlibStream, NoRoomIsMadeForWhatTheBytesCannotHold) {
  const auto found = testing::complaint([] { ZlibOutput(1000000000, 900000, "a.sur"); });
  EXPECT_TRUE(testing::contains(found, "900000 compressed bytes cannot hold the 1000000000 bytes"));
}

}  // namespace
}  // namespace manoscope::io

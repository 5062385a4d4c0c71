#include "manoscope/io/byte_cursor.hpp"

#include <gtest/gtest.h>

#include <array>
#include <cmath>
#include <limits>
#include <vector>

#include "manoscope/io/test_files.hpp"

namespace manoscope::io {
namespace {

using testing::complaint;
using testing::contains;

TEST(ByteCursor, ReadsNumbersOfBothByteOrders) {
  const std::string bytes("\x01\x02\x03\x04\x05\x06\x07\x08", 8);
  const auto at_start = [&] { return ByteCursor(bytes, "f"); };
  EXPECT_EQ(at_start().u8(), 0x01);
  EXPECT_EQ(at_start().u16(Endian::big), 0x0102);
  EXPECT_EQ(at_start().u16(Endian::little), 0x0201);
  EXPECT_EQ(at_start().u32(Endian::big), 0x01020304U);
  EXPECT_EQ(at_start().u32(Endian::little), 0x04030201U);
  EXPECT_EQ(at_start().u64(Endian::big), 0x0102030405060708ULL);
  EXPECT_EQ(at_start().u64(Endian::little), 0x0807060504030201ULL);
}

TEST(ByteCursor, ReadsSignedNumbersInTwosComplement) {
  EXPECT_EQ(ByteCursor("\xff", "f").i8(), -1);
  EXPECT_EQ(ByteCursor("\xfe\xff", "f").i16(Endian::little), -2);
  EXPECT_EQ(ByteCursor("\xff\xff\xff\xfd", "f").i32(Endian::big), -3);
  EXPECT_EQ(ByteCursor(std::string(7, '\xff') + "\x80", "f").i64(Endian::big), -128);
}

TEST(ByteCursor, ReadsIeeeFloats) {
  // Bit patterns written out by hand: 1.5 = 1.1b * 2^0, -0.15625 = -1.01b * 2^-3.
  EXPECT_EQ(ByteCursor(std::string("\x3f\xc0\x00\x00", 4), "f").f32(Endian::big), 1.5);
  EXPECT_EQ(ByteCursor(std::string("\x00\x00\x20\xbe", 4), "f").f32(Endian::little), -0.15625);
  EXPECT_EQ(ByteCursor(std::string("\x3f\xf8\x00\x00\x00\x00\x00\x00", 8), "f").f64(Endian::big),
            1.5);
  std::array<double, 2> values{};
  ByteCursor(std::string("\x00\x00\xc0\x3f\x00\x00\x20\xbe", 8), "f")
      .f32_array(Endian::little, values);
  EXPECT_EQ(values[0], 1.5);
  EXPECT_EQ(values[1], -0.15625);
}

TEST(ByteCursor, MakesSignallingNanQuiet) {
  // Floating-point traps are on: touching these as floats would end the test.
  EXPECT_TRUE(std::isnan(double_from_f32_bits(0x7f800001U)));
  EXPECT_TRUE(std::isnan(double_from_f32_bits(0xffa00000U)));
  EXPECT_TRUE(std::isnan(double_from_f64_bits(0x7ff0000000000001ULL)));
  EXPECT_TRUE(std::isnan(double_from_f64_bits(0xfff4000000000000ULL)));
  EXPECT_EQ(double_from_f32_bits(0x7f800000U), std::numeric_limits<double>::infinity());
  EXPECT_EQ(double_from_f64_bits(0xfff0000000000000ULL), -std::numeric_limits<double>::infinity());
  EXPECT_EQ(double_from_f32_bits(0x00000001U), std::ldexp(1.0, -149));  // smallest of all
}

TEST(ByteCursor, NeverLeavesTheBytesAndSaysWhere) {
  ByteCursor cursor("abcde", "map.dat");
  cursor.skip(3);
  const std::string text = complaint([&] { static_cast<void>(cursor.u32(Endian::little)); });
  EXPECT_TRUE(contains(text, "map.dat | ends too early: 4 more bytes are needed and 2 are there"));
  EXPECT_TRUE(contains(text, "at byte 3"));
  EXPECT_EQ(cursor.offset(), 3U);  // a refused read moves nothing
  EXPECT_THROW(cursor.seek(6), InputError);
  EXPECT_NO_THROW(cursor.seek(5));
  EXPECT_THROW(cursor.u8(), InputError);
  EXPECT_THROW(cursor.skip(std::numeric_limits<std::uint64_t>::max()), InputError);
  EXPECT_THROW(ByteCursor("", "f").u8(), InputError);
}

TEST(ByteCursor, RefusesCountsThatTheFileCannotHold) {
  ByteCursor cursor(std::string(100, '\0'), "map.dat");
  EXPECT_NO_THROW(cursor.require(25, 4, "heights"));
  EXPECT_TRUE(contains(complaint([&] { cursor.require(26, 4, "heights"); }),
                       "announces 26 heights of 4 bytes each, but only 100 bytes follow"));
  // The product of count and size would wrap around to 0.
  EXPECT_THROW(cursor.require(std::uint64_t{1} << 62, 4, "heights"), InputError);
}

TEST(ByteCursor, ReadsTextFieldsOfFixedWidthAndAligns) {
  const std::string bytes("um  \0xyz|next", 13);
  ByteCursor cursor(bytes, "f");
  EXPECT_EQ(cursor.text(8), "um");
  cursor.align(4);
  EXPECT_EQ(cursor.offset(), 8U);
  cursor.skip(1);
  cursor.align(4);
  EXPECT_EQ(cursor.offset(), 12U);
  EXPECT_THROW(cursor.align(16), InputError);
}

TEST(ByteCursor, OverAFileReadsWhatItReadsOverItsBytes) {
  const testing::TestFolder folder;
  std::string bytes(200001, '\0');
  for (std::size_t i = 0; i < bytes.size(); ++i) bytes[i] = static_cast<char>(1 + i * 7 % 251);
  bytes[180000] = '\0';  // ends a text that is longer than the window
  const auto path = folder.write("a.bin", bytes);
  ByteCursor file(path), memory(bytes, path.string());
  EXPECT_EQ(file.size(), bytes.size());
  EXPECT_TRUE(file.file_begins_with(bytes.substr(0, 20)));
  EXPECT_FALSE(file.file_begins_with("Directory"));
  // Numbers before, across and behind the ends of windows of 64 KiB, in both directions.
  for (const std::uint64_t offset : {65533U, 0U, 131071U, 199993U, 65536U, 65530U}) {
    file.seek(offset);
    memory.seek(offset);
    EXPECT_EQ(file.u64(Endian::big), memory.u64(Endian::big)) << offset;
  }
  file.seek(10);
  memory.seek(10);
  EXPECT_EQ(file.zero_terminated(), memory.zero_terminated());
  EXPECT_EQ(file.offset(), memory.offset());
  EXPECT_EQ(file.bytes(20000), memory.bytes(20000));
  EXPECT_THROW(static_cast<void>(file.u8()), InputError);  // 200001 is the end
  EXPECT_EQ(file.remaining(), 0U);
}

TEST(ByteCursor, OverAFileThatIsNoneOrShrinksGivesAnInputError) {
  using testing::complaint;
  using testing::contains;
  const testing::TestFolder folder;
  EXPECT_TRUE(contains(complaint([&] { ByteCursor(folder / "none"); }), "there is no such file"));
  EXPECT_TRUE(contains(complaint([&] { ByteCursor(folder.path()); }), "not a regular file"));
  const auto path = folder.write("a.bin", std::string(100000, 'x'));
  ByteCursor cursor(path);
  std::filesystem::resize_file(path, 10);
  EXPECT_TRUE(contains(complaint([&] { static_cast<void>(cursor.u32(Endian::little)); }),
                       "became shorter than its 100000 bytes"));
}

}  // namespace
}  // namespace manoscope::io

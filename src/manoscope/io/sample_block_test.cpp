#include "manoscope/io/sample_block.hpp"

#include <gtest/gtest.h>

#include <cmath>

#include "manoscope/io/test_files.hpp"

namespace manoscope::io {
namespace {

using testing::big;
using testing::complaint;
using testing::contains;
using testing::little;

TEST(SampleBlock, EveryTypeIsReadInBothByteOrders) {
  const auto read = [](const std::string& bytes, SampleType type, Endian order) {
    ByteCursor cursor(bytes, "a.bin");
    double value = 0.0;
    read_samples(cursor, type, order, {&value, 1});
    EXPECT_EQ(cursor.remaining(), 0U);
    return value;
  };
  EXPECT_EQ(read("\xfe", SampleType::u8, Endian::little), 254.0);
  EXPECT_EQ(read(big(0xfffe, 2), SampleType::u16, Endian::big), 65534.0);
  EXPECT_EQ(read(little(0xfffe, 2), SampleType::i16, Endian::little), -2.0);
  EXPECT_EQ(read(big(0x80000001, 4), SampleType::u32, Endian::big), 2147483649.0);
  EXPECT_EQ(read(little(0x80000001, 4), SampleType::i32, Endian::little), -2147483647.0);
  EXPECT_EQ(read(big(-1.5F), SampleType::f32, Endian::big), -1.5);
  EXPECT_EQ(read(big(-1.5e300), SampleType::f64, Endian::big), -1.5e300);
}

TEST(SampleBlock, RowsRunFromTheTopAndColumnsFromBelow) {
  const std::string bytes("\1\2\3\4\5\6", 6);
  ByteCursor cursor(bytes, "a.bin");
  Array2 rows = read_block(cursor, SampleType::u8, Endian::little, 3, 2, "heights");
  Array2 expected(2, 3);
  expected << 1, 2, 3, 4, 5, 6;
  EXPECT_TRUE((rows == expected).all());
  turn_rows_over(rows);
  expected << 4, 5, 6, 1, 2, 3;
  EXPECT_TRUE((rows == expected).all());
  cursor.seek(0);
  expected << 2, 4, 6, 1, 3, 5;
  EXPECT_TRUE(
      (read_columns_from_below(cursor, SampleType::u8, Endian::little, 3, 2, "heights") == expected)
          .all());
}

TEST(SampleBlock, ABlockBeyondTheFileIsRefusedBeforeRoomIsMade) {
  ByteCursor cursor("123456", "a.bin");
  EXPECT_TRUE(contains(
      complaint([&] { read_block(cursor, SampleType::f32, Endian::big, 30000, 30000, "heights"); }),
      "announces 900000000 heights of 4 bytes each, but only 6 bytes follow"));
  EXPECT_TRUE(
      contains(complaint([&] { read_block(cursor, SampleType::u8, Endian::big, 0, 5, "heights"); }),
               "0 x 5 pixels"));
}

TEST(SampleBlock, MissingSamplesBecomeNanAndNanStay) {
  Array2 values(1, 3);
  values << 1.0, 7.0, std::nan("");
  mark_missing(values, [](double value) { return value > 5.0; });
  EXPECT_EQ(values(0, 0), 1.0);
  EXPECT_TRUE(std::isnan(values(0, 1)));
  EXPECT_TRUE(std::isnan(values(0, 2)));
}

TEST(SampleBlock, SettingsAreReadableTextOrLeftOut) {
  Channel channel;
  add_setting(channel, "empty", "  ");
  add_setting(channel, "none", std::nan(""));
  add_setting(channel, "wavelength", 632.8, "nm");
  add_setting(channel, "stylus", "2.5 \xb5m\nsharp");  // Latin-1
  add_setting(channel, "tip", "2.5 \xc2\xb5m");        // UTF-8
  ASSERT_EQ(channel.settings.size(), 3U);
  EXPECT_EQ(channel.settings[0].second, "632.8 nm");
  EXPECT_EQ(channel.settings[1].second, "2.5 \xc2\xb5m sharp");
  EXPECT_EQ(channel.settings[2].second, "2.5 \xc2\xb5m");
}

TEST(SampleBlock, AScaleThatIsNoNumberIsRefused) {
  EXPECT_THROW(make_channel("height", "m", Array2::Ones(2, 2), std::nan(""), "a.bin"), InputError);
  EXPECT_THROW(make_channel("height", "m", Array2::Ones(2, 2), 0.0, "a.bin"), InputError);
}

}  // namespace
}  // namespace manoscope::io

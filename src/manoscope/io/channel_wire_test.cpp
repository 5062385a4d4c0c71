#include "manoscope/io/channel_wire.hpp"

#include <gtest/gtest.h>

#include <cmath>
#include <cstring>
#include <limits>

#include "manoscope/io/test_files.hpp"

namespace manoscope::io {
namespace {

Channel example() {
  Channel channel;
  channel.name = "Surface";
  channel.unit = "m";
  channel.file_unit = "NanoMeters";
  channel.page = 3;
  channel.grid = CameraGrid{3, 2, 1.5 * um, 2.5 * um};
  channel.offset_x = -7;
  channel.offset_y = 12;
  channel.settings = {{"objective", "10x"}, {"", ""}};
  channel.warnings = {"doubtful"};
  channel.values.resize(2, 3);
  channel.values << 1e-9, -0.0, 3e-300, std::numeric_limits<double>::quiet_NaN(), 5e200, 6;
  return channel;
}

std::string answer_with(const std::vector<Channel>& channels) {
  std::string bytes;
  write_channels(channels, [&](const void* at, std::size_t n) {
    bytes.append(static_cast<const char*>(at), n);
  });
  return bytes;
}

WireSource source_of(const std::string& bytes) {
  return [&bytes, at = std::size_t{0}](void* into, std::size_t n) mutable {
    if (n > bytes.size() - at) throw BrokenAnswer("ends early");
    std::memcpy(into, bytes.data() + at, n);
    at += n;
  };
}

constexpr std::uintmax_t kPlenty = 1 << 20;

TEST(ChannelWire, CarriesEveryFieldAndEveryBit) {
  const Channel sent = example();
  const std::string bytes = answer_with({sent, sent});
  const auto got = read_answer(source_of(bytes), kPlenty);
  ASSERT_EQ(got.size(), 2U);
  const Channel& channel = got[1];
  EXPECT_EQ(channel.name, sent.name);
  EXPECT_EQ(channel.unit, sent.unit);
  EXPECT_EQ(channel.file_unit, sent.file_unit);
  EXPECT_EQ(channel.page, 3);
  EXPECT_EQ(channel.grid, sent.grid);
  EXPECT_EQ(channel.offset_x, -7);
  EXPECT_EQ(channel.offset_y, 12);
  EXPECT_EQ(channel.settings, sent.settings);
  EXPECT_EQ(channel.warnings, sent.warnings);
  ASSERT_EQ(channel.values.size(), 6);
  EXPECT_EQ(std::memcmp(channel.values.data(), sent.values.data(), 6 * sizeof(double)), 0);
}

TEST(ChannelWire, CarriesAnErrorWithItsThreeParts) {
  std::string bytes;
  write_error(InputError("a.datx", "is broken", "mend it"), [&](const void* at, std::size_t n) {
    bytes.append(static_cast<const char*>(at), n);
  });
  EXPECT_EQ(testing::complaint([&] { read_answer(source_of(bytes), kPlenty); }),
            "a.datx | is broken | mend it");
}

TEST(ChannelWire, EveryTruncationIsABrokenAnswer) {
  const std::string bytes = answer_with({example()});
  for (std::size_t length = 0; length < bytes.size(); ++length) {
    const std::string cut = bytes.substr(0, length);
    EXPECT_THROW(read_answer(source_of(cut), kPlenty), BrokenAnswer) << length;
  }
}

TEST(ChannelWire, NoByteThatIsWrongGetsBeyondTheLimitsOrRaisesATrap) {
  // Channels, an InputError or a BrokenAnswer: never room for what is not there, never a signalling
  // NaN (the tests trap on these).
  const std::string whole = answer_with({example()});
  for (std::size_t at = 0; at < whole.size(); ++at) {
    for (const int value : {0x00, 0x7f, 0xf4, 0xff}) {
      std::string bytes = whole;
      bytes[at] = static_cast<char>(value);
      try {
        for (const Channel& channel : read_answer(source_of(bytes), kPlenty)) {
          double sum = 0.0;
          for (Index i = 0; i < channel.values.size(); ++i) {
            const double one = channel.values.data()[i];
            if (std::isfinite(one)) sum += 1e-200 * one;
          }
          EXPECT_TRUE(std::isfinite(sum));
          EXPECT_LE(channel.values.size(), 6);
        }
      } catch (const InputError&) {
      } catch (const BrokenAnswer&) {
      }
    }
  }
}

TEST(ChannelWire, MoreValuesThanTheProcessCouldHoldAreRefused) {
  const std::string bytes = answer_with({example()});
  EXPECT_NO_THROW(read_answer(source_of(bytes), 6 * sizeof(double)));
  EXPECT_THROW(read_answer(source_of(bytes), 6 * sizeof(double) - 1), BrokenAnswer);
}

}  // namespace
}  // namespace manoscope::io

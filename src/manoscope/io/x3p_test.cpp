// .x3p files built by hand from the description in ISO 25178-72, and damaged ones.
#include <gtest/gtest.h>

#include <cmath>
#include <limits>

#include "manoscope/io/md5.hpp"
#include "manoscope/io/reader.hpp"
#include "manoscope/io/test_files.hpp"
#include "manoscope/io/test_zip.hpp"
#include "manoscope/io/x3p_test_files.hpp"
#include "manoscope/io/zip_archive.hpp"

namespace manoscope::io {
namespace {

using testing::complaint;
using testing::contains;
using testing::little;
using testing::stored_zip;
using testing::TestFolder;
using testing::x3p_main;
using testing::X3pParts;

Channel read_x3p(const TestFolder& folder, const std::string& bytes) {
  return read_channels(folder.write("a.x3p", bytes)).front();
}

TEST(Md5, AgreesWithTheVectorsOfRfc1321) {
  EXPECT_EQ(md5(""), "d41d8cd98f00b204e9800998ecf8427e");
  EXPECT_EQ(md5("message digest"), "f96b697d7cb7938d525a2f31aaf161d0");
}

TEST(X3p, ReadsEveryTypeOfNumber) {
  const TestFolder folder;
  std::string int16, int32, float32, float64;
  for (const int value : {-300, 2, 3, 4, 5, 600}) {
    int16 += little(static_cast<std::uint16_t>(value), 2);
    int32 += little(static_cast<std::uint32_t>(value * 1000), 4);
    float32 += little(static_cast<float>(value) * 1e-6F);
    float64 += little(value * 1e-6);
  }
  struct Case {
    char type, kind;
    const char* increment;
    std::string data;
  };
  for (const Case& test : {Case{'I', 'I', "1e-6", int16}, Case{'L', 'I', "1e-9", int32},
                           Case{'F', 'A', "1", float32}, Case{'D', 'A', "1", float64}}) {
    X3pParts parts;
    parts.z_kind = test.kind;
    parts.z_type = test.type;
    parts.z_increment = test.increment;
    const Channel channel = read_x3p(
        folder, stored_zip({{"main.xml", x3p_main(parts)}, {"bindata/data.bin", test.data}}));
    ASSERT_EQ(channel.grid.nx, 3) << test.type;
    ASSERT_EQ(channel.grid.ny, 2);
    EXPECT_EQ(channel.unit, "m");
    EXPECT_DOUBLE_EQ(channel.grid.pitch_x.si(), 1.5e-6);
    EXPECT_DOUBLE_EQ(channel.grid.pitch_y.si(), 2e-6);
    // 32-bit floats hold 24 bits.
    EXPECT_NEAR(channel.values(0, 0), -300e-6, 300e-6 * 6e-8) << test.type;
    EXPECT_NEAR(channel.values(0, 2), 3e-6, 3e-6 * 6e-8);
    EXPECT_NEAR(channel.values(1, 2), 600e-6, 600e-6 * 6e-8);
    EXPECT_TRUE(channel.warnings.empty());
  }
}

TEST(X3p, OffsetAndIncrementOfTheHeightsApply) {
  const TestFolder folder;
  X3pParts parts;
  parts.z_kind = 'I';
  parts.z_type = 'I';
  parts.z_increment = "2e-9";
  parts.z_offset = "5e-6";
  std::string data;
  for (int i = 0; i < 6; ++i) data += little(static_cast<std::uint16_t>(i), 2);
  const Channel channel =
      read_x3p(folder, stored_zip({{"main.xml", x3p_main(parts)}, {"bindata/data.bin", data}}));
  for (Index i = 0; i < 6; ++i) {
    EXPECT_NEAR(channel.values.data()[i], 5e-6 + 2e-9 * static_cast<double>(i), 1e-20);
  }
}

TEST(X3p, MaskedInfiniteAndNanPointsAreMissing) {
  const TestFolder folder;
  constexpr double kInf = std::numeric_limits<double>::infinity();
  std::string data;
  for (const double value : {1.0, kInf, 3.0, -kInf, std::nan(""), 6.0}) {
    data += little(value);
  }
  // A signalling NaN, as mutated files have it.
  data.replace(32, 8, little(0x7ff4000000000000ULL, 8));
  X3pParts parts;
  parts.link += "<ValidPointsLink>bindata/valid.bin</ValidPointsLink>";
  const std::string valid(1, '\x1f');  // points 0 to 4: the bits count from the least
  const Channel channel = read_x3p(folder, stored_zip({{"main.xml", x3p_main(parts)},
                                                       {"bindata/data.bin", data},
                                                       {"bindata/valid.bin", valid}}));
  EXPECT_EQ(channel.values(0, 0), 1.0);
  EXPECT_EQ(channel.values(0, 2), 3.0);
  for (const Index i : {1, 3, 4, 5}) EXPECT_TRUE(std::isnan(channel.values.data()[i])) << i;
}

TEST(X3p, AnArchiveWithATopFolderIsRead) {
  const TestFolder folder;
  const std::string data(48, '\0');
  const Channel channel = read_x3p(folder, stored_zip({{"My scan/", ""},
                                                       {"My scan/bindata/data.bin", data},
                                                       {"My scan/main.xml", x3p_main({})}}));
  EXPECT_TRUE((channel.values == 0.0).all());
  EXPECT_EQ(
      read_x3p(folder, stored_zip({{".\\main.xml", x3p_main({})}, {"bindata\\data.bin", data}}))
          .grid.nx,
      3);
}

TEST(X3p, LayersAreChannels) {
  const TestFolder folder;
  X3pParts parts;
  parts.n_layers = 2;
  std::string data;
  for (int i = 0; i < 12; ++i) data += little(double(i));
  const auto channels = read_channels(folder.write(
      "a.x3p", stored_zip({{"main.xml", x3p_main(parts)}, {"bindata/data.bin", data}})));
  ASSERT_EQ(channels.size(), 2U);
  EXPECT_EQ(channels[1].name, "layer 2");
  EXPECT_EQ(channels[0].values(1, 2), 5.0);
  EXPECT_EQ(channels[1].values(0, 0), 6.0);
}

TEST(X3p, AProfileIsARowOfOne) {
  const TestFolder folder;
  X3pParts parts;
  parts.feature = "PRF";
  parts.ny = 1;
  std::string data;
  for (int i = 0; i < 3; ++i) data += little(double(i));
  const auto path = folder.write(
      "a.x3p", stored_zip({{"main.xml", x3p_main(parts)}, {"bindata/data.bin", data}}));
  EXPECT_EQ(read_channels(path).front().grid.ny, 1);
  EXPECT_TRUE(contains(complaint([&] { read_height_map(path); }), "a profile, not a map"));
  // The same as a list of x;z in the XML.
  parts.points =
      "<ListDimension>3</ListDimension><DataList><Datum>1e-6;5e-6</Datum>"
      "<Datum>2e-6;6e-6</Datum><Datum>3e-6;7e-6</Datum></DataList>";
  parts.xy_kind = 'A';
  const Channel listed = read_x3p(folder, stored_zip({{"main.xml", x3p_main(parts)}}));
  EXPECT_NEAR(listed.grid.pitch_x.si(), 1e-6, 1e-18);
  EXPECT_NEAR(listed.values(0, 2), 7e-6, 1e-18);
}

TEST(X3p, PointsWithPositionsOfTheirOwnAreReadFromBothStores) {
  const TestFolder folder;
  X3pParts parts;
  parts.xy_kind = 'A';
  std::string data, list;
  for (int iy = 0; iy < 2; ++iy) {
    for (int ix = 0; ix < 3; ++ix) {
      data += little(1e-6 * ix) + little(2e-6 * iy) + little(double(iy * 3 + ix));
      list += "<Datum>" + std::to_string(ix) + "e-6;" + std::to_string(2 * iy) + "e-6;" +
              std::to_string(iy * 3 + ix) + "</Datum>";
    }
  }
  const auto check = [&](const std::string& bytes) {
    const Channel channel = read_x3p(folder, bytes);
    EXPECT_NEAR(channel.grid.pitch_x.si(), 1e-6, 1e-18);
    EXPECT_NEAR(channel.grid.pitch_y.si(), 2e-6, 1e-18);
    for (Index i = 0; i < 6; ++i) EXPECT_EQ(channel.values.data()[i], static_cast<double>(i));
  };
  check(stored_zip({{"main.xml", x3p_main(parts)}, {"bindata/data.bin", data}}));  // matrix
  parts.points = "<ListDimension>6</ListDimension><DataList>" + list + "</DataList>";
  check(stored_zip({{"main.xml", x3p_main(parts)}}));
  parts.points =
      "<ListDimension>6</ListDimension><DataLink><PointDataLink>bindata/data.bin"
      "</PointDataLink></DataLink>";
  check(stored_zip({{"main.xml", x3p_main(parts)}, {"bindata/data.bin", data}}));
}

TEST(X3p, AWrongChecksumIsToldAndTheMapIsRead) {
  const TestFolder folder;
  X3pParts parts;
  const std::string data(48, '\0');
  parts.link += "<MD5ChecksumPointData>" + md5(data) + "</MD5ChecksumPointData>";
  const auto files = [&](const std::string& bin, const std::string& sum) {
    return stored_zip(
        {{"main.xml", x3p_main(parts)}, {"bindata/data.bin", bin}, {"md5checksum.hex", sum}});
  };
  const std::string right = md5(x3p_main(parts)) + " *main.xml\n";
  EXPECT_TRUE(read_x3p(folder, files(data, right)).warnings.empty());
  const Channel changed = read_x3p(folder, files(std::string(47, '\0') + '\1', right));
  ASSERT_EQ(changed.warnings.size(), 1U);
  EXPECT_TRUE(contains(changed.warnings.front(), "bindata/data.bin"));
  const Channel other = read_x3p(folder, files(data, md5("something else")));
  ASSERT_EQ(other.warnings.size(), 1U);
  EXPECT_TRUE(contains(other.warnings.front(), "main.xml"));
}

TEST(X3p, SettingsOfTheInstrumentAreKept) {
  const TestFolder folder;
  const Channel channel = read_x3p(
      folder,
      stored_zip({{"main.xml", x3p_main({})}, {"bindata/data.bin", std::string(48, '\0')}}));
  bool found = false;
  for (const auto& [name, value] : channel.settings)
    found = found || (name == "model" && value == "M 1");
  EXPECT_TRUE(found);
}

TEST(X3p, WhatDoesNotFitIsRefused) {
  const TestFolder folder;
  const std::string data(48, '\0');
  const auto fault = [&](const std::string& bytes) {
    return complaint([&] { read_x3p(folder, bytes); });
  };
  const auto with = [&](const X3pParts& parts, const std::string& bin) {
    return fault(stored_zip({{"main.xml", x3p_main(parts)}, {"bindata/data.bin", bin}}));
  };
  EXPECT_TRUE(contains(with({}, data.substr(1)), "has 47 bytes where its points need 48"));
  EXPECT_TRUE(contains(with({}, data + "x"), "has 49 bytes"));
  EXPECT_TRUE(contains(fault(stored_zip({{"main.xml", x3p_main({})}})), "not in the archive"));
  EXPECT_TRUE(contains(fault(stored_zip({{"other.xml", ""}})), "holds no main.xml"));
  EXPECT_TRUE(contains(fault("PK\x03\x04 and no more"), "is not a whole zip archive"));
  X3pParts parts;
  parts.ny = 2000000000;
  EXPECT_TRUE(contains(with(parts, data), "not a number of points"));
  parts = {};
  parts.z_type = 'Q';
  EXPECT_TRUE(contains(with(parts, data), "numbers of type \"Q\""));
  parts = {};
  parts.points = "<MatrixDimension><SizeX>3</SizeX><SizeY>2</SizeY></MatrixDimension>";
  EXPECT_TRUE(contains(with(parts, data), "neither a DataLink nor a DataList"));
  parts.points += "<DataList><Datum>1</Datum></DataList>";
  EXPECT_TRUE(contains(with(parts, data), "has 1 points where 6 are announced"));
  parts = {};
  parts.xy_increment = "1e9";
  EXPECT_TRUE(contains(with(parts, data), "a pixel of 1e+09 m"));
}

TEST(ZipArchive, SizesAreCheckedBeforeAnythingIsUnpacked) {
  const TestFolder folder;
  const std::string xml = "<a/>";
  const auto fault = [&](const std::string& bytes, std::uint64_t largest) {
    return complaint([&] {
      const ZipArchive archive(folder.write("a.zip", bytes));
      static_cast<void>(archive.read(archive.find("f").value(), largest));
    });
  };
  // 4 GB from 4 bytes.
  EXPECT_TRUE(contains(fault(stored_zip({{"f", xml}}, 0xfffffff0U, 8), ~std::uint64_t{0}),
                       "which cannot be"));
  EXPECT_TRUE(contains(fault(stored_zip({{"f", xml}}, 0xfffffff0U), ~std::uint64_t{0}), "a.zip"));
  EXPECT_TRUE(contains(fault(stored_zip({{"f", xml}}), 3), "at most 3 make sense"));
  EXPECT_TRUE(contains(fault(stored_zip({{"f", xml}}, 0, 12), 100), "packed by method 12"));
  EXPECT_TRUE(contains(fault(stored_zip({{"f", xml}}, 0, 0, 1), 100), "is encrypted"));
  std::string damaged = stored_zip({{"f", "some text"}});
  damaged[damaged.find("some text")] = 'S';
  EXPECT_TRUE(contains(fault(damaged, 100), "cannot be unpacked"));  // the CRC is another
  EXPECT_EQ(fault(stored_zip({{"f", xml}}), 4), "");
  std::string crowded = stored_zip({{"f", xml}});  // room for 65534 files is made by libzip
  crowded.replace(crowded.find("PK\x05\x06") + 10, 2, "\xfe\xff");
  EXPECT_TRUE(contains(fault(crowded, 100), "announces 65534 files"));
}

}  // namespace
}  // namespace manoscope::io

// Real instrument files against what independent readers make of them: every row of expected.csv in
// the folder of shared maps. Skipped where the folder is absent.
#include <fmt/format.h>
#include <gtest/gtest.h>

#include <charconv>
#include <cmath>
#include <filesystem>
#include <fstream>
#include <map>
#include <set>
#include <string>
#include <vector>

#include "manoscope/core/error.hpp"
#include "manoscope/io/map_summary.hpp"
#include "tests/support/paths.hpp"

namespace manoscope::io {
namespace {

/// Files that hold no map and must be refused with a clear error.
const std::set<std::string> kRefused{"hx_test.plux"};

/// Cells of expected.csv that the file's own bytes contradict, and what they say. The table "Where
/// we differ from other programs" of docs/formats.md has the same reasons for the user.
struct Settled {
  std::string file, column;
  double value;
};
const std::vector<Settled> kSettled{
    // The cells count the zeros of a row that the scan never reached as heights, though the file
    // says that its first valid number is 5; its rms divides by the missing pixels, too. The
    // reader's own test does likewise and meets the cells.
    {"st_frt-1.frt", "missing", 76956},
    {"st_frt-1.frt", "min", 27 * 9.765922e-9},
    {"st_frt-1.frt", "mean_m", 7.89583082403e-05},
    {"st_frt-1.frt", "rms_m", 2.50453906278e-06},
    // Two places of the grid have no point; the cell does not count the holes.
    {"st_xyz-2.txt", "missing", 2},
    // Its cell holds the mark of the missing points, Zmin - 2; the lowest point is Zmin = 89120
    // steps of 1e-7 mm.
    {"st_sur-2.sur", "min", 89120 * static_cast<double>(1e-7F) * 1e-3},
    // The cells count rows first: the dataset has 160 rows of 200 values, and these are the first
    // 200 pixels of the first 160 rows of pr_valid_zygo_dat_file.dat, pixel by pixel.
    {"synth_from_prysm_crop.datx", "nx", 200},
    {"synth_from_prysm_crop.datx", "ny", 160},
};

std::filesystem::path maps_folder() {
  return std::filesystem::path(test_paths::shared) / "data" / "maps";
}

using Row = std::map<std::string, std::string>;

/// The fields of a line of CSV; a field in quotes may hold commas.
std::vector<std::string> fields_of(const std::string& line) {
  std::vector<std::string> fields(1);
  bool quoted = false;
  for (const char letter : line) {
    if (letter == '"') {
      quoted = !quoted;
    } else if (letter == ',' && !quoted) {
      fields.emplace_back();
    } else if (letter != '\r') {
      fields.back() += letter;
    }
  }
  return fields;
}

std::vector<Row> expected_rows() {
  std::ifstream file(maps_folder() / "expected.csv");
  std::string line;
  std::getline(file, line);
  const std::vector<std::string> names = fields_of(line);
  std::vector<Row> rows;
  while (std::getline(file, line)) {
    const std::vector<std::string> fields = fields_of(line);
    Row row;
    for (std::size_t i = 0; i < names.size() && i < fields.size(); ++i) row[names[i]] = fields[i];
    rows.push_back(row);
  }
  return rows;
}

/// The number of a field, absent if the field is empty; where it is settled, the settled one.
std::optional<double> number(const Row& row, const std::string& name) {
  for (const Settled& settled : kSettled) {
    if (settled.file == row.at("file") && settled.column == name) return settled.value;
  }
  const std::string& text = row.at(name);
  double value = 0.0;
  const auto result = std::from_chars(text.data(), text.data() + text.size(), value);
  if (text.empty() || result.ec != std::errc()) return std::nullopt;
  return value;
}

/// Files that hold one channel and nothing doubtful, with every number of their rows in the unit
/// that the row names; where it names none, sizes are the file's own numbers.
const std::set<std::string> kPlain{"gf_test.gwy",    "hx_pyramid.x3p",
                                   "hx_testing.x3p", "of_ISO5436-sample1.x3p",
                                   "st_sdf-1.sdf",   "of_ISO5436-sample1_bin.x3p",
                                   "st_x3p-2.x3p",   "st_xyz-1.txt",
                                   "st_xyz-2.txt"};

/// The heights of a file; its first channel if none is in m.
const ChannelSummary& main_channel(const MapSummary& summary) {
  for (const ChannelSummary& channel : summary.channels) {
    if (channel.unit == "m") return channel;
  }
  return summary.channels.front();
}

/// Compares where expected.csv has a number. Its values carry 9 digits, hence 1e-6 is well above
/// their rounding; against the range of the map, so that a mean near 0 is held to the same height.
void expect_close(const Row& row, const std::string& name, std::optional<double> found,
                  double range) {
  const auto expected = number(row, name);
  if (!expected) return;
  ASSERT_TRUE(found.has_value()) << name;
  EXPECT_NEAR(*found, *expected, 1e-6 * std::max(std::abs(*expected), range)) << name;
}

void expect_size(const Row& row, const std::string& name, std::optional<double> found) {
  const auto expected = number(row, name);
  if (!expected) return;
  // Sizes without a unit: the reader's own test has them, or the file is plain.
  if (row.at("unit") != "m" && !kPlain.contains(row.at("file"))) return;
  ASSERT_TRUE(found.has_value()) << name;
  // Some rows give 8 digits: half a unit of the last one.
  EXPECT_NEAR(*found, *expected, 5e-9 * *expected) << name;
}

class RealFiles : public ::testing::Test {
 protected:
  void SetUp() override {
    if (!std::filesystem::exists(maps_folder() / "expected.csv")) {
      GTEST_SKIP() << "no folder of real instrument files here";
    }
  }
};

TEST_F(RealFiles, ReadAsIndependentReadersReadThem) {
  const std::vector<Row> rows = expected_rows();
  ASSERT_GT(rows.size(), 30U);
  for (const Row& row : rows) {
    const std::string file = row.at("file");
    SCOPED_TRACE(file);
    if (kRefused.contains(file)) {
      EXPECT_THROW(static_cast<void>(summarise_map(maps_folder() / file)), InputError);
      continue;
    }
    const bool plain = kPlain.contains(file);
    ReadOptions options;
    if (plain && row.at("unit").empty()) options.lateral_unit = "m";
    MapSummary summary;
    try {
      summary = summarise_map(maps_folder() / file, options);
    } catch (const InputError& error) {
      ADD_FAILURE() << error.what();
      continue;
    }
    ASSERT_FALSE(summary.channels.empty());
    const ChannelSummary& channel = main_channel(summary);
    if (row.at("unit") == "m" || plain) {
      EXPECT_EQ(channel.unit, row.at("unit"));
    }
    if (plain) {
      EXPECT_EQ(summary.channels.size(), 1U);
      EXPECT_TRUE(channel.warnings.empty());
    }
    if (const auto nx = number(row, "nx")) {
      EXPECT_EQ(static_cast<double>(channel.nx), *nx);
    }
    if (const auto ny = number(row, "ny")) {
      EXPECT_EQ(static_cast<double>(channel.ny), *ny);
    }
    expect_size(row, "size_x_m", channel.size_x_m);
    expect_size(row, "size_y_m", channel.size_y_m);
    if (const auto missing = number(row, "missing")) {
      EXPECT_EQ(static_cast<double>(channel.missing), *missing);
    }
    const double range = channel.max.value_or(0.0) - channel.min.value_or(0.0);
    expect_close(row, "min", channel.min, range);
    expect_close(row, "max", channel.max, range);
    expect_close(row, "mean_m", channel.mean, range);
    expect_close(row, "rms_m", channel.rms, 0.0);
  }
}

TEST_F(RealFiles, SamplesOfTheX3pStandardWithPositionsOfTheirOwn) {
  // A list of points, x and y in um: the same heights as sample 1 plus an offset of 2 m.
  const Channel list = read_channels(maps_folder() / "of_ISO5436-sample2.x3p").front();
  EXPECT_EQ(list.grid.nx, 4);
  EXPECT_EQ(list.grid.ny, 4);
  EXPECT_NEAR(list.grid.pitch_x.in(um), 1.0, 1e-9);
  EXPECT_NEAR(list.values(0, 2), 2.0 - 0.80836857168283, 1e-14);
  EXPECT_NEAR(list.values(3, 0), 2.0 + 0.675397146760858, 1e-14);
  // A matrix whose rows name their y.
  const Channel matrix = read_channels(maps_folder() / "of_ISO5436-sample3.x3p").front();
  EXPECT_NEAR(matrix.grid.pitch_x.si(), 1.6016e-2, 1e-15);
  EXPECT_NEAR(matrix.grid.pitch_y.si(), 1.0, 1e-12);
  EXPECT_TRUE(std::isnan(matrix.values(1, 3)));
  EXPECT_NEAR(matrix.values(3, 3), 2.0 - 0.215696638464903, 1e-14);
}

/// What is known of one channel of a file, worked out from its bytes by another program.
struct Decoded {
  const char* channel;
  const char* unit;  ///< as the channel has it
  Index nx, ny;
  double first, middle, last;  ///< stored points: (0, 0), (ny / 2, nx / 2), (ny - 1, nx - 1)
  double least, most, sum;     ///< of all stored points
  double step, offset;         ///< value = step * point + offset
};

void expect_decoded(const Channel& channel, const Decoded& known) {
  SCOPED_TRACE(known.channel);
  EXPECT_EQ(channel.name, known.channel);
  EXPECT_EQ(channel.unit, known.unit);
  ASSERT_EQ(channel.grid.nx, known.nx);
  ASSERT_EQ(channel.grid.ny, known.ny);
  const auto value = [&](double point) { return known.step * point + known.offset; };
  // Round-off of a product and a sum, each of the largest value at most.
  const double tolerance = 4e-16 * std::max({std::abs(value(known.least)),
                                             std::abs(value(known.most)), std::abs(known.offset)});
  const Array2& values = channel.values;
  EXPECT_NEAR(values(0, 0), value(known.first), tolerance);
  EXPECT_NEAR(values(known.ny / 2, known.nx / 2), value(known.middle), tolerance);
  EXPECT_NEAR(values(known.ny - 1, known.nx - 1), value(known.last), tolerance);
  EXPECT_NEAR(values.minCoeff(), value(known.least), tolerance);
  EXPECT_NEAR(values.maxCoeff(), value(known.most), tolerance);
  const auto n = static_cast<double>(values.size());
  EXPECT_NEAR(values.mean(), value(known.sum / n), n * tolerance);
}

TEST_F(RealFiles, PackedDigitalSurfFilesHoldWhatZlibUnpacksThemTo) {
  // The numbers were got with Python's struct and zlib alone: header fields at the offsets of the
  // format's description (points of 16 or 32 bits at byte 98, spacing at 120, offset at 466,
  // lengths of comment and private zone at 334), then a count of streams, their lengths, and the
  // streams through zlib.decompress().
  constexpr double kStep = 0.0025500000920146704;  // of the colours, a 32-bit float
  struct File {
    const char* name;
    double pitch_mm;
    std::vector<Decoded> channels;
  };
  const std::vector<File> files{
      {"rs_test_RGB.sur",
       0.35277777910232544,
       {{"red", "1", 200, 200, 27451, 56078, 27451, 392, 85882, 1314447371, kStep, 0},
        {"green", "1", 200, 200, 33333, 45098, 33725, 2353, 71373, 1395805256, kStep, 0},
        {"blue", "1", 200, 200, 35294, 29412, 33725, 4314, 50196, 1324529533, kStep, 0}}},
      {"rs_test_RGBSURFACE.sur",
       0.01345131080597639,
       {{"Z", "m", 10, 10, 1457, -99, -1571, -1664, 1568, -26, 7.858001481508836e-08,
         -0.9390347003936768e-3},
        {"red", "1", 10, 10, 48943, 37138, 70147, 18001, 88912, 3874134, kStep, 0},
        {"green", "1", 10, 10, 49850, 37366, 72963, 19718, 89295, 3962821, kStep, 0},
        {"blue", "1", 10, 10, 43668, 37468, 62386, 15775, 83235, 3482777, kStep, 0}}},
      {"rs_test_profile.pro",
       8.252197585534304e-05,
       {{"CL Intensity", "a.u.", 128, 1, 4671094, 1740235, 13599610, -8094531, 13599610, 52,
         9.999999747378752e-06, 229.931640625}}},
      {"rs_test_spectra.pro",
       1.084000246009964e-06,
       {{"CL Intensity", "a.u.", 512, 65, -22, 42, 243, -171, 5413, 7631810, 1.0, 0}}}};
  for (const File& file : files) {
    SCOPED_TRACE(file.name);
    const auto channels = read_channels(maps_folder() / file.name);
    ASSERT_EQ(channels.size(), file.channels.size());
    for (std::size_t i = 0; i < channels.size(); ++i) {
      expect_decoded(channels[i], file.channels[i]);
      // Round-off of one product.
      EXPECT_NEAR(channels[i].grid.pitch_x.in(mm), file.pitch_mm, 2e-16 * file.pitch_mm);
    }
  }
}

TEST_F(RealFiles, ATrueMapFileHasTheStatisticsOfItsFloats) {
  // By Python's struct and math.fsum over the floats of the file, in its unit, mm.
  const auto channels = read_channels(maps_folder() / "st_tmd-1.tmd");
  ASSERT_EQ(channels.size(), 1U);
  const Array2& values = channels[0].values;
  ASSERT_EQ(values.rows(), 300);
  ASSERT_EQ(values.cols(), 300);
  EXPECT_NEAR(channels[0].grid.pitch_y.in(mm), 18.956600189208984 / 300, 1e-14);
  // Each is a 32-bit float times 1e-3: round-off of a product.
  EXPECT_NEAR(values(0, 0), 0.22351792454719543e-3, 1e-19);
  EXPECT_NEAR(values(1, 0), 0.22296857833862305e-3, 1e-19);
  EXPECT_NEAR(values(150, 150), 0.1526634693145752e-3, 1e-19);
  EXPECT_NEAR(values(299, 299), 0.23054088652133942e-3, 1e-19);
  const ChannelSummary summary = summarise(channels[0]);
  EXPECT_EQ(summary.missing, 0);
  // Sums of 90 000 heights, against sums without round-off.
  EXPECT_NEAR(summary.min.value(), 0.0, 1e-19);
  EXPECT_NEAR(summary.max.value(), 0.3509870171546936e-3, 1e-18);
  EXPECT_NEAR(summary.mean.value(), 0.17287914127574167e-3, 1e-15);
  EXPECT_NEAR(summary.rms.value(), 0.07434134067352181e-3, 1e-15);
}

/// The names in the table of readers of docs/formats.md, with the rest of their rows.
std::vector<std::pair<std::string, std::string>> documented_readers() {
  std::ifstream page(std::filesystem::path(test_paths::source) / "docs" / "formats.md");
  std::vector<std::pair<std::string, std::string>> rows;
  bool in_table = false;
  for (std::string line; std::getline(page, line);) {
    if (line.starts_with("| name |")) in_table = true;
    if (line.empty()) in_table = false;
    if (!in_table || line.starts_with("| name |") || line.starts_with("|---")) continue;
    const auto end = line.find(" |");
    rows.emplace_back(line.substr(2, end - 2), line.substr(end));
  }
  return rows;
}

TEST(FormatsPage, ListsTheReadersThatThereAreWithTheirExtensions) {
  std::map<std::string, std::string> documented;
  std::vector<std::string> order;
  for (const auto& [name, row] : documented_readers()) {
    if (!documented.contains(name)) order.push_back(name);
    documented[name] += row;  // `text` has a row for matrices and one for points
  }
  std::vector<std::string> there;
  for (const Reader* reader : readers()) {
    const std::string name(reader->name());
    there.push_back(name);
    // Any other text and any TIFF go by too many names to list.
    if (name == "text" || name == "tiff") continue;
    for (const std::string& extension : reader->extensions()) {
      EXPECT_NE(documented[name].find(extension), std::string::npos) << name << ' ' << extension;
    }
  }
  EXPECT_EQ(order, there);
}

}  // namespace
}  // namespace manoscope::io

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

/// Cells of expected.csv that the file's own bytes contradict, and what they say.
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
    // 200
    // pixels of the first 160 rows of pr_valid_zygo_dat_file.dat, pixel by pixel.
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

}  // namespace
}  // namespace manoscope::io

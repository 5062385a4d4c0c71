#include <gtest/gtest.h>

#include <chrono>
#include <cmath>
#include <limits>

#include "manoscope/core/flags.hpp"
#include "manoscope/core/random.hpp"
#include "manoscope/io/formats.hpp"
#include "manoscope/io/test_files.hpp"
#include "manoscope/io/text_matrix.hpp"
#include "manoscope/io/writer.hpp"

namespace manoscope::io {
namespace {

using testing::complaint;
using testing::contains;
using testing::refusal;
using testing::TestFolder;

Array2 matrix_of(const std::string& text) { return parse_text_matrix(text, "m.txt").values; }

Array2 two_by_three(double a, double b, double c, double d, double e, double f) {
  Array2 values(2, 3);
  values << a, b, c, d, e, f;
  return values;
}

bool same(const Array2& a, const Array2& b) {
  if (a.rows() != b.rows() || a.cols() != b.cols()) return false;
  for (Index i = 0; i < a.size(); ++i) {
    const double x = a.data()[i], y = b.data()[i];
    if (std::isnan(x) != std::isnan(y) || (!std::isnan(x) && x != y)) return false;
  }
  return true;
}

TEST(TextMatrix, FindsTheDelimiterAndTheDecimalMark) {
  const Array2 truth = two_by_three(1.5, -2, 3e-3, 0.25, 5, 6);
  for (const char* text :
       {"1.5 -2 3e-3\n0.25 5 6\n", "  1.5   -2  3e-3 \n\t0.25 5\t6", "1.5,-2,3e-3\n.25,5,6\n",
        "1.5, -2, 3e-3\r\n0.25, 5, 6\r\n", "1.5 , -2 , 3E-3\n0.25 , 5 , 6\n",
        "1.5;-2;3e-3\n0.25;+5;6\n", "1,5;-2;3e-3\n0,25;5,0;6\n", "1,5 -2 3e-3\n0,25 5,00 6\n",
        "1,5\t-2\t3,0e-3\n0,25\t5\t6\n", "1.5\t-2\t3e-3\n0.25\t5\t6\n",
        "\xEF\xBB\xBF"
        "1.5 -2 3e-3\n0.25 5 6\n",
        "1.5 -2 3e-3\r0.25 5 6\r", "1.5;-2;3e-3;\n0.25;5;6;\n", "\n\n1.5,-2,3e-3,\n\n0.25,5,6,\n\n",
        "+1.5 -2.0 +0.003\n2.5e-1 5e0 6\n"}) {
    EXPECT_TRUE(same(matrix_of(text), truth)) << text;
  }
}

TEST(TextMatrix, MissingSamplesAreNan) {
  constexpr double kNan = std::numeric_limits<double>::quiet_NaN();
  const Array2 truth = two_by_three(kNan, 2, kNan, 4, kNan, 6);
  for (const char* text :
       {"nan 2 NaN\n4 Bad 6\n", ",2,\n4,,6\n", "BAD;2;bad\n4;;6\n", "--- 2 --\n4 inf 6\n",
        "\t2\t\n4\tn/a\t6\n", "1.#QNAN 2 -1.#IND\n4 -Inf 6\n", "NULL,2,NA\n4,nan(123),6\n"}) {
    EXPECT_TRUE(same(matrix_of(text), truth)) << text;
  }
}

TEST(TextMatrix, CommentsArePassedOver) {
  const Array2 truth = two_by_three(1, 2, 3, 4, 5, 6);
  EXPECT_TRUE(same(matrix_of("# a comment\n1 2 3\n% another: 3\n// and one\n4 5 6\n# end"), truth));
}

TEST(TextMatrix, FaultsNameTheirLine) {
  const auto fault = [](const std::string& text) { return complaint([&] { matrix_of(text); }); };
  EXPECT_TRUE(
      contains(fault("# h\n1 2 3\n4 5\n"), "m.txt:3 | has 2 values, the first row (line 2) has 3"));
  EXPECT_TRUE(contains(fault("1 2 3\n\n4 5 6 7\n"), "m.txt:3 | has 4 values"));
  EXPECT_TRUE(contains(fault("1 2 3\n4 x 6\n"), "m.txt:2 | \"x\" in column 2 is not a number"));
  EXPECT_TRUE(contains(fault("1 2 3\n4 1e999 6\n"), "\"1e999\""));
  EXPECT_TRUE(contains(fault("1;2;3\n4;1.234,5;6\n"), "\"1.234,5\""));
  EXPECT_TRUE(contains(fault("my columns\n1 2 3\n"), "m.txt:1 | \"my columns\" is neither"));
  EXPECT_TRUE(contains(fault("# only comments\n"), "holds no numbers"));
  EXPECT_TRUE(contains(fault(std::string("1 2\n\0 3\n", 8)), "NUL"));
  EXPECT_TRUE(contains(fault("\xFF\xFE"
                             "1"),
                       "UTF-16"));
}

TEST(TextMatrix, EmptyCellsCannotBlowUpTheMap) {
  // 100 kB of delimiters and 100,000 short lines: 1e10 cells if taken at their word.
  const std::string text = "1" + std::string(100000, ',') + "\n" + [] {
    std::string lines;
    for (int i = 0; i < 100000; ++i) lines += "1\n";
    return lines;
  }();
  EXPECT_TRUE(contains(complaint([&] { matrix_of(text); }), "too many for"));
}

TEST(TextHeader, UnderstandsScalesAndUnitsInManySpellings) {
  const auto header = [](const std::string& line) {
    TextHeader found;
    EXPECT_TRUE(read_header_line(line, found, "m.txt:1")) << line;
    return found;
  };
  EXPECT_DOUBLE_EQ(header("# Width: 16.3 mm").size_x->si(), 16.3e-3);
  EXPECT_DOUBLE_EQ(header("# Breite: 16,3 mm").size_x->si(), 16.3e-3);
  EXPECT_DOUBLE_EQ(header("# Height: 2.5 \xC2\xB5m").size_y->si(), 2.5e-6);
  EXPECT_DOUBLE_EQ(header("# H\xC3\xB6he: 2.5\xC2\xB5m").size_y->si(), 2.5e-6);
  EXPECT_DOUBLE_EQ(header("% pitch x = 1.5 um").pitch_x->si(), 1.5e-6);
  EXPECT_FALSE(header("% pitch x = 1.5 um").pitch_y);
  EXPECT_DOUBLE_EQ(header("pitch_y=2e-6 m").pitch_y->si(), 2e-6);
  EXPECT_DOUBLE_EQ(header("pixel size: 3 um").pitch_x->si(), 3e-6);
  EXPECT_DOUBLE_EQ(header("pixel size: 3 um").pitch_y->si(), 3e-6);
  EXPECT_EQ(header("# Value units: m").unit, "m");
  EXPECT_EQ(header("# unit: nm").unit, "nm");
  EXPECT_EQ(header("; Z-Unit = \xC2\xB5m").unit, "\xC2\xB5m");
  EXPECT_EQ(header("# Channel: My: channel").name, "My: channel");
  EXPECT_FALSE(header("# Width: 1024 px").size_x);  // counts pixels
  EXPECT_FALSE(header("# Width: 1024").size_x);
  EXPECT_EQ(header("# Operator: me").name, "");
  TextHeader none;
  EXPECT_FALSE(read_header_line("# no value here", none, "m.txt:1"));
}

TEST(TextHeader, FaultyScalesAreRefused) {
  const auto fault = [](std::vector<std::string> lines) {
    return complaint([&] {
      TextHeader header;
      for (const std::string& line : lines) read_header_line(line, header, "m.txt:7");
    });
  };
  EXPECT_TRUE(contains(fault({"# pitch x: 1.5"}), "m.txt:7 | pitch x is \"1.5\", without a unit"));
  EXPECT_TRUE(contains(fault({"# Width: 3 kPa"}), "not a length"));
  EXPECT_TRUE(contains(fault({"# Width: -3 mm"}), "not a length"));
  EXPECT_TRUE(contains(fault({"# Width: 0 mm"}), "not a length"));
  EXPECT_TRUE(contains(fault({"# Width: wide"}), "not a length"));
  EXPECT_TRUE(contains(fault({"# Width: 1e300 km"}), "not a length"));
  EXPECT_TRUE(contains(fault({"# Width: 3 mm", "# Width: 4 mm"}), "contradicts"));
  EXPECT_TRUE(contains(fault({"# unit: nm", "# unit: um"}), "contradicts"));
  EXPECT_EQ(fault({"# Width: 3 mm", "# Breite: 3 mm"}), "");
}

TEST(TextMap, ReadsAMatrixWithItsScale) {
  const TestFolder folder;
  const HeightMap map = read_height_map(folder.write(
      "a.txt",
      "# Channel: h\n# Width: 6 mm\n# pitch y: 1.5 um\n# Value units: nm\n1 2 3\n4 nan 6\n"));
  EXPECT_EQ(map.grid().nx, 3);
  EXPECT_DOUBLE_EQ(map.grid().pitch_x.si(), 2e-3);  // width over columns
  EXPECT_DOUBLE_EQ(map.grid().pitch_y.si(), 1.5e-6);
  EXPECT_NEAR(map.height()(1, 2), 6e-9, 1e-23);
  EXPECT_EQ(map.flags()(1, 1), PixelFlag::no_data);
}

TEST(TextMap, AMapWithAWideMissingBorderIsStillAMap) {
  // More missing samples at the beginning than the first look at a file takes in.
  std::string missing = "nan", row = "1";
  for (int i = 0; i < 1999; ++i) {
    missing += " nan";
    row += " 1";
  }
  const TestFolder folder;
  const HeightMap map = read_height_map(
      folder.write("a.txt", "# pixel size: 1 um\n# unit: nm\n" + missing + "\n" + row + "\n"));
  EXPECT_EQ(map.flags().cast<int>().sum(), 2000 * PixelFlag::no_data);
}

TEST(TextMap, WithoutScaleOrUnitSaysWhatToAdd) {
  const TestFolder folder;
  const auto path = folder.write("a.csv", "1,2,3,4\n5,6,7,8\n");
  ReadOptions options;
  EXPECT_TRUE(contains(complaint([&] { read_height_map(path, options); }), "--height-unit nm"));
  options.height_unit = "nm";
  EXPECT_TRUE(contains(complaint([&] { read_height_map(path, options); }),
                       "--pitch-x 1.5um --pitch-y 1.5um"));
  options.pitch_x = 2.0 * um;
  EXPECT_TRUE(contains(complaint([&] { read_height_map(path, options); }), "--pitch-y 1.5um"));
  options.pitch_y = 3.0 * um;
  const HeightMap map = read_height_map(path, options);
  EXPECT_EQ(map.grid().pitch_x, 2.0 * um);
  EXPECT_EQ(map.grid().pitch_y, 3.0 * um);
  EXPECT_NEAR(map.height()(1, 3), 8e-9, 1e-23);
}

TEST(TextMap, SizeAndPitchMustAgree) {
  const TestFolder folder;
  EXPECT_TRUE(contains(complaint([&] {
                         read_channels(folder.write(
                             "a.txt", "# Width: 6 mm\n# pitch x: 1 mm\n# unit: m\n1 2 3\n4 5 6\n"));
                       }),
                       "3 pixels of 1000 um along x do not make a map of 6000 um"));
}

TEST(TextMap, NarrowMatricesNeedAHeaderThatSaysSo) {
  const TestFolder folder;
  // Three columns that are no points on a grid.
  const auto path = folder.write("a.txt", "1 2 3\n1 2 3\n1 2 3\n1 2 3\n");
  EXPECT_TRUE(
      contains(complaint([&] { read_height_map(path); }), "two points lie at x = 1, y = 2"));
  EXPECT_TRUE(
      contains(refusal(folder, "b.txt", "1\n2\n3\n"), "has 1 columns and no lateral scale"));
  // Narrow maps exist: their header says so.
  EXPECT_NO_THROW(read_height_map(
      folder.write("b.txt", "# pixel size: 1 um\n# unit: nm\n1 2 3\n1 2 3\n1 2 3\n1 2 3\n")));
}

TEST(TextMap, WritesWhatItReadsBitForBit) {
  const TestFolder folder;
  RandomStream random(1, "text");
  Array2 height(20, 31);
  Flags2 flags = Flags2::Zero(20, 31);
  for (Index i = 0; i < height.size(); ++i) {
    height.data()[i] = 1e-6 * random.normal();
    if (random.uniform() < 0.1) flags.data()[i] = PixelFlag::no_data;
  }
  const HeightMap map(CameraGrid{31, 20, 1.6 * um, 13.1 * um}, height, flags);
  for (const char* name : {"a.csv", "a.txt"}) {
    write_text_map(folder / name, map, "t\nu");
    EXPECT_EQ(read_channels(folder / name).front().name, "t u");
    const HeightMap back = read_height_map(folder / name);
    EXPECT_EQ(back.grid(), map.grid());
    EXPECT_TRUE((back.flags() == map.flags()).all());
    for (Index i = 0; i < height.size(); ++i) {
      if (map.flags().data()[i] == 0) {
        EXPECT_EQ(back.height().data()[i], map.height().data()[i]);
      }
    }
  }
}

TEST(TextMap, CutOffInTheMiddleOfARowIsRefused) {
  const std::string text = "# pixel size: 1 um\n# unit: nm\n10 20 30\n40 50 60\n70 80 90";
  // Any cut that leaves a row with too few values; a cut inside the last value cannot be seen.
  for (std::size_t length = text.find("10") + 10; length < text.size() - 2; ++length) {
    if (length >= text.find("60") + 1 && length <= text.find("70")) continue;  // between the rows
    EXPECT_THROW(parse_text_matrix(text.substr(0, length), "m"), InputError)
        << text.substr(0, length);
  }
}

TEST(TextMap, ALargeMapIsReadWithinSeconds) {
  // 1024 x 768 numbers of 12 digits. The bound is loose: it catches a quadratic algorithm, which
  // would take minutes, on a machine however busy.
  Array2 height(768, 1024);
  RandomStream random(2, "text");
  for (Index i = 0; i < height.size(); ++i) height.data()[i] = random.normal();
  const TestFolder folder;
  const HeightMap map(CameraGrid{1024, 768, 1.0 * um, 1.0 * um}, height);
  write_text_map(folder / "a.csv", map, "");
  const auto start = std::chrono::steady_clock::now();
  const HeightMap back = read_height_map(folder / "a.csv");
  const std::chrono::duration<double> took = std::chrono::steady_clock::now() - start;
  EXPECT_LT(took.count(), 10.0);
  EXPECT_TRUE((back.height() == height).all());
}

TEST(TextMap, ReadsFilesOfOtherPrograms) {
  if (testing::shared_data("maps").empty()) GTEST_SKIP() << "no samples of other programs here";
  for (const char* name : {"st_gwyddion-export-english.txt", "st_gwyddion-export-german.txt"}) {
    const auto path = testing::shared_data(std::string("maps/") + name);
    const HeightMap map = read_height_map(path);
    EXPECT_EQ(read_channels(path).front().name, "My Channel Name");
    EXPECT_EQ(map.grid().nx, 3);
    EXPECT_EQ(map.grid().ny, 4);
    EXPECT_NEAR(map.grid().size_x().si(), 12.34e-6, 1e-20);
    EXPECT_NEAR(map.grid().size_y().si(), 5678.9e-9, 1e-20);
    EXPECT_TRUE((map.height().row(0) == Eigen::Array3d(1, 1.5, 3).transpose()).all());
    EXPECT_TRUE((map.height().row(1) == Eigen::Array3d(-2, -3, -6).transpose()).all());
    EXPECT_TRUE((map.height().row(3) == 9.0).all());
  }
  const auto plain = testing::shared_data("maps/st_matrix-5.txt");
  EXPECT_THROW(read_height_map(plain), InputError);
  ReadOptions options;
  options.height_unit = "m";
  options.pitch_x = options.pitch_y = 1.0 * um;
  const HeightMap map = read_height_map(plain, options);
  EXPECT_EQ(map.grid().nx, 10);
  EXPECT_TRUE((map.height().topRows(5) == 2.0).all());
  EXPECT_TRUE((map.height().bottomRows(map.grid().ny - 5) == 0.0).all());
  // Profiles and files of other kinds are refused even with a scale.
  for (const char* name : {"st_csv-1.csv", "st_csv-2.csv", "st_csv-3.csv", "st_dektak-1.csv",
                           "st_opdx-3.txt", "st_hfm-1.hfm"}) {
    EXPECT_THROW(read_height_map(testing::shared_data(std::string("maps/") + name), options),
                 InputError)
        << name;
  }
}

}  // namespace
}  // namespace manoscope::io

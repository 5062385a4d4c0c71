#include "manoscope/io/gwyddion_fallback.hpp"

#include <gtest/gtest.h>

#include <algorithm>
#include <cstdlib>

#include "manoscope/io/map_summary.hpp"
#include "manoscope/io/test_files.hpp"
#include "manoscope/io/test_gwy.hpp"

namespace manoscope::io {
namespace {

using testing::complaint;
using testing::contains;
using testing::TestFolder;

/// A folder that is the whole of PATH but for the shell's own tools, and holds a `gwyddion`.
class Gwyddion : public ::testing::Test {
 protected:
  Gwyddion() : path_(std::getenv("PATH")) {
    unknown_ = folder_.write("map.strange", std::string("\1\2\3 no format of ours", 22));
    using testing::gwy_component;
    converted_ = folder_.write(
        "converted.bin",
        testing::gwy_file(
            gwy_component("/0/data", 'o',
                          testing::gwy_field({1e-6, 2e-6, 3e-6, 4e-6, 5e-6, 6e-6}, "m")) +
            gwy_component("/0/data/title", 's', testing::gwy_text("Topography"))));
  }
  ~Gwyddion() override {
    ::setenv("PATH", path_.c_str(), 1);
    ::unsetenv("MANOSCOPE_GWYDDION");
    ::unsetenv("TMPDIR");
  }
  /// A program of that name that has its arguments in $1 and $2.
  void install(const std::string& script) {
    std::filesystem::create_directory(folder_ / "bin");
    const auto program = folder_.write("bin/gwyddion", "#!/bin/sh\n" + script + "\n");
    std::filesystem::permissions(program, std::filesystem::perms::owner_all);
    ::setenv("PATH", ((folder_ / "bin").string() + ":" + path_).c_str(), 1);
    std::filesystem::create_directory(folder_ / "tmp");
    ::setenv("TMPDIR", (folder_ / "tmp").c_str(), 1);
  }
  void install_converter() {
    install(
        "[ \"$1\" = --version ] && { echo 'Gwyddion 9.9 (2030-01-01)'; exit 0; }\n"
        "[ \"$2\" = '" +
        unknown_.string() +
        "' ] || exit 1\n"
        "cp '" +
        converted_.string() + "' \"${1#--convert-to-gwy=}\"");
  }
  bool nothing_left_behind() const { return std::filesystem::is_empty(folder_ / "tmp"); }

  TestFolder folder_;
  std::string path_;
  std::filesystem::path unknown_, converted_;
};

TEST_F(Gwyddion, ReadsWhatNoReaderKnowsAndSaysSo) {
  install_converter();
  const MapSummary summary = summarise_map(unknown_);
  EXPECT_EQ(summary.format, "gwyddion");
  ASSERT_EQ(summary.channels.size(), 1U);
  const ChannelSummary& channel = summary.channels.front();
  EXPECT_EQ(channel.name, "Topography");
  EXPECT_DOUBLE_EQ(channel.max.value(), 6e-6);
  EXPECT_EQ(channel.settings.back(),
            (std::pair<std::string, std::string>("read by", "Gwyddion 9.9 (2030-01-01)")));
  ASSERT_EQ(channel.warnings.size(), 1U);
  EXPECT_TRUE(contains(channel.warnings.front(), "read by Gwyddion 9.9"));
  EXPECT_NEAR(read_height_map(unknown_).height()(0, 1), 2e-6, 1e-20);
  EXPECT_TRUE(nothing_left_behind());
}

TEST_F(Gwyddion, IsNotAskedForFormatsThatAreKnown) {
  install("echo asked > '" + (folder_ / "asked").string() + "'; exit 1");
  EXPECT_NO_THROW(read_channels(folder_.write("a.csv", "1,2\n3,4\n")));
  EXPECT_THROW(find_reader(unknown_), InputError);  // its own readers alone
  EXPECT_FALSE(std::filesystem::exists(folder_ / "asked"));
}

TEST_F(Gwyddion, CanBeSwitchedOff) {
  install_converter();
  ReadOptions options;
  options.gwyddion = false;
  EXPECT_TRUE(contains(complaint([&] { read_channels(unknown_, options); }),
                       "is switched off (--gwyddion)"));
  ::setenv("MANOSCOPE_GWYDDION", "off", 1);
  EXPECT_TRUE(contains(complaint([&] { read_channels(unknown_); }),
                       "is switched off (MANOSCOPE_GWYDDION)"));
}

TEST_F(Gwyddion, ThatIsAbsentIsNamedWithTheWayToGetIt) {
  ::setenv("PATH", folder_.path().c_str(), 1);
  const std::string text = complaint([&] { read_channels(unknown_); });
  EXPECT_TRUE(contains(text, "map.strange | is of no known format"));
  EXPECT_TRUE(contains(text, "`apt install gwyddion`"));
}

TEST_F(Gwyddion, ThatFailsIsAnErrorOfTheFile) {
  for (const auto& [script, words] :
       {std::pair{"echo 'x: No module can load this file type.'; exit 1",
                  "Gwyddion cannot read it either: x: No module can load"},
        std::pair{"kill -SEGV $$", "it failed (signal 11)"},
        std::pair{"exit 0", "Gwyddion cannot read it either"},
        std::pair{"echo GWYP > \"${1#--convert-to-gwy=}\"", "as converted by Gwyddion: "}}) {
    install(script);
    const std::string text = complaint([&] { read_channels(unknown_); });
    EXPECT_TRUE(contains(text, unknown_.string() + " | ")) << script;
    EXPECT_TRUE(contains(text, words)) << script;
    EXPECT_TRUE(nothing_left_behind());
  }
}

TEST_F(Gwyddion, TheRealOneConvertsAndItsMapIsRead) {
  if (!find_gwyddion()) GTEST_SKIP() << "gwyddion is not installed";
  // SPIP's ASCII: sizes in nm, heights as numbers of Bit2nm nm each.
  const auto path = folder_.write("map.asc",
                                  "# File Format = ASCII\n# Created by SPIP 5.0\n# x-pixels = 3\n"
                                  "# y-pixels = 2\n# x-length = 3000\n# y-length = 4000\n"
                                  "# Bit2nm = 2\n# Start of Data:\n1\t2\t3\n4\t5\t6\n");
  const Channel channel = gwyddion_fallback().read(path, {}).front();
  EXPECT_EQ(channel.unit, "m");
  EXPECT_EQ(channel.grid.nx, 3);
  EXPECT_EQ(channel.grid.ny, 2);
  EXPECT_NEAR(channel.grid.pitch_x.si(), 1e-6, 1e-18);
  EXPECT_NEAR(channel.grid.pitch_y.si(), 2e-6, 1e-18);
  EXPECT_NEAR(channel.values(1, 2), 12e-9, 1e-22);
}

}  // namespace
}  // namespace manoscope::io

#include "manoscope/serve/folder.hpp"

#include <gtest/gtest.h>
#include <sys/stat.h>

#include <fstream>

#include "manoscope/serve/api_error.hpp"
#include "manoscope/serve/experiment_files.hpp"
#include "manoscope/serve/scan.hpp"
#include "manoscope/serve/upload.hpp"
#include "tests/support/temporary_folder.hpp"

namespace manoscope::serve {
namespace {

namespace fs = std::filesystem;

void write(const fs::path& path, const std::string& text) {
  fs::create_directories(path.parent_path());
  std::ofstream(path) << text;
}

std::string read(const fs::path& path) {
  std::ifstream file(path);
  return {std::istreambuf_iterator<char>(file), std::istreambuf_iterator<char>()};
}

class FolderTest : public testing::Test {
 protected:
  FolderTest() : folder(top()) {}

  fs::path top() {
    fs::create_directories(outer / "served");
    write(outer / "secret.csv", "secret");
    write(outer / "served/a/b.csv", "b");
    return outer / "served";
  }

  test_support::TemporaryFolder outer;
  Folder folder;
};

TEST_F(FolderTest, OpensFilesAndFoldersBeneath) {
  EXPECT_TRUE(folder.has("a/b.csv", Folder::Kind::file));
  EXPECT_TRUE(folder.has("a", Folder::Kind::folder));
  EXPECT_TRUE(folder.has("", Folder::Kind::folder));
  EXPECT_FALSE(folder.has("a", Folder::Kind::file));
  EXPECT_FALSE(folder.has("a/b.csv", Folder::Kind::folder));
  EXPECT_FALSE(folder.has("none", Folder::Kind::file));
}

TEST_F(FolderTest, NoPathAndNoLinkLeadsOut) {
  fs::create_symlink("../../secret.csv", outer / "served/a/link.csv");
  fs::create_symlink(outer / "secret.csv", outer / "served/absolute.csv");
  fs::create_directory_symlink("..", outer / "served/up");
  fs::create_symlink("/proc/self/root", outer / "served/magic");
  fs::create_symlink("round.csv", outer / "served/round.csv");
  for (const char* path : {"../secret.csv", "a/../../secret.csv", "a/link.csv", "absolute.csv",
                           "up/secret.csv", "magic/etc/passwd", "round.csv"}) {
    EXPECT_FALSE(folder.has(path, Folder::Kind::file)) << path;
    EXPECT_TRUE(folder.leads_out(path)) << path;
  }
  EXPECT_FALSE(folder.leads_out("a/none.csv"));
  EXPECT_FALSE(folder.leads_out("a/b.csv"));
}

TEST_F(FolderTest, TellsWhereLinksEnd) {
  fs::create_symlink("a/b.csv", outer / "served/inner.csv");
  fs::create_symlink("../secret.csv", outer / "served/out.csv");
  EXPECT_EQ(folder.without_links("inner.csv"), "a/b.csv");
  EXPECT_EQ(folder.without_links("a/../inner.csv"), "a/b.csv");
  EXPECT_EQ(folder.without_links("a/b.csv"), "a/b.csv");
  EXPECT_EQ(folder.without_links("new/c.csv"), "new/c.csv");
  EXPECT_THROW(folder.without_links("out.csv"), InputError);
}

TEST_F(FolderTest, LinksWithinAreFollowed) {
  fs::create_symlink("a/b.csv", outer / "served/inner.csv");
  EXPECT_TRUE(folder.has("inner.csv", Folder::Kind::file));
}

TEST_F(FolderTest, APipeHoldsNobody) {
  ASSERT_EQ(::mkfifo((outer / "served/pipe.csv").c_str(), 0600), 0);
  EXPECT_FALSE(folder.has("pipe.csv", Folder::Kind::file));
}

TEST_F(FolderTest, ListsWhatIsServed) {
  write(outer / "served/.hidden", "x");
  write(outer / "served/z.csv", "zz");
  fs::create_symlink("../secret.csv", outer / "served/out.csv");
  fs::create_symlink("z.csv", outer / "served/in.csv");
  const auto entries = list_folder(folder, "", 100);
  ASSERT_EQ(entries.size(), 3u);
  EXPECT_TRUE(entries[0].is_folder);
  EXPECT_EQ(entries[0].name, "a");
  EXPECT_EQ(entries[1].name, "in.csv");
  EXPECT_EQ(entries[2].size, 2u);
  EXPECT_EQ(list_folder(folder, "", 2).size(), 2u);
}

TEST_F(FolderTest, ScansTellWhatChanged) {
  const Scan before = scan(folder);
  EXPECT_EQ(before.files.size(), 1u);
  write(outer / "served/a/b.csv", "longer");
  write(outer / "served/new.csv", "");
  const Scan after = scan(folder);
  EXPECT_EQ(changed_files(before, after), (std::vector<std::string>{"a/b.csv", "new.csv"}));
  EXPECT_EQ(changed_files(after, before), (std::vector<std::string>{"a/b.csv", "new.csv"}));
}

TEST_F(FolderTest, WhatLiesDeepInOneBranchHidesNoOther) {
  // By name the deep branch comes first.
  write(outer / "served/aaa/1/2/3/4/5/6/7/deep.csv", "");
  write(outer / "served/s1/experiment.toml", "");
  const Scan found = scan(folder);
  EXPECT_TRUE(found.truncated);
  EXPECT_TRUE(found.files.contains("s1/experiment.toml"));
  EXPECT_TRUE(found.files.contains("a/b.csv"));
  EXPECT_FALSE(found.files.contains("aaa/1/2/3/4/5/6/7/deep.csv"));
}

TEST_F(FolderTest, ExperimentsAreFoundBesideThousandsOfFiles) {
  fs::create_directories(outer / "served/many");
  for (int i = 0; i < 5100; ++i) {
    std::ofstream(outer / "served/many" / (std::to_string(i) + ".gsf"));
  }
  write(outer / "served/z/y/experiment.toml", "");
  write(outer / "served/z/y/result.nc", "");
  write(outer / "served/z/y/usual.csv", "");
  const Scan found = scan(folder);
  EXPECT_TRUE(found.truncated);
  EXPECT_TRUE(found.files.contains("z/y/experiment.toml"));
  EXPECT_TRUE(found.files.contains("z/y/result.nc"));
  EXPECT_EQ(found.files.size(), 5002u);
}

TEST_F(FolderTest, ScansEndAtALink) {
  fs::create_directory_symlink(".", outer / "served/again");
  EXPECT_EQ(scan(folder).files.size(), 1u);
}

TEST_F(FolderTest, UploadsAppearWholeAndReplaceNothing) {
  {
    Upload upload(folder, {"new", "map.gsf"});
    upload.write("abc");
    EXPECT_FALSE(fs::exists(outer / "served/new/map.gsf"));
    upload.write("def");
    upload.finish();
  }
  EXPECT_EQ(read(outer / "served/new/map.gsf"), "abcdef");
  try {
    Upload again(folder, {"new", "map.gsf"});
    FAIL() << "replaced";
  } catch (const ApiError& error) {
    EXPECT_EQ(error.status(), 409u);
  }
}

TEST_F(FolderTest, UploadsLeaveNothingBehindThatIsNotWhole) {
  {
    Upload upload(folder, {"map.gsf"});
    upload.write("abc");
  }
  EXPECT_EQ(scan(folder).files.size(), 1u);
  std::size_t n = 0;
  for ([[maybe_unused]] const auto& entry : fs::directory_iterator(outer / "served")) ++n;
  EXPECT_EQ(n, 1u);
}

TEST_F(FolderTest, AnUploadThatCameSecondReplacesNothing) {
  Upload first(folder, {"map.gsf"}), second(folder, {"map.gsf"});
  first.write("first");
  second.write("second");
  first.finish();
  EXPECT_THROW(second.finish(), ApiError);
  EXPECT_EQ(read(outer / "served/map.gsf"), "first");
}

TEST_F(FolderTest, UploadsDoNotLeaveTheFolder) {
  fs::create_directory_symlink("..", outer / "served/up");
  EXPECT_THROW(Upload(folder, {"up", "x.gsf"}), InputError);
  EXPECT_THROW(Upload(folder, {"..", "x.gsf"}), InputError);
  EXPECT_THROW(Upload(folder, {".ssh", "x"}), InputError);
  EXPECT_THROW(Upload(folder, {"a", "b.csv", "x"}), InputError);
  EXPECT_FALSE(fs::exists(outer / "x.gsf"));
}

TEST(ExperimentFiles, NamesInAnExperimentAreRelativeToIt) {
  EXPECT_EQ(beneath("s1/experiment.toml", "h.csv"), "s1/h.csv");
  EXPECT_EQ(beneath("s1/experiment.toml", "../maps/h.csv"), "maps/h.csv");
  EXPECT_EQ(beneath("experiment.toml", "a/../b"), "b");
  for (const char* name : {"../../x", "/etc/passwd", "a/../../../x"}) {
    EXPECT_EQ(beneath("s1/experiment.toml", name), std::nullopt) << name;
  }
  EXPECT_EQ(beneath("experiment.toml", ".."), std::nullopt);
}

}  // namespace
}  // namespace manoscope::serve

#include "manoscope/core/atomic_file.hpp"

#include <gtest/gtest.h>
#include <sys/resource.h>
#include <unistd.h>

#include <csignal>
#include <fstream>
#include <iterator>
#include <string>

#include "manoscope/core/error.hpp"
#include "tests/support/as_ordinary_user.hpp"

namespace manoscope {
namespace {

namespace fs = std::filesystem;

/// A folder of this test alone, removed at its end.
class AtomicFileTest : public ::testing::Test {
 protected:
  void SetUp() override {
    folder_ = fs::temp_directory_path() /
              ("manoscope_atomic_" + std::to_string(::getpid()) + "_" +
               ::testing::UnitTest::GetInstance()->current_test_info()->name());
    fs::create_directories(folder_);
  }
  void TearDown() override {
    fs::permissions(folder_, fs::perms::owner_all);
    fs::remove_all(folder_);
  }

  static std::string content(const fs::path& path) {
    std::ifstream in(path, std::ios::binary);
    return {std::istreambuf_iterator<char>(in), {}};
  }
  std::ptrdiff_t n_files() const {
    return std::distance(fs::directory_iterator(folder_), fs::directory_iterator());
  }

  fs::path folder_;
};

TEST_F(AtomicFileTest, WritesTheBytesGivenAndLeavesNothingElse) {
  const std::string bytes("a\0b\n\xff", 5);
  write_file_atomically(folder_ / "x.bin", bytes);
  EXPECT_EQ(content(folder_ / "x.bin"), bytes);
  write_file_atomically(folder_ / "x.bin", "");
  EXPECT_EQ(content(folder_ / "x.bin"), "");
  EXPECT_EQ(n_files(), 1);
}

TEST_F(AtomicFileTest, NewFilesHaveTheUsualPermissions) {
  write_file_atomically(folder_ / "x", "new");
  std::ofstream(folder_ / "usual") << "new";
  EXPECT_EQ(fs::status(folder_ / "x").permissions(), fs::status(folder_ / "usual").permissions());
}

TEST_F(AtomicFileTest, WithoutCommitTheOldFileStays) {
  write_file_atomically(folder_ / "x", "old");
  {
    const AtomicFile file(folder_ / "x");
    std::ofstream(file.temporary()) << "half of the new";
    EXPECT_EQ(file.temporary().parent_path(), folder_);
  }
  EXPECT_EQ(content(folder_ / "x"), "old");
  EXPECT_EQ(n_files(), 1);
}

TEST_F(AtomicFileTest, SeveralMayBeOpenInOneFolder) {
  AtomicFile a(folder_ / "a"), b(folder_ / "b");
  std::ofstream(a.temporary()) << "of a";
  std::ofstream(b.temporary()) << "of b";
  b.commit();
  a.commit();
  EXPECT_EQ(content(folder_ / "a"), "of a");
  EXPECT_EQ(content(folder_ / "b"), "of b");
  EXPECT_EQ(n_files(), 2);
}

TEST_F(AtomicFileTest, WritesThroughASymbolicLink) {
  write_file_atomically(folder_ / "real", "old");
  fs::create_symlink("real", folder_ / "link");
  write_file_atomically(folder_ / "link", "new");
  EXPECT_TRUE(fs::is_symlink(folder_ / "link"));
  EXPECT_EQ(content(folder_ / "real"), "new");
}

TEST_F(AtomicFileTest, AMissingFolderOrAFolderAsTargetIsTheUsersToMend) {
  try {
    write_file_atomically(folder_ / "absent" / "x", "text");
    FAIL();
  } catch (const InputError& error) {
    EXPECT_EQ(error.where(), (folder_ / "absent" / "x").string());
    EXPECT_NE(error.mend().find("folder"), std::string::npos);
  }
  EXPECT_THROW(write_file_atomically(folder_, "text"), InputError);
  EXPECT_THROW(write_file_atomically("", "text"), InputError);
}

TEST_F(AtomicFileTest, PermissionsAreRespected) {
  write_file_atomically(folder_ / "protected", "old");
  fs::permissions(folder_ / "protected", fs::perms::owner_read | fs::perms::others_read);
  fs::permissions(folder_, fs::perms::all);
  {
    const test_support::AsOrdinaryUser nobody;
    if (!nobody.holds()) GTEST_SKIP() << "cannot act as an ordinary user here";
    EXPECT_THROW(write_file_atomically(folder_ / "protected", "new"), InputError);
    EXPECT_NO_THROW(write_file_atomically(folder_ / "x", "new"));
  }
  EXPECT_EQ(content(folder_ / "protected"), "old");
  fs::permissions(folder_, fs::perms::owner_read | fs::perms::owner_exec);
  {
    const test_support::AsOrdinaryUser nobody;
    EXPECT_THROW(write_file_atomically(folder_ / "y", "new"), InputError);
  }
}

TEST_F(AtomicFileTest, ADiskThatTakesOnlyPartLeavesTheOldFileWhole) {
  // A limit on the size of files stands in for a full disk: write() fails halfway in both cases.
  write_file_atomically(folder_ / "x", "old");
  rlimit before{};
  ASSERT_EQ(::getrlimit(RLIMIT_FSIZE, &before), 0);
  const auto handler = std::signal(SIGXFSZ, SIG_IGN);
  rlimit small = before;
  small.rlim_cur = 1000;
  ASSERT_EQ(::setrlimit(RLIMIT_FSIZE, &small), 0);
  std::string found, where;
  try {
    write_file_atomically(folder_ / "x", std::string(5000, 'n'));
  } catch (const InputError& error) {
    found = error.found();
    where = error.where();
  }
  ::setrlimit(RLIMIT_FSIZE, &before);
  std::signal(SIGXFSZ, handler);
  EXPECT_EQ(where, (folder_ / "x").string());
  EXPECT_NE(found.find("cannot be written"), std::string::npos) << found;
  EXPECT_EQ(content(folder_ / "x"), "old");
  EXPECT_EQ(n_files(), 1);
}

}  // namespace
}  // namespace manoscope

#include "manoscope/results/publication.hpp"

#include <gtest/gtest.h>
#include <stdlib.h>
#include <unistd.h>

#include <fstream>
#include <sstream>

#include "manoscope/core/error.hpp"
#include "tests/support/temporary_folder.hpp"

namespace manoscope::results {
namespace {

namespace fs = std::filesystem;
using test_support::TemporaryFolder;

std::string content(const fs::path& path) {
  std::ostringstream text;
  text << std::ifstream(path).rdbuf();
  return text.str();
}

void write(const fs::path& path, const std::string& text) {
  fs::create_directories(path.parent_path());
  std::ofstream(path) << text;
}

TEST(Publication, ReplacesTheEarlierSetAndKeepsOtherFiles) {
  const TemporaryFolder folder;
  write(folder / "a.csv", "old a");
  write(folder / "figures/old.svg", "old figure");
  write(folder / "figures/mine.svg", "not ours");
  write(folder / "notes.txt", "notes");
  {
    Publication publication(folder.path());
    publication.add("a.csv", "new a");
    publication.add("figures/new.svg", "new figure");
    publication.publish({"a.csv", "figures/old.svg", "never-was.txt"});
  }
  EXPECT_EQ(content(folder / "a.csv"), "new a");
  EXPECT_EQ(content(folder / "figures/new.svg"), "new figure");
  EXPECT_EQ(content(folder / "figures/mine.svg"), "not ours");
  EXPECT_EQ(content(folder / "notes.txt"), "notes");
  EXPECT_FALSE(fs::exists(folder / "figures/old.svg"));
  EXPECT_FALSE(fs::exists(folder / ".manoscope-publication"));
}

TEST(Publication, LeavesTheOldSetUntouchedUntilPublished) {
  const TemporaryFolder folder;
  write(folder / "a.csv", "old a");
  {
    Publication publication(folder.path());
    publication.add("a.csv", "new a");
    EXPECT_THROW(publication.add("b.nc", [](const fs::path&) { throw InputError("b", "c", "d"); }),
                 InputError);
  }
  EXPECT_EQ(content(folder / "a.csv"), "old a");
  EXPECT_FALSE(fs::exists(folder / ".manoscope-publication"));
}

TEST(Publication, PutsTheOldSetBackIfItCannotFinish) {
  const TemporaryFolder folder;
  write(folder / "a.csv", "old a");
  write(folder / "b.csv", "old b");
  {
    Publication publication(folder.path());
    publication.add("a.csv", "new a");
    publication.add("b.csv", "new b");
    fs::remove(folder / ".manoscope-publication/new/b.csv");  // lost under our feet
    EXPECT_THROW(publication.publish({"a.csv", "b.csv"}), InputError);
  }
  EXPECT_EQ(content(folder / "a.csv"), "old a");
  EXPECT_EQ(content(folder / "b.csv"), "old b");
}

TEST(Publication, ClearsWhatAKilledProcessLeft) {
  const TemporaryFolder folder;
  write(folder / ".manoscope-publication/new/stale.csv", "stale");
  {
    Publication publication(folder.path());
    publication.add("a.csv", "a");
    publication.publish({});
  }
  EXPECT_FALSE(fs::exists(folder / "stale.csv"));
  EXPECT_FALSE(fs::exists(folder / ".manoscope-publication"));
}

TEST(Publication, RefusesASecondWriterAtTheSameTime) {
  const TemporaryFolder folder;
  const Publication first(folder.path());
  try {
    const Publication second(folder.path());
    FAIL() << "two processes would overwrite each other";
  } catch (const InputError& error) {
    EXPECT_NE(error.found().find("another process"), std::string::npos);
  }
}

TEST(Publication, RefusesAFolderInTheWayBeforeAnythingMoves) {
  const TemporaryFolder folder;
  write(folder / "a.csv", "old a");
  fs::create_directories(folder / "b.csv");
  Publication publication(folder.path());
  publication.add("a.csv", "new a");
  publication.add("b.csv", "new b");
  EXPECT_THROW(publication.publish({"a.csv", "b.csv"}), InputError);
  EXPECT_EQ(content(folder / "a.csv"), "old a");
}

TEST(Publication, RefusesAPlaceThatIsAFileOrReadOnly) {
  const TemporaryFolder folder;
  write(folder / "file", "x");
  EXPECT_THROW(Publication(folder / "file"), InputError);
  EXPECT_THROW(Publication(folder / "file/below"), InputError);
  if (::geteuid() == 0) GTEST_SKIP() << "root may write everywhere: read-only folder not tried";
  fs::create_directories(folder / "locked");
  fs::permissions(folder / "locked", fs::perms::owner_read | fs::perms::owner_exec);
  EXPECT_THROW(Publication(folder / "locked"), InputError);
  fs::permissions(folder / "locked", fs::perms::owner_all);
}

}  // namespace
}  // namespace manoscope::results

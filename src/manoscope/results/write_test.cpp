#include "manoscope/results/write.hpp"

#include <gtest/gtest.h>
#include <netcdf.h>
#include <signal.h>
#include <sys/resource.h>
#include <sys/wait.h>
#include <unistd.h>

#include <algorithm>
#include <chrono>
#include <fstream>

#include "manoscope/core/error.hpp"
#include "manoscope/core/provenance.hpp"
#include "manoscope/core/random.hpp"
#include "manoscope/results/tables.hpp"
#include "tests/support/example_measurement.hpp"
#include "tests/support/temporary_folder.hpp"

namespace manoscope::results {
namespace {

namespace fs = std::filesystem;
using test_support::example_measurement;
using test_support::first_difference;
using test_support::TemporaryFolder;

Measurement variant(int number) {
  return example_measurement(
      {.n_x = 60, .n_levels = 6, .n_runs = 3, .seed = static_cast<std::uint64_t>(number)});
}

std::vector<ExtraFile> extras(int number) {
  const std::string mark = std::to_string(number);
  return {{"report.html", "report " + mark + std::string(50000, '.') + "end"},
          {"figures/common.svg", "figure " + mark},
          {"figures/only_" + mark + ".svg", "figure " + mark},
          {"figures/only_" + mark + ".pdf", "figure " + mark}};
}

/// Every file of the folder holds what variant `number` wrote, and no figure of another is left.
void expect_whole(const fs::path& folder, int number) {
  const auto expected = variant(number);
  EXPECT_EQ(first_difference(read_result(folder), expected), "");
  EXPECT_EQ(read_file(folder / "pressure.csv"), pressure_table(expected));
  EXPECT_EQ(read_file(folder / "drops.csv"), drops_table(expected));
  for (const ExtraFile& extra : extras(number)) {
    EXPECT_EQ(read_file(folder / extra.name), extra.bytes);
  }
  const auto n_figures = std::distance(fs::directory_iterator(folder / "figures"), {});
  EXPECT_EQ(n_figures, 3);
  EXPECT_FALSE(fs::exists(folder / ".manoscope-publication"));
}

TEST(WriteResult, MakesTheFolderAndEveryFileOfTheContract) {
  const TemporaryFolder folder;
  write_result(folder / "new/result", variant(1), extras(1));
  expect_whole(folder / "new/result", 1);
}

TEST(WriteResult, WithdrawsTheFiguresOfTheEarlierResultAndKeepsForeignFiles) {
  const TemporaryFolder folder;
  write_result(folder.path(), variant(1), extras(1));
  std::ofstream(folder / "notes.txt") << "mine";
  write_result(folder.path(), variant(2), extras(2));
  expect_whole(folder.path(), 2);
  EXPECT_EQ(read_file(folder / "notes.txt"), "mine");
}

TEST(WriteResult, WithoutAReportWithdrawsTheEarlierReport) {
  const TemporaryFolder folder;
  write_result(folder.path(), variant(1), extras(1));
  write_result(folder.path(), variant(2), {});
  EXPECT_FALSE(fs::exists(folder / "report.html"));
  EXPECT_FALSE(fs::exists(folder / "figures/common.svg"));
}

TEST(WriteResult, ReplacesADamagedEarlierResult) {
  const TemporaryFolder folder;
  std::ofstream(folder / "result.nc") << "half a fi";
  write_result(folder.path(), variant(1), extras(1));
  expect_whole(folder.path(), 1);
}

TEST(CheckDestination, LetsAnExperimentReplaceItsOwnResultAndNoOther) {
  const TemporaryFolder folder;
  EXPECT_FALSE(check_destination(folder / "absent", "a", false));
  EXPECT_FALSE(check_destination(folder.path(), "a", false));  // nothing there
  const Measurement written = variant(1);
  write_result(folder.path(), written, extras(1));
  EXPECT_TRUE(check_destination(folder.path(), written.title, false));
  const auto refused = [&](const std::string& told) {
    try {
      check_destination(folder.path(), "another title", false);
      ADD_FAILURE() << "not refused";
    } catch (const InputError& error) {
      EXPECT_EQ(error.where(), (folder / "result.nc").string());
      EXPECT_NE(error.found().find(told), std::string::npos) << error.found();
      EXPECT_NE(error.mend().find("--overwrite"), std::string::npos) << error.mend();
    }
    EXPECT_TRUE(check_destination(folder.path(), "another title", true));
  };
  refused(written.title);
  std::ofstream(folder / "result.nc") << "half a fi";
  refused("no readable result");
}

TEST(WriteResult, RefusesAnExtraFileOutsideTheFolder) {
  const TemporaryFolder folder;
  EXPECT_THROW(write_result(folder / "r", variant(1), {{"../evil.txt", "x"}}), InternalError);
  EXPECT_THROW(write_result(folder / "r", variant(1), {{"/tmp/evil.txt", "x"}}), InternalError);
  EXPECT_FALSE(fs::exists(folder / "evil.txt"));
}

TEST(ReadResult, TakesTheFolderOrTheFile) {
  const TemporaryFolder folder;
  write_result(folder.path(), variant(1), {});
  EXPECT_EQ(first_difference(read_result(folder.path()), read_result(folder / "result.nc")), "");
  fs::create_directories(folder / "empty");
  EXPECT_THROW(read_result(folder / "empty"), InputError);
  EXPECT_THROW(read_result(folder / "absent"), InputError);
}

TEST(WriteResult, OnAFullDiskNamesTheFileAndLeavesTheOldResultWhole) {
  // A limit on the size of files stands for the full disk: write() fails as it does there.
  for (const rlim_t limit : {1000, 20000, 49000, 120000}) {
    const TemporaryFolder folder;
    write_result(folder.path(), variant(1), extras(1));
    ASSERT_GT(fs::file_size(folder / "result.nc"), 120000u);
    const pid_t child = ::fork();
    ASSERT_GE(child, 0);
    if (child == 0) {
      ::signal(SIGXFSZ, SIG_IGN);
      const rlimit small{limit, limit};
      ::setrlimit(RLIMIT_FSIZE, &small);
      try {
        write_result(folder.path(), variant(2), extras(2));
      } catch (const InputError& error) {
        ::_exit(error.where().find(folder.path().string()) == 0 ? 2 : 3);
      } catch (...) {
        ::_exit(4);
      }
      ::_exit(0);
    }
    int status = 0;
    ::waitpid(child, &status, 0);
    ASSERT_TRUE(WIFEXITED(status)) << "ended by signal " << WTERMSIG(status);
    EXPECT_EQ(WEXITSTATUS(status), 2) << "limit " << limit;
    expect_whole(folder.path(), 1);
  }
}

/// Writes odd and even variants in turn, until killed after `microseconds`.
void write_until_killed(const fs::path& folder, useconds_t microseconds) {
  const auto odd = variant(1), even = variant(2);
  const pid_t child = ::fork();
  ASSERT_GE(child, 0);
  if (child == 0) {
    for (int i = 0;; ++i) write_result(folder, i % 2 ? odd : even, extras(i % 2 ? 1 : 2));
  }
  ::usleep(microseconds);
  ::kill(child, SIGKILL);
  int status = 0;
  ::waitpid(child, &status, 0);
  ASSERT_TRUE(WIFSIGNALED(status) && WTERMSIG(status) == SIGKILL) << "ended by itself";
}

/// The tables are whole, and where result.nc is, everything is, and of the same measurement.
void expect_nothing_half(const fs::path& folder) {
  const auto odd = variant(1), even = variant(2);
  for (const auto& [name, text_of] :
       {std::pair{"pressure.csv", &pressure_table}, {"drops.csv", &drops_table}}) {
    if (!fs::exists(folder / name)) continue;
    const std::string found = read_file(folder / name);
    EXPECT_TRUE(found == text_of(odd) || found == text_of(even)) << name;
  }
  if (!fs::exists(folder / "result.nc")) return;
  const bool is_odd = first_difference(read_result(folder), odd).empty();
  const auto& expected = is_odd ? odd : even;
  EXPECT_EQ(first_difference(read_result(folder), expected), "");
  EXPECT_EQ(read_file(folder / "pressure.csv"), pressure_table(expected));
  for (const ExtraFile& extra : extras(is_odd ? 1 : 2)) {
    EXPECT_EQ(read_file(folder / extra.name), extra.bytes);
  }
}

TEST(WriteResult, KilledAtAnyTimeLeavesAWholeResultOrNoneAndNoHalfFile) {
  const TemporaryFolder folder;
  RandomStream random(11, "moments");
  write_result(folder.path(), variant(1), extras(1));
  const auto start = std::chrono::steady_clock::now();
  write_result(folder.path(), variant(2), extras(2));
  const std::chrono::duration<double, std::micro> one = std::chrono::steady_clock::now() - start;
  constexpr int kTrials = 25;
  int n_without = 0;
  for (int trial = 0; trial < kTrials; ++trial) {
    write_until_killed(folder.path(),
                       static_cast<useconds_t>(random.uniform(0.0, 3.0 * one.count())));
    expect_nothing_half(folder.path());
    ASSERT_FALSE(HasFailure()) << "trial " << trial;
    if (fs::exists(folder / "result.nc")) continue;
    ++n_without;
    write_result(folder.path(), variant(1), extras(1));  // the next run heals the folder
  }
  RecordProperty("trials_without_result", n_without);
  // The old result is gone only during a few renames, far under half of the time of a write.
  EXPECT_LT(n_without, kTrials / 2);
}

TEST(WriteResult, InAReadOnlyFolderIsTheUsersFault) {
  if (::geteuid() == 0) GTEST_SKIP() << "root may write everywhere: read-only folder not tried";
  const TemporaryFolder folder;
  fs::permissions(folder.path(), fs::perms::owner_read | fs::perms::owner_exec);
  EXPECT_THROW(write_result(folder.path(), variant(1), {}), InputError);
  fs::permissions(folder.path(), fs::perms::owner_all);
}

}  // namespace
}  // namespace manoscope::results

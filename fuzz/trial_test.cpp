// The judge of readers finds what it is there to find: readers that misbehave on purpose.
#include "fuzz/trial.hpp"

#include <gtest/gtest.h>

#include <cstdlib>
#include <functional>
#include <stdexcept>
#include <vector>

#include "fuzz/mutation.hpp"
#include "manoscope/io/test_files.hpp"

namespace manoscope::fuzz {
namespace {

class FakeReader final : public io::Reader {
 public:
  using Body = std::function<std::vector<io::Channel>(const std::filesystem::path&)>;
  explicit FakeReader(Body body) : body_(std::move(body)) {}
  std::string_view name() const override { return "fake"; }
  std::string_view description() const override { return "fake"; }
  std::vector<std::string> extensions() const override { return {}; }
  int score(const io::Probe&) const override { return 0; }
  std::vector<io::Channel> read(const std::filesystem::path& path,
                                const io::ReadOptions&) const override {
    return body_(path);
  }

 private:
  Body body_;
};

std::vector<io::Channel> one_channel(Index nx, Index ny) {
  std::vector<io::Channel> channels(1);
  channels[0].grid.nx = nx;
  channels[0].grid.ny = ny;
  channels[0].values = Array2::Zero(ny, nx);
  return channels;
}

std::string fault_of(const FakeReader::Body& body) {
  const io::testing::TestFolder folder;
  return read_in_every_way(folder.write("a.bin", "0123456789"), FakeReader(body), 1.0).fault;
}

TEST(Trial, AReaderThatReadsOrRefusesWithWordsHasNoFault) {
  EXPECT_EQ(fault_of([](const auto&) { return one_channel(3, 2); }), "");
  EXPECT_EQ(fault_of([](const auto& path) -> std::vector<io::Channel> {
              throw InputError(path.string(), "found", "mend");
            }),
            "");
}

TEST(Trial, OtherExceptionsAndEmptyWordsAreFaults) {
  using io::testing::contains;
  const auto throwing = [](const auto& error) {
    return fault_of([&](const auto&) -> std::vector<io::Channel> { throw error; });
  };
  EXPECT_TRUE(contains(throwing(std::length_error("too long")), "no InputError: too long"));
  EXPECT_TRUE(contains(throwing(std::bad_alloc()), "no InputError"));
  EXPECT_TRUE(contains(throwing(InputError("elsewhere", "found", "mend")), "instead of the file"));
  const auto wordless = [](const std::string& found, const std::string& mend) {
    return fault_of([&](const auto& path) -> std::vector<io::Channel> {
      throw InputError(path.string(), found, mend);
    });
  };
  EXPECT_TRUE(contains(wordless("", "mend"), "without words"));
  EXPECT_TRUE(contains(wordless("found", ""), "without words"));
  EXPECT_TRUE(contains(wordless("a\nb", "mend"), "control codes"));
}

TEST(Trial, NoChannelAndAWrongGridAreFaults) {
  using io::testing::contains;
  EXPECT_TRUE(
      contains(fault_of([](const auto&) { return std::vector<io::Channel>(); }), "no channel"));
  EXPECT_TRUE(contains(fault_of([](const auto&) {
                         auto channels = one_channel(3, 2);
                         channels[0].grid.nx = 4;
                         return channels;
                       }),
                       "3 x 2 values on a grid of 4 x 2"));
}

TEST(Trial, MemoryBeyondFourTimesTheHonestSizeIsAFault) {
  using io::testing::contains;
  const auto taking = [](std::size_t n_bytes) {
    return fault_of([&](const auto& path) -> std::vector<io::Channel> {
      const std::vector<char> room(n_bytes);
      throw InputError(path.string(), std::string(1, room[0] == 0 ? 'a' : 'b'), "mend");
    });
  };
  EXPECT_EQ(taking(200000), "");  // within the constant of 256 KiB
  EXPECT_TRUE(contains(taking(300000), "allowed are 262184 (4 x 10 + 262144)"));
  // What is given back as a map is honest: 8 bytes a pixel.
  EXPECT_EQ(fault_of([](const auto&) { return one_channel(1000, 1000); }), "");
}

TEST(Trial, AProcessOfHdf5IsHeldToItsLimits) {
  using io::testing::contains;
  const io::WorkerLimits limits = io::worker_limits(1000);
  EXPECT_EQ(worker_fault(10.9, limits.memory_bytes, limits), "");
  EXPECT_TRUE(contains(worker_fault(11.1, 0, limits), "compute for 11.1 s, allowed are 10 s"));
  EXPECT_TRUE(contains(worker_fault(0.0, limits.memory_bytes + 1, limits), "1073757825 bytes"));
}

TEST(Trial, ACrashOfTheProcessOfHdf5IsNoFaultOfOurs) {
  const io::testing::TestFolder folder;
  const auto script = folder.write("reader.sh", "#!/bin/sh\nkill -SEGV $$\n");
  std::filesystem::permissions(script, std::filesystem::perms::owner_all);
  ::setenv("MANOSCOPE_HDF5_READER", script.c_str(), 1);
  const auto path = folder.write("a.h5", "\x89HDF\r\n\x1a\n and nothing else");
  const Trial trial = read_in_every_way(path, io::find_reader(path), 1.0);
  ::unsetenv("MANOSCOPE_HDF5_READER");
  EXPECT_EQ(trial.fault, "");
  EXPECT_FALSE(trial.was_read);
}

TEST(Trial, FilesOfHdf5AreKnownByTheirSignatureAlsoBehindMatlabsBlock) {
  const std::string signature = "\x89HDF\r\n\x1a\n";
  EXPECT_TRUE(is_hdf5(signature));
  EXPECT_TRUE(is_hdf5(std::string(512, ' ') + signature));
  EXPECT_FALSE(is_hdf5(std::string(511, ' ') + signature));
  EXPECT_FALSE(is_hdf5(""));
}

TEST(Mutation, IsTheSameForTheSameStreamAndAlmostAlwaysDamages) {
  const std::string bytes(2000, 'x'), other(500, 'y');
  int n_same = 0;
  for (std::uint64_t i = 0; i < 500; ++i) {
    RandomStream once(1, "a", i), again(1, "a", i);
    const std::string damaged = mutated(bytes, other, once);
    EXPECT_EQ(damaged, mutated(bytes, other, again));
    n_same += damaged == bytes ? 1 : 0;
  }
  // A doubled block of equal letters at the end and the like: by luck, not as a rule.
  EXPECT_LT(n_same, 25);
}

}  // namespace
}  // namespace manoscope::fuzz

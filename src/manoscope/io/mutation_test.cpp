// Damaged files of every format: whatever the bytes, a map or an InputError comes out, soon, and
// without memory beyond what the file's size explains.
//
// NetCDF-4 files are left out: libhdf5 itself fails on some damaged files.
#include <gtest/gtest.h>
#include <sys/resource.h>

#include <array>
#include <cmath>
#include <fstream>
#include <vector>

#include "manoscope/core/random.hpp"
#include "manoscope/io/map_summary.hpp"
#include "manoscope/io/reader.hpp"
#include "manoscope/io/test_classic_netcdf.hpp"
#include "manoscope/io/test_files.hpp"
#include "manoscope/io/writer.hpp"

namespace manoscope::io {
namespace {

using testing::TestFolder;

constexpr int kMutations = 2000;

/// While it lives, the process may grow by `megabytes` at most: an allocation driven by a damaged
/// count fails at once with std::bad_alloc, which no test forgives. The sanitizers reserve address
/// space as they please and go without.
class MemoryLimit {
 public:
  explicit MemoryLimit([[maybe_unused]] std::uint64_t megabytes) {
#if !defined(__SANITIZE_ADDRESS__)
    std::uint64_t pages = 0;
    std::ifstream("/proc/self/statm") >> pages;
    ::getrlimit(RLIMIT_AS, &before_);
    rlimit tight = before_;
    tight.rlim_cur =
        pages * static_cast<std::uint64_t>(::sysconf(_SC_PAGESIZE)) + (megabytes << 20);
    active_ = pages > 0 && ::setrlimit(RLIMIT_AS, &tight) == 0;
#endif
  }
  ~MemoryLimit() {
    if (active_) ::setrlimit(RLIMIT_AS, &before_);
  }
  MemoryLimit(const MemoryLimit&) = delete;
  MemoryLimit& operator=(const MemoryLimit&) = delete;

 private:
  rlimit before_{};
  bool active_ = false;
};

/// One to four random wounds.
std::string mutated(std::string bytes, RandomStream& random) {
  static const std::array<std::string, 14> kTokens{"-1",  "0",   "99999999999", "1e308", "-1e-320",
                                                   "nan", "inf", "=",           ":",     "\n",
                                                   ",",   ";",   "m",           "#"};
  const auto position = [&] {
    return static_cast<std::size_t>(random.below(static_cast<Index>(bytes.size())));
  };
  const Index n_wounds = 1 + random.below(4);
  for (Index wound = 0; wound < n_wounds && bytes.size() > 8; ++wound) {
    // Half of the wounds hit the header, which is small beside the data.
    const bool in_header = random.below(2) == 0;
    const std::size_t at =
        in_header ? position() % std::min<std::size_t>(bytes.size(), 300) : position();
    switch (random.below(7)) {
      case 0:
        bytes[at] = static_cast<char>(bytes[at] ^ (1 << random.below(8)));
        break;
      case 1:
        bytes[at] = static_cast<char>(random.below(256));
        break;
      case 2:
        bytes.resize(1 + at);
        break;
      case 3:
        bytes.insert(at, bytes.substr(position(), static_cast<std::size_t>(random.below(64))));
        break;
      case 4:
        bytes.erase(at, static_cast<std::size_t>(1 + random.below(16)));
        break;
      case 5: {
        const std::string& token = kTokens[static_cast<std::size_t>(random.below(kTokens.size()))];
        bytes.replace(at, std::min(token.size(), bytes.size() - at), token);
        break;
      }
      default:
        for (std::size_t i = at; i < std::min(at + 4, bytes.size()); ++i) {
          bytes[i] = static_cast<char>(random.below(2) == 0 ? 0xff : 0x7f);
        }
    }
  }
  return bytes;
}

/// Reads every mutation, through the registry and through the format's own reader.
void survive(const std::string& name, const std::vector<std::string>& originals) {
  const TestFolder folder;
  RandomStream random(20240607, name);
  ReadOptions options;
  int n_read = 0, n_refused = 0;
  const Reader& reader = find_reader(folder.write(name, originals.front()));
  const MemoryLimit limit(64);
  for (int i = 0; i < kMutations; ++i) {
    const std::string& original = originals[static_cast<std::size_t>(i) % originals.size()];
    const auto path = folder.write(name, mutated(original, random));
    for (const bool directly : {false, true}) {
      try {
        const auto channels = directly ? reader.read(path, options) : read_channels(path, options);
        for (const Channel& channel : channels) {
          ASSERT_EQ(channel.values.rows(), channel.grid.ny);
          ASSERT_EQ(channel.values.cols(), channel.grid.nx);
          ASSERT_GE(channel.grid.pitch_x, Length{});
          static_cast<void>(summarise(channel));
        }
        if (!directly) static_cast<void>(read_height_map(path, options));
        ++n_read;
      } catch (const InputError& error) {
        ASSERT_FALSE(error.found().empty());
        ++n_refused;
      } catch (const std::exception& error) {
        FAIL() << "mutation " << i << ": " << error.what();
      }
    }
  }
  // Both ways out were taken, or the mutations test nothing.
  EXPECT_GT(n_read, kMutations / 50);
  EXPECT_GT(n_refused, kMutations / 5);
}

HeightMap bumpy_map() {
  Array2 height(24, 32);
  for (Index i = 0; i < height.size(); ++i) {
    height.data()[i] = 1e-6 * std::sin(0.3 * static_cast<double>(i));
  }
  return HeightMap(CameraGrid{32, 24, 1.5 * um, 2.0 * um}, height);
}

TEST(Mutations, OfSimpleFieldsAreReadOrRefused) {
  const TestFolder folder;
  write_gsf(folder / "a.gsf", bumpy_map(), "bumps");
  survive("map.gsf", {testing::bytes_of(folder / "a.gsf")});
}

TEST(Mutations, OfTextMapsAreReadOrRefused) {
  const TestFolder folder;
  write_text_map(folder / "a.csv", bumpy_map(), "bumps");
  std::string decimal_comma = "# Breite: 12,34 \xC2\xB5m\n# H\xC3\xB6he: 5 \xC2\xB5m\nunit = nm\n";
  for (int row = 0; row < 12; ++row) decimal_comma += "1,5;2,25;;-3,0e-2;Bad\r\n";
  survive("map.txt", {testing::bytes_of(folder / "a.csv"), decimal_comma});
}

TEST(Mutations, OfClassicNetcdfAreReadOrRefused) {
  testing::ClassicNetcdf file;
  file.dimensions = {{"y", 12}, {"x", 20}};
  std::vector<double> x, y, heights;
  for (int i = 0; i < 20; ++i) x.push_back(1e-6 * i);
  for (int i = 0; i < 12; ++i) y.push_back(2e-6 * i);
  for (int i = 0; i < 240; ++i) heights.push_back(1e-9 * i);
  file.variables = {{"y", {0}, {{"units", "m"}}, {}, testing::ClassicNetcdf::doubles(y)},
                    {"x", {1}, {{"units", "m"}}, {}, testing::ClassicNetcdf::doubles(x)},
                    {"height",
                     {0, 1},
                     {{"units", "m"}},
                     {{"scale_factor", 2.0}, {"_FillValue", -1.0}},
                     testing::ClassicNetcdf::doubles(heights)}};
  survive("map.nc", {file.bytes(1), file.bytes(2), file.bytes(5)});
}

TEST(Memory, ReadingTakesNoMoreThanFourTimesTheFile) {
  const TestFolder folder;
  Array2 height(1024, 1024);
  for (Index i = 0; i < height.size(); ++i)
    height.data()[i] = 1e-6 * std::sin(static_cast<double>(i));
  const HeightMap map(CameraGrid{1024, 1024, 1.0 * um, 1.0 * um}, height);
  for (const char* name : {"a.gsf", "a.csv"}) {
    write_map(folder / name, map, "");
    const auto megabytes = std::filesystem::file_size(folder / name) >> 20;
    const MemoryLimit limit(4 * megabytes);
    EXPECT_NO_THROW(static_cast<void>(read_channels(folder / name))) << name;
  }
}

}  // namespace
}  // namespace manoscope::io

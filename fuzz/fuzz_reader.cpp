// One reader of map files under libFuzzer: fuzz_reader --reader=NAME CORPUS. See README.md.
#include <fmt/format.h>
#include <sys/mman.h>
#include <unistd.h>

#include <cfenv>
#include <cstdint>
#include <cstdlib>
#include <filesystem>
#include <string>
#include <string_view>

#include "fuzz/trial.hpp"
#include "manoscope/core/error.hpp"
#include "manoscope/io/file_units.hpp"

namespace manoscope::fuzz {
namespace {

[[noreturn]] void stop(const std::string& why) {
  fmt::print(stderr, "fuzz_reader: {}\n", why);
  std::abort();
}

/// The file in memory that holds one input after the other; readers open it by its name.
class InputFile {
 public:
  InputFile() : descriptor_(::memfd_create("map", 0)) {
    if (descriptor_ < 0) stop("no file in memory");
  }
  /// Under the number of this process: the one that reads HDF5 opens it, too.
  std::filesystem::path path() const {
    return fmt::format("/proc/{}/fd/{}", ::getpid(), descriptor_);
  }
  void fill(const std::uint8_t* bytes, std::size_t n_bytes) const {
    const bool done = ::ftruncate(descriptor_, 0) == 0 &&
                      ::pwrite(descriptor_, bytes, n_bytes, 0) == static_cast<ssize_t>(n_bytes);
    if (!done) stop("cannot write its input");
  }

 private:
  int descriptor_;
};

const io::Reader* chosen = nullptr;

/// Of the honest size of a refused file to its bytes: 8 where a byte may be a pixel; where bytes
/// are packed nobody knows how many a damaged file holds, and zlib packs up to 1032 into one.
double refused_ratio() {
  for (const char* packed : {"digital-surf", "hdf5", "keyence-vk", "matlab", "netcdf", "plux",
                             "tiff", "x3p", "zygo-datx"}) {
    if (chosen->name() == packed) return 8.0 * 1032.0;
  }
  return 8.0;
}

}  // namespace
}  // namespace manoscope::fuzz

extern "C" int LLVMFuzzerInitialize(int* argc, char*** argv) {
  using namespace manoscope;
  constexpr std::string_view kOption = "--reader=";
  for (int i = 1; i < *argc; ++i) {
    const std::string_view argument = (*argv)[i];
    if (!argument.starts_with(kOption)) continue;
    for (const io::Reader* reader : io::readers()) {
      if (reader->name() == argument.substr(kOption.size())) fuzz::chosen = reader;
    }
  }
  if (fuzz::chosen == nullptr) fuzz::stop("give --reader=NAME, one of `manoscope formats`");
  static_cast<void>(io::length_scale("um"));  // the table of units is loaded once, for all inputs
  return 0;
}

extern "C" int LLVMFuzzerTestOneInput(const std::uint8_t* bytes, std::size_t n_bytes) {
  using namespace manoscope;
  static const fuzz::InputFile file;
  file.fill(bytes, n_bytes);
  feenableexcept(FE_DIVBYZERO | FE_INVALID | FE_OVERFLOW);
  const fuzz::Trial trial =
      fuzz::read_in_every_way(file.path(), *fuzz::chosen, fuzz::refused_ratio());
  fedisableexcept(FE_ALL_EXCEPT);
  if (!trial.fault.empty()) fuzz::stop(trial.fault);
  return 0;
}

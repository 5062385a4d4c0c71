// manoscope-hdf5-reader FORMAT FILE MEMORY_BYTES CPU_SECONDS [OPTION=VALUE]...
//
// Parses one file of HDF5 and writes its channels, or the error, to standard output
// (channel_wire.hpp). Started by hdf5_worker.cpp; of no use to a person.
#include <fmt/format.h>
#include <signal.h>
#include <sys/prctl.h>
#include <sys/resource.h>
#include <unistd.h>

#include <cstdint>
#include <cstdlib>
#include <cstring>
#include <new>
#include <string>

#include "manoscope/core/error.hpp"
#include "manoscope/core/options.hpp"
#include "manoscope/io/channel_wire.hpp"
#include "manoscope/io/hdf5_file.hpp"
#include "manoscope/io/hdf5_formats.hpp"

namespace manoscope::io {
namespace {

constexpr int kUsage = 64, kNoReader = 65;

void limit(int what, rlim_t value) {
  const rlimit both{value, value};
  static_cast<void>(::setrlimit(static_cast<__rlimit_resource>(what), &both));
}

/// What this process may still do once a file has taken it over: compute for a while, in so much
/// memory, and write to the pipe. No file is made, none grows, no core is left behind.
void give_up_powers([[maybe_unused]] std::uintmax_t memory_bytes, int cpu_seconds) {
  ::prctl(PR_SET_PDEATHSIG, SIGKILL);
  ::prctl(PR_SET_NO_NEW_PRIVS, 1, 0, 0, 0);
  ::prctl(PR_SET_DUMPABLE, 0);
  limit(RLIMIT_CORE, 0);
  limit(RLIMIT_FSIZE, 0);
  limit(RLIMIT_CPU, static_cast<rlim_t>(cpu_seconds));
#if !defined(__SANITIZE_ADDRESS__)  // the sanitizer reserves address space as it pleases
  limit(RLIMIT_AS, memory_bytes);
#endif
}

void write_out(const void* bytes, std::size_t size) {
  const char* at = static_cast<const char*>(bytes);
  while (size > 0) {
    const ssize_t n = ::write(STDOUT_FILENO, at, size);
    if (n < 0 && errno == EINTR) continue;
    if (n <= 0) std::_Exit(kNoReader);  // nobody reads any more
    at += n;
    size -= static_cast<std::size_t>(n);
  }
}

bool made_by_netcdf(const std::filesystem::path& path) {
  const Hdf5File file(path);
  const auto names = file.attribute_names("");
  return std::find(names.begin(), names.end(), "_NCProperties") != names.end();
}

/// By what the file holds where that is plain, else as `format`, which its name suggested.
std::vector<Channel> parse(const std::string& format, const std::filesystem::path& path,
                           const ReadOptions& options) {
  if (format == "matlab") return parse_matlab_hdf5(path, options);
  if (is_zygo_datx(path)) return parse_zygo_datx(path, options);
  if (format == "zygo-datx") {
    throw InputError(path.string(), "is an HDF5 file without the surface of a .datx",
                     "Save it again in Mx; plain HDF5 goes by the name .h5");
  }
  if (format == "netcdf" || made_by_netcdf(path)) return parse_netcdf(path, options);
  return parse_hdf5(path, options);
}

int run(int argc, char** argv) {
  constexpr int kFirstOption = 5;
  if (argc < kFirstOption) return kUsage;
  const std::uintmax_t memory = std::strtoull(argv[3], nullptr, 10);
  give_up_powers(memory, std::atoi(argv[4]));
  ::signal(SIGPIPE, SIG_DFL);
  const std::string format = argv[1];
  const std::filesystem::path path = argv[2];
  try {
    ReadOptions options;
    for (int i = kFirstOption; i < argc; ++i) {
      const std::string word = argv[i];
      const auto equal = word.find('=');
      if (equal == std::string::npos) return kUsage;
      set_option(options, word.substr(0, equal), word.substr(equal + 1), word.substr(0, equal));
    }
    write_channels(parse(format, path, options), &write_out);
  } catch (const InputError& error) {
    write_error(error, &write_out);
  } catch (const std::bad_alloc&) {
    write_error(InputError(path.string(),
                           fmt::format("needs more than the {} MB of memory that a file of its "
                                       "size is given",
                                       memory >> 20U),
                           "The file is damaged, or packed beyond measure: store the map without "
                           "compression, or choose one with --channel or --page"),
                &write_out);
  }
  // Without the library's own tidying up, which can crash after a damaged file.
  std::_Exit(0);
}

}  // namespace
}  // namespace manoscope::io

int main(int argc, char** argv) {
  try {
    return manoscope::io::run(argc, argv);
  } catch (...) {
    return 1;
  }
}

#include "manoscope/io/hdf5_worker.hpp"

#include <fmt/format.h>
#include <signal.h>
#include <unistd.h>

#include <cstdlib>

#include "manoscope/core/child_process.hpp"
#include "manoscope/core/error.hpp"
#include "manoscope/core/options.hpp"
#include "manoscope/io/channel_wire.hpp"

namespace manoscope::io {
namespace {

namespace fs = std::filesystem;

constexpr const char* kProgram = "manoscope-hdf5-reader";
constexpr const char* kVariable = "MANOSCOPE_HDF5_READER";
constexpr const char* kDamaged =
    "The file is damaged or of an unusual layout: copy it again, or export the map in another "
    "format, e.g. as .gsf, .x3p or text";

bool can_run(const fs::path& path) {
  std::error_code error;
  return fs::is_regular_file(path, error) && ::access(path.c_str(), X_OK) == 0;
}

std::string seconds(double value) { return fmt::format("{:g} s", value); }

/// What became of a process that gave no whole answer.
std::string failure(const ChildEnd& end, const WorkerLimits& limits) {
  if (end.timed_out) {
    return fmt::format("the HDF5 library did not finish reading it in {}",
                       seconds(limits.wall_seconds));
  }
  if (end.signal == SIGXCPU) {
    return fmt::format("the HDF5 library spent more than {} of computing on it",
                       seconds(limits.cpu_seconds));
  }
  if (end.signal != 0) {
    return fmt::format("the HDF5 library failed on it (signal {})", end.signal);
  }
  return fmt::format("the HDF5 library failed on it (exit code {}, no whole answer)",
                     end.exit_code);
}

}  // namespace

WorkerLimits worker_limits(std::uintmax_t file_bytes) {
  constexpr std::uintmax_t kMemoryFloor = std::uintmax_t{1} << 30U, kTimesTheFile = 16;
  constexpr double kWallFloor = 60.0, kSlowestDisk = 5e6;      // s, bytes/s
  constexpr double kComputingFloor = 10.0, kUnpacking = 20e6;  // s, bytes of the file a second
  const auto size = static_cast<double>(file_bytes);
  return {kMemoryFloor + kTimesTheFile * file_bytes,
          static_cast<int>(kComputingFloor + size / kUnpacking), kWallFloor + size / kSlowestDisk};
}

fs::path find_hdf5_reader() {
  if (const char* named = std::getenv(kVariable); named != nullptr && *named != '\0') {
    if (can_run(named)) return named;
    throw InputError(kVariable, fmt::format("names \"{}\", which cannot be run", named),
                     fmt::format("Name the program {}, or unset the variable", kProgram));
  }
  std::error_code error;
  const fs::path folder = fs::read_symlink("/proc/self/exe", error).parent_path();
  for (const fs::path& candidate :
       {folder / kProgram, folder / ".." / "libexec" / "manoscope" / kProgram,
        fs::path(MANOSCOPE_HDF5_READER_INSTALLED), fs::path(MANOSCOPE_HDF5_READER_BUILT)}) {
    if (can_run(candidate)) return candidate;
  }
  throw InputError(kProgram, "the program that reads HDF5 files is not installed",
                   fmt::format("Install manoscope again as a whole, or name the program in the "
                               "environment variable {}",
                               kVariable));
}

std::vector<Channel> read_in_worker(std::string_view format, const fs::path& path,
                                    const ReadOptions& options,
                                    const std::optional<WorkerLimits>& given) {
  std::error_code error;
  const std::uintmax_t size = fs::file_size(path, error);
  if (error) throw InputError(path.string(), error.message(), "Check the name of the file");
  const WorkerLimits limits = given ? *given : worker_limits(size);
  std::vector<std::string> words{find_hdf5_reader().string(), std::string(format), path.string(),
                                 fmt::format("{}", limits.memory_bytes),
                                 fmt::format("{}", limits.cpu_seconds)};
  for (const OptionInfo& option : list_options(options)) {
    words.push_back(option.name + "=" + option.value);
  }
  ChildProcess::Options child;
  child.wall_seconds = limits.wall_seconds;
  // Reading asks for no lock, which some network disks refuse.
  child.environment = {"HDF5_USE_FILE_LOCKING=FALSE"};
  auto worker = ChildProcess::start(words, child);
  if (!worker) {
    throw InputError(words.front(), "cannot be started", "Check its permissions");
  }
  const WireSource source = [&](void* bytes, std::size_t n) {
    char* at = static_cast<char*>(bytes);
    while (n > 0) {
      const std::size_t n_read = worker->read(at, n);
      if (n_read == 0) throw BrokenAnswer("ends early");
      at += n_read;
      n -= n_read;
    }
  };
  try {
    return read_answer(source, limits.memory_bytes);
  } catch (const BrokenAnswer&) {
    // A wrong answer comes from a process that may go on talking; an early end from one that ended.
    char one_more = 0;
    if (worker->read(&one_more, 1) != 0) worker->kill();
    throw InputError(path.string(), failure(worker->wait(), limits), kDamaged);
  }
}

}  // namespace manoscope::io

#include "fuzz/trial.hpp"

#include <fmt/format.h>
#include <sys/resource.h>

#include <algorithm>
#include <chrono>
#include <functional>
#include <vector>

#include "fuzz/allocation_counter.hpp"
#include "manoscope/core/error.hpp"
#include "manoscope/io/map_summary.hpp"

namespace manoscope::fuzz {
namespace {

constexpr std::uint64_t kTimes = 4;

/// What is held whatever the size of the file: the window of the cursor and tables of the packers;
/// two buffers of 256 KiB and tables of libnetcdf; one tile of a TIFF file, 512 KiB.
std::uint64_t constant_bytes(const io::Reader& reader) {
  const std::uint64_t kib = reader.name() == "netcdf" ? 1024 : reader.name() == "tiff" ? 768 : 256;
  return kib << 10;
}

std::uint64_t bytes_of(const std::vector<io::Channel>& channels) {
  std::uint64_t bytes = 0;
  for (const io::Channel& channel : channels) {
    bytes += 8 * static_cast<std::uint64_t>(channel.values.size());
  }
  return bytes;
}

std::string fault_of(const std::vector<io::Channel>& channels) {
  if (channels.empty()) return "gives no channel and no error";
  for (const io::Channel& channel : channels) {
    const CameraGrid& grid = channel.grid;
    if (channel.values.rows() != grid.ny || channel.values.cols() != grid.nx || grid.nx < 1 ||
        grid.ny < 1) {
      return fmt::format("gives {} x {} values on a grid of {} x {}", channel.values.cols(),
                         channel.values.rows(), grid.nx, grid.ny);
    }
    if (grid.pitch_x < Length{} || grid.pitch_y < Length{}) return "gives a negative pitch";
  }
  return {};
}

std::string fault_of(const InputError& error, const std::filesystem::path& path) {
  // A file may lie in an archive: the archive is named first.
  if (!error.where().starts_with(path.string())) {
    return fmt::format("complains of \"{}\" instead of the file", error.where());
  }
  if (error.found().empty() || error.mend().empty()) {
    return fmt::format("complains without words: \"{}\"", error.what());
  }
  for (const char letter : error.found()) {
    if (static_cast<unsigned char>(letter) < 0x20) return "puts control codes into its message";
  }
  return {};
}

/// What the processes that ended so far have used.
struct WorkerUse {
  double seconds = 0.0;            ///< of computing, all together
  std::uintmax_t most_memory = 0;  ///< of the largest, bytes

  static WorkerUse so_far() {
    rusage use{};
    ::getrusage(RUSAGE_CHILDREN, &use);
    const auto seconds = [](const timeval& time) {
      return static_cast<double>(time.tv_sec) + 1e-6 * static_cast<double>(time.tv_usec);
    };
    return {seconds(use.ru_utime) + seconds(use.ru_stime),
            static_cast<std::uintmax_t>(use.ru_maxrss) << 10U};
  }
};

}  // namespace

bool is_hdf5(std::string_view head) {
  constexpr std::string_view kSignature = "\x89HDF\r\n\x1a\n";
  constexpr std::size_t kMatlabBlock = 512;
  return head.starts_with(kSignature) ||
         (head.size() > kMatlabBlock && head.substr(kMatlabBlock).starts_with(kSignature));
}

std::string worker_fault(double seconds, std::uintmax_t bytes, const io::WorkerLimits& limits) {
  constexpr double kStartAndEnd = 1.0;  // s; the system ends it on the first second beyond
  if (seconds > limits.cpu_seconds + kStartAndEnd) {
    return fmt::format("lets the process of HDF5 compute for {:.1f} s, allowed are {} s", seconds,
                       limits.cpu_seconds);
  }
  if (bytes > limits.memory_bytes) {
    return fmt::format("lets the process of HDF5 take {} bytes, allowed are {}", bytes,
                       limits.memory_bytes);
  }
  return {};
}

std::uint64_t honest_bytes(std::uint64_t file_bytes, std::uint64_t decoded_bytes,
                           double refused_ratio) {
  if (decoded_bytes > 0) return std::max(file_bytes, decoded_bytes);
  return static_cast<std::uint64_t>(static_cast<double>(file_bytes) * std::max(1.0, refused_ratio));
}

Trial read_in_every_way(const std::filesystem::path& path, const io::Reader& reader,
                        double refused_ratio) {
  Trial trial;
  const std::uint64_t file_bytes = std::filesystem::file_size(path);
  io::ReadOptions options;
  options.gwyddion = false;
  const io::WorkerLimits limits = io::worker_limits(file_bytes);
  bool time_is_up = false;
  std::uint64_t constant = constant_bytes(reader);
  const auto attempt = [&](const char* way, const std::function<std::uint64_t()>& read) {
    if (!trial.fault.empty() || time_is_up) return;
    const WorkerUse before = WorkerUse::so_far();
    const auto start = std::chrono::steady_clock::now();
    AllocationCounter::restart();
    std::uint64_t decoded = 0;
    bool refused = false;
    try {
      decoded = read();
    } catch (const InputError& error) {
      refused = true;
      trial.fault = fault_of(error, path);
    } catch (const std::exception& error) {
      trial.fault = fmt::format("throws what is no InputError: {}", error.what());
    }
    const auto peak =
        static_cast<std::uint64_t>(std::max<std::int64_t>(0, AllocationCounter::peak()));
    const WorkerUse after = WorkerUse::so_far();
    const double seconds = after.seconds - before.seconds;
    // The system tells the largest of all processes only: one that is no larger hides behind it.
    const bool larger = after.most_memory > before.most_memory;
    if (trial.fault.empty()) {
      trial.fault = worker_fault(seconds, larger ? after.most_memory : 0, limits);
    }
    const std::chrono::duration<double> waited = std::chrono::steady_clock::now() - start;
    // On a busy machine the clock ends a process first.
    time_is_up = seconds > 0.9 * limits.cpu_seconds || waited.count() > 0.9 * limits.wall_seconds;
    // What its reader made of it justifies the memory of the other ways, too.
    const std::uint64_t honest =
        std::max(trial.decoded, honest_bytes(file_bytes, refused ? 0 : decoded, refused_ratio));
    const std::uint64_t limit = kTimes * honest + constant;
    if (trial.fault.empty() && peak > limit) {
      trial.fault = fmt::format("holds {} bytes at a time, allowed are {} (4 x {} + {})", peak,
                                limit, honest, constant);
    }
    if (!trial.fault.empty()) trial.fault = fmt::format("{} {}", way, trial.fault);
    if (peak > trial.peak) {
      trial.peak = peak;
      trial.limit = limit;
    }
  };
  const auto check = [&](const std::vector<io::Channel>& channels) {
    trial.fault = fault_of(channels);
    return bytes_of(channels);
  };
  attempt("the reader", [&] {
    const std::uint64_t decoded = check(reader.read(path, options));
    trial.was_read = true;
    trial.decoded = honest_bytes(file_bytes, decoded, 1.0);
    return decoded;
  });
  // The damage may have made it a file of another format.
  attempt("find_reader()", [&] {
    constant = std::max(constant, constant_bytes(io::find_reader(path)));
    return std::uint64_t{0};
  });
  attempt("read_channels()", [&] {
    const auto channels = io::read_channels(path, options);
    for (const io::Channel& channel : channels) static_cast<void>(io::summarise(channel));
    return check(channels);
  });
  attempt("read_height_map()", [&] {
    const HeightMap map = io::read_height_map(path, options);
    return 9 * static_cast<std::uint64_t>(map.height().size());
  });
  return trial;
}

}  // namespace manoscope::fuzz

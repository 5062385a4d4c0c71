// Damaged files of every format: whatever the bytes, a map or an InputError comes out, soon, and
// without more memory than the file can justify. See README.md.
//
// File number i of a run depends on the seed and i alone. Child processes read the files, so that
// a crash or an endless loop costs one file: the parent saves it and goes on with the next.
#include <fmt/format.h>
#include <sys/mman.h>
#include <sys/wait.h>
#include <unistd.h>

#include <CLI/CLI.hpp>
#include <atomic>
#include <cfenv>
#include <chrono>
#include <cmath>
#include <cstdio>
#include <cstring>
#include <fstream>
#include <map>
#include <thread>

#include "fuzz/allocation_counter.hpp"
#include "fuzz/mutation.hpp"
#include "fuzz/seeds.hpp"
#include "fuzz/trial.hpp"
#include "manoscope/core/error.hpp"
#include "manoscope/io/file_units.hpp"
#include "manoscope/io/hdf5_worker.hpp"
#include "manoscope/io/test_bytes.hpp"

namespace manoscope::fuzz {
namespace {

namespace fs = std::filesystem;
using Clock = std::chrono::steady_clock;

struct Settings {
  std::uint64_t n_files = 5000, seed = 20240607, first = 0;
  unsigned n_jobs = 1;
  double seconds_per_file = 20.0;
  std::string reader;  ///< "" = all
  fs::path maps = MANOSCOPE_SHARED_DIR "/data/maps", findings = "fuzz-findings", replay,
           write_seeds;
};

constexpr std::size_t kMostReaders = 64;

/// What a child tells its parent, in memory that both see.
struct Shared {
  std::atomic<std::uint64_t> next{0};  ///< the file that is being read, or comes next
  char fault[500] = {};
  struct PerReader {
    std::uint64_t n_read = 0, n_refused = 0;
    double worst_memory = 0.0;  ///< peak over limit
    double worst_seconds = 0.0;
  } readers[kMostReaders];
};

double seconds_since(Clock::time_point start) {
  return std::chrono::duration<double>(Clock::now() - start).count();
}

/// A folder of this process, removed with everything in it.
class ScratchFolder {
 public:
  ScratchFolder()
      : path_(fs::temp_directory_path() / fmt::format("manoscope_mutations_{}", ::getpid())) {
    fs::create_directories(path_);
  }
  ~ScratchFolder() {
    std::error_code ignored;
    fs::remove_all(path_, ignored);
  }
  ScratchFolder(const ScratchFolder&) = delete;
  ScratchFolder& operator=(const ScratchFolder&) = delete;
  const fs::path& path() const { return path_; }

 private:
  fs::path path_;
};

void write(const fs::path& path, const std::string& bytes) {
  std::ofstream out(path, std::ios::binary);
  out.write(bytes.data(), static_cast<std::streamsize>(bytes.size()));
  out.close();
  if (!out) throw InputError(path.string(), "cannot be written", "Check the free space");
}

/// Floating-point faults trap while a reader works, as in every test of the project.
void trap_floating_point_faults() { feenableexcept(FE_DIVBYZERO | FE_INVALID | FE_OVERFLOW); }

class Campaign {
 public:
  Campaign(const Settings& settings, std::vector<Seed> seeds)
      : settings_(settings), seeds_(std::move(seeds)) {
    for (std::size_t i = 0; i < seeds_.size(); ++i) {
      const std::string name(seeds_[i].reader->name());
      if (!settings_.reader.empty() && name != settings_.reader) continue;
      // What goes to the process of HDF5 takes turns of its own: it is slower by far.
      by_group_[seeds_[i].by_worker ? name + " (HDF5)" : name].push_back(i);
    }
    for (const auto& [name, which] : by_group_) names_.push_back(name);
    for (int round = 0; round < kTurns; ++round) {
      for (std::size_t group = 0; group < names_.size(); ++group) {
        const bool slow = seeds_[by_group_.at(names_[group]).front()].by_worker;
        if (!slow || round == 0) turns_.push_back(group);
      }
    }
    if (names_.empty()) {
      throw InputError("--reader", settings_.reader + " is no reader",
                       "`manoscope formats` lists them");
    }
  }

  struct File {
    const Seed* seed = nullptr;
    std::size_t group = 0;  ///< place in `names_`
    std::string bytes;
  };

  /// Damaged file number `i`. All readers take turns, those in HDF5 one where others take kTurns;
  /// seeds above 64 KiB, which take as long as many small ones, are taken for one file in twelve.
  File make(std::uint64_t i) const {
    RandomStream random(settings_.seed, "mutations", i);
    File file;
    file.group = turns_[i % turns_.size()];
    const std::vector<std::size_t>& own = by_group_.at(names_[file.group]);
    const auto pick = [&] {
      constexpr std::size_t kLarge = 65536;
      const bool large = random.below(12) == 0;
      for (int attempt = 0; attempt < 20; ++attempt) {
        const std::size_t which =
            own[static_cast<std::size_t>(random.below(static_cast<Index>(own.size())))];
        if (large || seeds_[which].bytes.size() < kLarge) return which;
      }
      return own.front();
    };
    const Seed& seed = seeds_[pick()];
    // The other file of a splice is of the same format, or of any.
    const Seed& other =
        random.below(4) > 0
            ? seeds_[pick()]
            : seeds_[static_cast<std::size_t>(random.below(static_cast<Index>(seeds_.size())))];
    file.seed = &seed;
    if (seed.parts.empty()) {
      file.bytes = mutated(seed.bytes, other.bytes, random);
      return file;
    }
    auto parts = seed.parts;
    auto& part = parts[static_cast<std::size_t>(random.below(static_cast<Index>(parts.size())))];
    part.second = mutated(part.second, seed.bytes, random);
    file.bytes = seed.with(parts);
    return file;
  }

  /// @return number of files with a fault.
  int run() {
    measure_seeds();
    const std::size_t n_jobs = std::max(1U, settings_.n_jobs);
    void* memory = ::mmap(nullptr, n_jobs * sizeof(Shared), PROT_READ | PROT_WRITE,
                          MAP_SHARED | MAP_ANONYMOUS, -1, 0);
    if (memory == MAP_FAILED) throw InternalError("no shared memory");
    jobs_.resize(n_jobs);
    for (std::size_t job = 0; job < n_jobs; ++job) {
      jobs_[job].shared = new (static_cast<Shared*>(memory) + job) Shared;
      jobs_[job].shared->next = settings_.first + job;
      start(job);
    }
    while (std::any_of(jobs_.begin(), jobs_.end(), [](const Job& job) { return job.pid > 0; })) {
      std::this_thread::sleep_for(std::chrono::milliseconds(20));
      for (std::size_t job = 0; job < n_jobs; ++job) watch(job);
      show_progress();
    }
    report();
    ::munmap(memory, n_jobs * sizeof(Shared));
    return n_faults_;
  }

 private:
  struct Job {
    Shared* shared = nullptr;
    pid_t pid = 0;
    std::uint64_t seen = 0;
    Clock::time_point since{};
  };

  static constexpr int kTurns = 4;

  /// A file of HDF5 has the clock of its own process as well, which ends at io::worker_limits().
  double seconds_allowed(std::uint64_t i) const {
    const File file = make(i);
    const double more = is_hdf5(file.bytes) ? io::worker_limits(file.bytes.size()).wall_seconds : 0;
    return settings_.seconds_per_file + more;
  }

  std::uint64_t end() const { return settings_.first + settings_.n_files; }

  /// What the undamaged files hold is what damaged ones may hold before they are refused.
  void measure_seeds() {
    const ScratchFolder scratch;
    for (const Seed& seed : seeds_) {
      const fs::path path = scratch.path() / seed.name;
      write(path, seed.bytes);
      const Trial trial = read_in_every_way(path, *seed.reader, 1.0);
      if (!trial.fault.empty()) {
        fmt::print(stderr, "undamaged {} ({}): {}\n", seed.name, seed.reader->name(), trial.fault);
        ++n_faults_;
      }
      if (trial.fault.empty() && seed.made_here && !trial.was_read) {
        fmt::print(stderr, "undamaged {} ({}): refused\n", seed.name, seed.reader->name());
        ++n_faults_;
      }
      ratio_[&seed] = trial.was_read ? static_cast<double>(trial.decoded) /
                                           static_cast<double>(seed.bytes.size())
                                     : 1.0;
    }
  }

  void start(std::size_t which) {
    Job& job = jobs_[which];
    std::fflush(nullptr);
    job.since = Clock::now();
    job.seen = job.shared->next;
    job.pid = ::fork();
    if (job.pid < 0) throw InternalError("fork failed");
    if (job.pid == 0) {
      int code = 4;
      try {
        code = read_files(*job.shared);
      } catch (const std::exception& error) {
        std::snprintf(job.shared->fault, sizeof(Shared::fault), "the run itself: %s", error.what());
      }
      std::_Exit(code);
    }
  }

  /// The child's part. @return 0 when all files are read, 3 after one with a fault.
  int read_files(Shared& shared) const {
    const ScratchFolder scratch;
    while (shared.next < end()) {
      const File file = make(shared.next);
      const fs::path path = scratch.path() / file.seed->name;
      write(path, file.bytes);
      const auto start = Clock::now();
      trap_floating_point_faults();
      const Trial trial = read_in_every_way(path, *file.seed->reader, ratio_.at(file.seed));
      fedisableexcept(FE_ALL_EXCEPT);
      Shared::PerReader& sums = shared.readers[file.group];
      sums.worst_seconds = std::max(sums.worst_seconds, seconds_since(start));
      if (trial.limit > 0) {
        sums.worst_memory = std::max(
            sums.worst_memory, static_cast<double>(trial.peak) / static_cast<double>(trial.limit));
      }
      ++(trial.was_read ? sums.n_read : sums.n_refused);
      fs::remove(path);
      if (!trial.fault.empty()) {
        std::snprintf(shared.fault, sizeof shared.fault, "%s", trial.fault.c_str());
        return 3;
      }
      shared.next += jobs_.size();
    }
    return 0;
  }

  void watch(std::size_t which) {
    Job& job = jobs_[which];
    if (job.pid == 0) return;
    int status = 0;
    if (::waitpid(job.pid, &status, WNOHANG) == job.pid) {
      fs::remove_all(fs::temp_directory_path() / fmt::format("manoscope_mutations_{}", job.pid));
      job.pid = 0;
      if (WIFEXITED(status) && WEXITSTATUS(status) == 0) return;
      const std::string told = job.shared->fault;
      save(job.shared->next,
           !told.empty() ? told
           : WIFSIGNALED(status)
               ? fmt::format("ends by signal {}", WTERMSIG(status))
               : fmt::format("ends the program with code {}", WEXITSTATUS(status)));
      go_on(which);
    } else if (job.seen != job.shared->next) {
      job.seen = job.shared->next;
      job.since = Clock::now();
    } else if (const double seconds = seconds_since(job.since);
               seconds > settings_.seconds_per_file && seconds > seconds_allowed(job.seen)) {
      ::kill(job.pid, SIGKILL);
      ::waitpid(job.pid, &status, 0);
      fs::remove_all(fs::temp_directory_path() / fmt::format("manoscope_mutations_{}", job.pid));
      job.pid = 0;
      save(job.seen, fmt::format("takes more than {:g} s", seconds_allowed(job.seen)));
      go_on(which);
    }
  }

  void go_on(std::size_t which) {
    constexpr int kMostFaults = 100;
    jobs_[which].shared->fault[0] = '\0';
    jobs_[which].shared->next += jobs_.size();
    if (n_faults_ < kMostFaults) start(which);
  }

  void save(std::uint64_t i, const std::string& fault) {
    ++n_faults_;
    const File file = make(i);
    const std::string reader(file.seed->reader->name());
    const fs::path folder = settings_.findings / reader;
    const fs::path path = folder / fmt::format("{}-{}-{}", settings_.seed, i, file.seed->name);
    fs::create_directories(folder);
    write(path, file.bytes);
    fmt::print(stderr, "\r\033[K{}: {}\n  again: mutate_maps --replay {}\n", reader, fault,
               path.string());
  }

  void show_progress() {
    if (::isatty(STDERR_FILENO) == 0) return;
    std::uint64_t n_done = 0;
    for (const Job& job : jobs_) n_done += (job.shared->next - settings_.first) / jobs_.size();
    fmt::print(stderr, "\r{} of {} files, {} faults", std::min(n_done, settings_.n_files),
               settings_.n_files, n_faults_);
  }

  void report() const {
    if (::isatty(STDERR_FILENO) != 0) fmt::print(stderr, "\r\033[K");
    fmt::print("{:18} {:>8} {:>8} {:>16} {:>10}\n", "reader", "read", "refused", "memory of limit",
               "slowest s");
    std::uint64_t n_read = 0, n_refused = 0;
    for (std::size_t i = 0; i < names_.size(); ++i) {
      Shared::PerReader sum;
      for (const Job& job : jobs_) {
        const Shared::PerReader& part = job.shared->readers[i];
        sum.n_read += part.n_read;
        sum.n_refused += part.n_refused;
        sum.worst_memory = std::max(sum.worst_memory, part.worst_memory);
        sum.worst_seconds = std::max(sum.worst_seconds, part.worst_seconds);
      }
      n_read += sum.n_read;
      n_refused += sum.n_refused;
      fmt::print("{:18} {:8} {:8} {:16.2f} {:10.3f}\n", names_[i], sum.n_read, sum.n_refused,
                 sum.worst_memory, sum.worst_seconds);
    }
    fmt::print("{} files read, {} refused, {} faults; seed {}\n", n_read, n_refused, n_faults_,
               settings_.seed);
    std::fflush(stdout);
  }

  Settings settings_;
  std::vector<Seed> seeds_;
  std::map<std::string, std::vector<std::size_t>> by_group_;
  std::vector<std::string> names_;  ///< of the groups
  std::vector<std::size_t> turns_;  ///< group of file 0, 1, ...; then from the beginning again
  std::map<const Seed*, double> ratio_;
  std::vector<Job> jobs_;
  int n_faults_ = 0;
};

/// Reads one saved file again, in this process: a debugger sees what happens.
int replay(const Settings& settings) {
  const fs::path& path = settings.replay;
  const std::string folder = path.parent_path().filename().string();
  const std::string name = settings.reader.empty() ? folder : settings.reader;
  for (const io::Reader* reader : io::readers()) {
    if (reader->name() != name) continue;
    trap_floating_point_faults();
    const Trial trial = read_in_every_way(path, *reader, 1.0);
    fmt::print("{}: {}, {} bytes held at a time of {} allowed; {}\n", path.string(),
               trial.was_read ? "read" : "refused", trial.peak, trial.limit,
               trial.fault.empty() ? "no fault" : trial.fault);
    return trial.fault.empty() ? 0 : 1;
  }
  throw InputError(path.string(), fmt::format("\"{}\" is no reader", name),
                   "Name its reader with --reader");
}

/// Every seed as a file in the folder of its reader: the corpus that libFuzzer starts from.
int write_seeds(const Settings& settings, const std::vector<Seed>& seeds) {
  for (std::size_t i = 0; i < seeds.size(); ++i) {
    const fs::path folder = settings.write_seeds / seeds[i].reader->name();
    fs::create_directories(folder);
    write(folder / fmt::format("{:03}-{}", i, seeds[i].name), seeds[i].bytes);
  }
  return 0;
}

int run(const Settings& settings) {
  if (!AllocationCounter::works()) throw InternalError("allocations are not counted");
  static_cast<void>(io::length_scale("um"));  // the table of units is loaded once, for all files
  if (!settings.replay.empty()) return replay(settings);
  const ScratchFolder scratch;
  std::vector<Seed> seeds = all_seeds(scratch.path(), settings.maps);
  if (!settings.write_seeds.empty()) return write_seeds(settings, seeds);
  return Campaign(settings, std::move(seeds)).run() == 0 ? 0 : 1;
}

}  // namespace
}  // namespace manoscope::fuzz

int main(int argc, char** argv) {
  manoscope::fuzz::Settings settings;
  CLI::App app("Reads damaged map files of every format; exit code 1 after a fault");
  app.add_option("--files", settings.n_files, "how many")->capture_default_str();
  app.add_option("--seed", settings.seed, "of the damages")->capture_default_str();
  app.add_option("--first", settings.first, "number of the first file")->capture_default_str();
  app.add_option("--jobs", settings.n_jobs, "processes")->capture_default_str();
  app.add_option("--seconds-per-file", settings.seconds_per_file, "limit")->capture_default_str();
  app.add_option("--reader", settings.reader, "this one alone");
  app.add_option("--maps", settings.maps, "folder of undamaged files")->capture_default_str();
  app.add_option("--findings", settings.findings, "where to save files with a fault")
      ->capture_default_str();
  app.add_option("--replay", settings.replay, "read this saved file again, and nothing else");
  app.add_option("--write-seeds", settings.write_seeds, "write the undamaged files here and stop");
  CLI11_PARSE(app, argc, argv);
  try {
    return manoscope::fuzz::run(settings);
  } catch (const std::exception& error) {
    fmt::print(stderr, "mutate_maps: {}\n", error.what());
    return 2;
  }
}

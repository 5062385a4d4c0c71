#pragma once

#include <cstdint>
#include <filesystem>
#include <optional>
#include <string>
#include <string_view>
#include <vector>

#include "manoscope/io/reader.hpp"

namespace manoscope::io {

// Files of HDF5 are parsed in a process of their own, one a file: the HDF5 library crashes on some
// damaged files, and a crash there must end no measurement. The process is the small program
// `manoscope-hdf5-reader`; it gives itself limits before it opens the file, and answers with
// channels or an InputError over a pipe (channel_wire.hpp). See docs/decisions/0002-hdf5-reader.md.

/// What one process may use.
struct WorkerLimits {
  std::uintmax_t memory_bytes = 0;  ///< of address space
  int cpu_seconds = 0;
  double wall_seconds = 0.0;
};

/// Generous for any honest file of that size: the file and its values as doubles several times
/// over on top of a floor of 1 GiB, which is room for a packed map of 50 million pixels; 10 s of
/// computing and 1 s more for 20 MB; 60 s on the clock and the time to fetch the file at 5 MB/s.
WorkerLimits worker_limits(std::uintmax_t file_bytes);

/// The program that reads HDF5 files: the one that the environment variable MANOSCOPE_HDF5_READER
/// names, else beside the running program, in ../libexec/manoscope from there, where this library
/// was installed, or where it was built.
/// @throws InputError if none of them is there.
std::filesystem::path find_hdf5_reader();

/// Every channel of a file, parsed by another process as `format`: "netcdf", "zygo-datx", "matlab"
/// or "hdf5".
///
/// Safe to call from several threads at once; each call has its own process.
/// @throws InputError of the reader itself; or naming the file, if the process crashed, was killed,
///         took too long or gave no answer.
std::vector<Channel> read_in_worker(std::string_view format, const std::filesystem::path& path,
                                    const ReadOptions& options,
                                    const std::optional<WorkerLimits>& limits = std::nullopt);

}  // namespace manoscope::io

#pragma once

#include <cstdint>
#include <filesystem>
#include <string>
#include <string_view>

#include "manoscope/io/hdf5_worker.hpp"
#include "manoscope/io/reader.hpp"

namespace manoscope::fuzz {

/// True for a file of HDF5: its signature stands in front, or behind the 512 bytes that MATLAB puts
/// before it. Such files are parsed by a process of their own, for libhdf5 crashes on some damaged
/// ones; what is held here is that this process outlives that and hears an InputError.
///
/// @param head  the first 520 bytes at least.
bool is_hdf5(std::string_view head);

/// What became of one file, read in every way the program has.
struct Trial {
  bool was_read = false;      ///< by its reader; else refused by an InputError
  std::string fault;          ///< what a reader must not do; "" if all was well
  std::uint64_t decoded = 0;  ///< honest bytes, where it was read: see honest_bytes()
  std::uint64_t peak = 0;     ///< the most that any of the ways held from the allocator
  std::uint64_t limit = 0;    ///< that was allowed
};

/// The memory that a file can justify: its own bytes or, if that is more, 8 bytes a pixel of every
/// channel that was made of it.
///
/// A refused file has no channels to count; it is granted `refused_ratio` times its bytes: what the
/// undamaged file has, at least 1.
std::uint64_t honest_bytes(std::uint64_t file_bytes, std::uint64_t decoded_bytes,
                           double refused_ratio);

/// What is wrong with what one process of HDF5 used, "" if it stayed within its limits.
/// @param seconds  of computing.
/// @param bytes    of memory at a time.
std::string worker_fault(double seconds, std::uintmax_t bytes, const io::WorkerLimits& limits);

/// Reads a file by `reader`, then as the program would: registry, summary, height map.
///
/// A fault is any exception but an InputError; an InputError that does not name the file, or lacks
/// what was found or what to do; a channel whose values do not fit its grid; or more memory at a
/// time than 4 times the honest bytes plus a constant: 256 KiB; 1 MiB for NetCDF, whose library has
/// buffers; 768 KiB for TIFF, of which one tile may take 512 KiB. Of the process that parses HDF5:
/// more memory or computing than io::worker_limits() grants it, one second for its start and end
/// left out. Where it used up its time once it is not asked again.
///
/// The program Gwyddion is left out of it: what it makes of a damaged file is not ours to hold.
Trial read_in_every_way(const std::filesystem::path& path, const io::Reader& reader,
                        double refused_ratio);

}  // namespace manoscope::fuzz

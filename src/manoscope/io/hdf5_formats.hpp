#pragma once

#include <filesystem>
#include <vector>

#include "manoscope/io/reader.hpp"

namespace manoscope::io {

// The parsers of formats built on HDF5, in the process that calls them. Only the program
// manoscope-hdf5-reader calls them on files of users; the readers of the registry go through it
// (hdf5_worker.hpp). All but the first are linked into that program alone.

/// NetCDF of either kind. Classic files are safe anywhere.
std::vector<Channel> parse_netcdf(const std::filesystem::path& path, const ReadOptions& options);

/// Zygo Mx (.datx).
std::vector<Channel> parse_zygo_datx(const std::filesystem::path& path, const ReadOptions& options);
bool is_zygo_datx(const std::filesystem::path& path);

/// Arrays of plain HDF5, or of MATLAB's version 7.3.
std::vector<Channel> parse_hdf5(const std::filesystem::path& path, const ReadOptions& options);
std::vector<Channel> parse_matlab_hdf5(const std::filesystem::path& path,
                                       const ReadOptions& options);

}  // namespace manoscope::io

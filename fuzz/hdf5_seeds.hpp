#pragma once

#include <filesystem>
#include <string>
#include <utility>
#include <vector>

namespace manoscope::fuzz {

/// Small sound files of HDF5 under the names that lead to each of the readers: a `.datx`, a MATLAB
/// file of version 7.3, a plain one with its heights in a row of bytes, and one with them packed in
/// chunks and a series of frames beside them.
///
/// The object headers are of the old kind, which has no checksums: what is damaged is met by the
/// parsers and not refused at the door.
///
/// @param scratch  folder to write them in.
/// @return name of the reader and path of each.
std::vector<std::pair<std::string, std::filesystem::path>> write_hdf5_seeds(
    const std::filesystem::path& scratch);

}  // namespace manoscope::fuzz

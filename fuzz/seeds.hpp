#pragma once

#include <filesystem>
#include <functional>
#include <string>
#include <utility>
#include <vector>

#include "manoscope/io/reader.hpp"

namespace manoscope::fuzz {

/// An undamaged file from which damaged ones are made.
struct Seed {
  const io::Reader* reader = nullptr;
  std::string name;  ///< of the file, as its extension matters to some readers
  std::string bytes;
  /// Name and content of the files of a zip archive, or of the zlib streams of a file. Where there
  /// are any, a mutation damages one of them and packs all again: the checksums of the archive
  /// would refuse every other wound.
  std::vector<std::pair<std::string, std::string>> parts;
  std::string prefix;  ///< what stands before the archive
  /// Packs `parts` again where the file is no zip archive.
  std::function<std::string(const std::vector<std::pair<std::string, std::string>>&)> pack;
  bool by_worker = false;  ///< parsed in a process of its own, and so taken less often
  bool made_here = true;   ///< so that its reader must read it

  /// The file with these in place of its parts.
  std::string with(const std::vector<std::pair<std::string, std::string>>& other_parts) const;
};

/// Small files written here for every reader of the registry, then the maps of a folder that are of
/// at most 4 MiB (none where the folder is absent).
///
/// @param scratch  an empty folder for the files of our own writers.
std::vector<Seed> all_seeds(const std::filesystem::path& scratch,
                            const std::filesystem::path& maps);

}  // namespace manoscope::fuzz

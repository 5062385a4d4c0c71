#pragma once

#include <cstdint>
#include <map>
#include <string>
#include <vector>

#include "manoscope/serve/folder.hpp"

namespace manoscope::serve {

/// One name in a folder.
struct Entry {
  std::string name;
  bool is_folder = false;
  std::uint64_t size = 0;
  double modified = 0.0;  ///< Unix time, s
};

/// What a folder beneath the served one holds, folders first, then by name. Left out: hidden names,
/// what is neither file nor folder, links that lead out of the served folder.
/// @param most  no more than so many, the rest is left out.
std::vector<Entry> list_folder(const Folder& folder, const std::string& relative, std::size_t most);

/// Every file beneath, by its relative path, down to six levels; links to folders are not followed.
/// Of more than 5000 files those that make an experiment or a result are told all the same, and the
/// rest from the top down.
struct Scan {
  struct File {
    std::uint64_t size = 0;
    double modified = 0.0;

    friend bool operator==(const File&, const File&) = default;
  };
  std::map<std::string, File> files;
  bool truncated = false;  ///< there is more than a scan takes
};
Scan scan(const Folder& folder);

/// The files that two scans tell apart: made, changed or gone.
std::vector<std::string> changed_files(const Scan& before, const Scan& after);

}  // namespace manoscope::serve

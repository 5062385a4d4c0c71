#pragma once

#include <filesystem>
#include <map>
#include <optional>
#include <string>
#include <vector>

#include "manoscope/experiment/file_texts.hpp"
#include "manoscope/io/faults.hpp"

namespace manoscope::experiment {

/// Finds the files an experiment names and sees that they can be read; what they hold is for the
/// readers to say.
class MapFiles {
 public:
  explicit MapFiles(std::filesystem::path folder, const FileTexts& instead)
      : folder_(std::move(folder)), instead_(&instead) {}

  /// The path of a map, relative to the experiment's folder; where nothing is there, relative to
  /// the list that names it. `FILE#n` names the n-th page of a file and stays in the path.
  /// @return A path in any case; with a fault at `place` added if it is no readable file.
  std::filesystem::path find(const std::string& name, const io::Place& place, io::Faults& faults);

  /// One spelling per file on disk, and per page of it, to tell one that is named twice.
  static std::string identity(const std::filesystem::path& path);

  /// The text that stands in for a file, nullptr if it is read from the disk.
  const std::string* text_instead(const std::filesystem::path& path) const;

 private:
  std::string suggest(const std::filesystem::path& path);

  std::filesystem::path folder_;
  const FileTexts* instead_;
  std::map<std::filesystem::path, std::vector<std::string>> listings_;
  int n_missing_ = 0;
};

/// The whole of a file.
/// @return nullopt, with a fault added, if it is not there, a folder, too large or unreadable.
std::optional<std::string> read_file(const std::filesystem::path& path, const io::Place& place,
                                     io::Faults& faults);

}  // namespace manoscope::experiment

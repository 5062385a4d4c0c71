#pragma once

#include <filesystem>
#include <string>
#include <string_view>
#include <vector>

#include "manoscope/core/error.hpp"

namespace manoscope::io {

/// Where a fault stands: "experiment.toml:4: channel.height".
struct Place {
  std::filesystem::path file;
  int line = 0;     ///< 1-based; 0 = the file as a whole
  std::string key;  ///< "channel.height", or the column of a list; may be empty

  std::string text() const;
};

/// Collects the faults of one folder or file, so that all of them are told at once.
class Faults {
 public:
  void add(Place place, std::string found, std::string mend);
  bool empty() const { return faults_.empty(); }
  std::size_t size() const { return faults_.size(); }

  /// Told in the order of the files' names as `first` and the rest as they came up, and within a
  /// file by line.
  /// @throws InputErrors if there is any fault.
  void throw_if_any(const std::filesystem::path& first) const;

 private:
  struct Fault {
    Place place;
    std::string found, mend;
  };
  std::vector<Fault> faults_;
};

/// "text" in quotes for a message, control characters shown as '?', long texts cut short.
std::string in_quotes(std::string_view text);

}  // namespace manoscope::io

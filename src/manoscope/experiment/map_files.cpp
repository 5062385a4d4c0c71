#include "manoscope/experiment/map_files.hpp"

#include <fmt/format.h>
#include <unistd.h>

#include <algorithm>
#include <fstream>
#include <iterator>
#include <system_error>

#include "manoscope/core/suggest.hpp"
#include "manoscope/io/map_address.hpp"

namespace manoscope::experiment {
namespace {

namespace fs = std::filesystem;

bool is_there(const fs::path& path) {
  std::error_code error;
  return fs::exists(path, error);
}

/// What keeps `path` from being a readable file that is not empty, "" if nothing does.
std::string obstacle(const fs::path& path) {
  std::error_code error;
  const fs::file_status status = fs::status(path, error);
  if (status.type() == fs::file_type::not_found) return "there is no such file";
  if (error) return "the path cannot be followed (" + error.message() + ")";
  if (fs::is_directory(status)) return "it is a folder, not a file";
  if (!fs::is_regular_file(status)) return "it is no ordinary file";
  if (::access(path.c_str(), R_OK) != 0) return "the file cannot be opened";
  if (fs::file_size(path, error) == 0) return "the file is empty";
  return "";
}

}  // namespace

fs::path MapFiles::find(const std::string& name, const io::Place& place, io::Faults& faults) {
  if (name.find('\0') != std::string::npos) {
    faults.add(place, "a file name with a zero byte", "Write the name of a map");
    return folder_;
  }
  fs::path named = folder_ / fs::path(name);
  if (text_instead(named) != nullptr) return named;
  if (!is_there(io::map_address(named).file)) {
    const fs::path beside = place.file.parent_path() / fs::path(name);
    if (is_there(io::map_address(beside).file)) named = beside;
  }
  const fs::path path = io::map_address(named).file;  // of FILE#n, the file
  const std::string trouble = obstacle(path);
  if (trouble.empty()) return named;
  std::string mend = "Check the file and its read permission";
  if (!is_there(path)) {
    mend = name.find('\\') != std::string::npos
               ? "Write paths with / and relative to the experiment's folder"
               : "Check the name; paths are relative to the experiment's folder" + suggest(path);
  } else if (trouble.find("empty") != std::string::npos) {
    mend = "Copy it here again, or name another";
  } else if (trouble.find("folder") != std::string::npos) {
    mend = "Name the file inside, with its extension";
  }
  faults.add(place, fmt::format("{}: {}", io::in_quotes(name), trouble), mend);
  return named;
}

const std::string* MapFiles::text_instead(const fs::path& path) const {
  const auto found = instead_->find(path.lexically_normal());
  return found == instead_->end() ? nullptr : &found->second;
}

std::string MapFiles::suggest(const fs::path& path) {
  constexpr int kMostSuggestions = 50;  // of a list with all names wrong, these show the pattern
  constexpr std::size_t kMostNames = 2000;
  if (++n_missing_ > kMostSuggestions) return "";
  const fs::path folder = path.parent_path();
  auto [listing, fresh] = listings_.try_emplace(folder);
  if (fresh) {
    std::error_code error;
    for (fs::directory_iterator it(folder, error), end; !error && it != end; it.increment(error)) {
      if (listing->second.size() == kMostNames) break;
      listing->second.push_back(it->path().filename().string());
    }
    // The order of a folder is the disk's: the same answer on every machine needs another.
    std::sort(listing->second.begin(), listing->second.end());
  }
  return did_you_mean(path.filename().string(), listing->second);
}

std::string MapFiles::identity(const fs::path& path) {
  const auto [file, page] = io::map_address(path);
  std::error_code error;
  const fs::path canonical = fs::canonical(file, error);
  const std::string name = (error ? file.lexically_normal() : canonical).string();
  return page == 0 ? name : fmt::format("{}#{}", name, page);
}

std::optional<std::string> read_file(const fs::path& path, const io::Place& place,
                                     io::Faults& faults) {
  constexpr std::uintmax_t kLargest = 16u << 20;
  std::string trouble = obstacle(path);
  std::error_code error;
  if (trouble.empty() && fs::file_size(path, error) > kLargest) trouble = "the file is too large";
  if (trouble.empty()) {
    std::ifstream stream(path, std::ios::binary);
    std::string text{std::istreambuf_iterator<char>(stream), std::istreambuf_iterator<char>()};
    if (!stream.bad()) return text;
    trouble = "reading stopped halfway";
  }
  faults.add(place, trouble, "Name an experiment folder or its experiment.toml");
  return std::nullopt;
}

}  // namespace manoscope::experiment

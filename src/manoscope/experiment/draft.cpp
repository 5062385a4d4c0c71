#include "manoscope/experiment/draft.hpp"

#include <fcntl.h>
#include <fmt/format.h>
#include <stdio.h>

#include <algorithm>
#include <cerrno>
#include <fstream>
#include <optional>
#include <system_error>
#include <utility>

#include "manoscope/core/error.hpp"
#include "manoscope/experiment/draft_text.hpp"
#include "manoscope/io/faults.hpp"
#include "manoscope/io/reader.hpp"

namespace manoscope::experiment {
namespace {

namespace fs = std::filesystem;

constexpr const char* kToml = "experiment.toml";
constexpr const char* kHydrostatic = "hydrostatic.csv";
constexpr const char* kFlow = "flow.csv";

void check_folder(const fs::path& folder) {
  std::error_code error;
  if (!fs::is_directory(folder, error)) {
    throw InputError(folder.string(),
                     fs::exists(folder, error) ? "this is no folder" : "there is no such folder",
                     "Name the folder that holds the maps");
  }
  for (const char* name : {kToml, kHydrostatic, kFlow}) {
    if (!fs::exists(fs::symlink_status(folder / name, error))) continue;
    throw InputError((folder / name).string(), "the file is already there",
                     "A draft overwrites nothing: move the file away, or edit it");
  }
}

/// Names of the ordinary files in a folder, sorted: the order of a folder is the disk's.
std::vector<std::string> files_in(const fs::path& folder) {
  std::vector<std::string> names;
  std::error_code error;
  for (fs::directory_iterator it(folder, error), end; !error && it != end; it.increment(error)) {
    std::error_code ignored;
    const std::string name = it->path().filename().string();
    if (!name.starts_with('.') && it->is_regular_file(ignored)) names.push_back(name);
  }
  if (error) {
    throw InputError(folder.string(), "the folder cannot be listed (" + error.message() + ")",
                     "Check its read permission");
  }
  std::sort(names.begin(), names.end());
  return names;
}

bool is_map(const fs::path& path) {
  try {
    io::find_reader(path);
    return true;
  } catch (const InputError&) {
    return false;
  }
}

std::optional<CameraGrid> grid_of(const fs::path& path) {
  try {
    return io::read_height_map(path).grid();
  } catch (const InputError&) {
    return std::nullopt;
  }
}

std::string folder_name(const fs::path& folder) {
  std::error_code error;
  const std::string name = fs::weakly_canonical(folder, error).filename().string();
  return !error && can_be_a_name(name) ? name : "";
}

/// By value, then by name; what has no value comes last.
template <class Q>
void sort_by(std::vector<GuessedMap>& maps, std::optional<Q> FileNameGuess::*value) {
  std::stable_sort(maps.begin(), maps.end(), [&](const GuessedMap& a, const GuessedMap& b) {
    const auto& left = a.guess.*value;
    const auto& right = b.guess.*value;
    if (left.has_value() != right.has_value()) return left.has_value();
    return left && *left < *right;
  });
}

std::vector<std::string> names_of(const std::vector<GuessedMap>& maps) {
  std::vector<std::string> names;
  names.reserve(maps.size());
  for (const GuessedMap& map : maps) names.push_back(map.name);
  return names;
}

/// What an editor has put there meanwhile stays.
bool rename_to_new(const fs::path& from, const fs::path& to) {
  if (::renameat2(AT_FDCWD, from.c_str(), AT_FDCWD, to.c_str(), RENAME_NOREPLACE) == 0) return true;
  const bool unknown = errno == EINVAL || errno == ENOSYS;  // to some file systems
  std::error_code error;
  if (!unknown || fs::exists(fs::symlink_status(to, error))) return false;
  fs::rename(from, to, error);
  return !error;
}

/// Writes under another name first: what carries the final name is whole.
void write_new(const fs::path& path, const std::string& text) {
  fs::path part = path;
  part += ".part";
  {
    std::ofstream stream(part, std::ios::binary | std::ios::trunc);
    stream << text;
    stream.close();
    if (stream && rename_to_new(part, path)) return;
  }
  std::error_code ignored;
  fs::remove(part, ignored);
  throw InputError(path.string(), "the file cannot be written",
                   "Check write permission and free space of the folder");
}

}  // namespace

Draft draft_experiment(const fs::path& folder) {
  check_folder(folder);
  Draft draft;
  std::vector<GuessedMap> hydrostatic, flow;
  std::optional<CameraGrid> grid;
  std::string grid_map;
  for (const std::string& name : files_in(folder)) {
    if (!is_map(folder / name)) {
      draft.no_maps.push_back(name);
      continue;
    }
    const FileNameGuess guess = guess_from_file_name(name);
    const bool listed = !guess.ambiguous && can_be_listed(name);
    if (listed && guess.list == FileNameGuess::List::hydrostatic) {
      hydrostatic.push_back({name, guess});
    } else if (listed && guess.list == FileNameGuess::List::flow) {
      flow.push_back({name, guess});
    } else {
      draft.unassigned.push_back(name);
    }
    if (!grid && (grid = grid_of(folder / name))) grid_map = name;
  }
  if (hydrostatic.empty() && flow.empty() && draft.unassigned.empty()) {
    throw InputError(folder.string(), "the folder holds no map that can be read",
                     "Copy the maps there; `manoscope formats` tells what can be read");
  }
  sort_by(hydrostatic, &FileNameGuess::pressure);
  sort_by(flow, &FileNameGuess::flow_rate);
  draft.hydrostatic = names_of(hydrostatic);
  draft.flow = names_of(flow);
  const auto write = [&](const char* name, const std::string& text) {
    write_new(folder / name, text);
    draft.written.push_back(folder / name);
  };
  write(kHydrostatic, draft_hydrostatic(hydrostatic));
  if (!flow.empty()) write(kFlow, draft_flow(flow));
  write(kToml, draft_toml(folder_name(folder), grid, grid_map, !flow.empty(), draft.unassigned));
  return draft;
}

}  // namespace manoscope::experiment

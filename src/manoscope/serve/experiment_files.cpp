#include "manoscope/serve/experiment_files.hpp"

#include <fmt/format.h>
#include <unistd.h>

#include <algorithm>
#include <array>
#include <cerrno>

#include "manoscope/core/atomic_file.hpp"
#include "manoscope/core/provenance.hpp"
#include "manoscope/io/map_address.hpp"
#include "manoscope/serve/address.hpp"
#include "manoscope/serve/api_error.hpp"

namespace manoscope::serve {
namespace {

namespace fs = std::filesystem;

constexpr std::uint64_t kLargestText = 4 << 20;

/// Nullopt if there is no such file.
std::optional<std::string> read_text(const Folder& folder, const std::string& relative) {
  const Descriptor opened = folder.open(relative, Folder::Kind::file);
  if (!opened) return std::nullopt;
  if (status_of(opened).size > kLargestText) {
    throw InputError(relative, "the file is too large", "No text of settings is that large");
  }
  std::string text;
  std::array<char, 16384> buffer{};
  while (text.size() <= kLargestText) {
    const ssize_t n = ::read(opened.number(), buffer.data(), buffer.size());
    if (n < 0 && errno == EINTR) continue;
    if (n < 0) throw InputError(relative, "the file cannot be read", "Check the disk");
    if (n == 0) break;
    text.append(buffer.data(), static_cast<std::size_t>(n));
  }
  return text;
}

/// Whether a name, or the file of one that names a page (FILE#n), leads out.
bool leads_out(const Folder& folder, const std::string& experiment_file, const std::string& name) {
  const auto path = beneath(experiment_file, name);
  if (!path || folder.leads_out(*path)) return true;
  const std::string file = path->substr(0, path->rfind('#'));
  return file != *path && folder.leads_out(file);
}

void check_list_name(const Folder& folder, const std::string& path) {
  const std::string extension = fs::path(path).extension().string();
  if (!relative_parts(path) ||
      (extension != ".csv" && extension != ".tsv" && extension != ".txt")) {
    throw InputError(path, "this is no name for a list",
                     "Name a .csv beneath the folder that is served");
  }
  if (folder.leads_out(path)) {
    throw InputError(path, "the list lies outside the folder that is served",
                     "Copy it into the folder");
  }
}

}  // namespace

std::string experiment_file(const std::string& file) {
  if (!relative_parts(file) || !file.ends_with(".toml")) {
    throw ApiError(400, "file", "this names no experiment file",
                   "Name an experiment.toml, relative to the folder that is served");
  }
  return file;
}

std::optional<std::string> beneath(const std::string& experiment_file, const std::string& name) {
  if (name.find('\0') != std::string::npos) return std::nullopt;
  const fs::path path = (fs::path(experiment_file).parent_path() / name).lexically_normal();
  if (path.is_absolute() || (!path.empty() && *path.begin() == "..")) return std::nullopt;
  return path.string();
}

std::map<std::string, std::string> read_lists(const Folder& folder, const std::string& file,
                                              const std::string& toml) {
  std::map<std::string, std::string> lists;
  std::vector<std::string> names;
  try {
    names = experiment::list_files(toml);
  } catch (const InputError&) {
    return lists;  // no TOML: told by whoever reads the form
  }
  for (const std::string& name : names) {
    const auto path = beneath(file, name);
    if (!path || path->empty() || folder.leads_out(*path)) continue;
    if (const auto text = read_text(folder, *path)) {
      lists[name] = *text;
    } else if (!folder.has(*path, Folder::Kind::folder)) {
      lists[name] = "";
    }
  }
  return lists;
}

std::optional<ExperimentDraft> load_experiment(const Folder& folder, const std::string& file) {
  auto text = read_text(folder, file);
  if (!text) return std::nullopt;
  ExperimentDraft draft{file, {std::move(*text), {}}};
  draft.texts.lists = read_lists(folder, file, draft.texts.toml);
  return draft;
}

std::string revision_of(const ExperimentDraft& draft) {
  constexpr std::size_t kDigits = 32;
  std::string whole = fmt::format("{}:{}", draft.texts.toml.size(), draft.texts.toml);
  for (const auto& [name, text] : draft.texts.lists) {
    whole += fmt::format("{}:{}{}:{}", name.size(), name, text.size(), text);
  }
  return sha256(whole).substr(0, kDigits);
}

std::vector<InputError> names_that_lead_out(const Folder& folder, const ExperimentDraft& draft,
                                            const experiment::Form& form) {
  const std::string path = folder.absolute(draft.file).string();
  std::vector<InputError> faults;
  const auto look = [&](const std::string& where, const std::string& name,
                        const std::string& from) {
    if (!leads_out(folder, from, name)) return;
    faults.emplace_back(where, fmt::format("\"{}\" lies outside the folder that is served", name),
                        "Copy it into the folder, or serve the folder above");
  };
  const auto look_at_list = [&](const char* section,
                                const std::optional<experiment::FormList>& list) {
    if (!list) return;
    std::string from;
    if (!list->file.empty()) {
      look(fmt::format("{}: {}.list", path, section), list->file, draft.file);
      from = beneath(draft.file, list->file).value_or("");
    }
    const auto column = std::find(list->columns.begin(), list->columns.end(), "map");
    if (column == list->columns.end()) return;
    const auto at = static_cast<std::size_t>(column - list->columns.begin());
    for (std::size_t i = 0; i < list->rows.size(); ++i) {
      const std::string& name = list->rows[i][at];
      const std::string where =
          from.empty()
              ? fmt::format("{}:{}: {}.maps entry {}: map", path, list->lines[i], section, i + 1)
              : fmt::format("{}:{}: map", folder.absolute(from).string(), list->lines[i]);
      const std::size_t before = faults.size();
      look(where, name, draft.file);
      // A map that is not there is looked for beside the list, too.
      if (!from.empty() && faults.size() == before) look(where, name, from);
    }
  };
  look_at_list("hydrostatic", form.hydrostatic);
  look_at_list("flow", form.flow);
  if (const auto reference = form.values.find("instrument.reference");
      reference != form.values.end()) {
    look(path + ": instrument.reference", reference->second[0], draft.file);
  }
  return faults;
}

void write_experiment(const Folder& folder, const std::optional<ExperimentDraft>& old,
                      const ExperimentDraft& draft) {
  std::vector<std::pair<std::string, const std::string*>> changed;
  for (const std::string& name : experiment::list_files(draft.texts.toml)) {
    const auto text = draft.texts.lists.find(name);
    if (text == draft.texts.lists.end() || text->second.empty()) continue;
    const bool known = old && old->texts.lists.contains(name);
    if (known && old->texts.lists.at(name) == text->second) continue;
    const auto path = beneath(draft.file, name);
    check_list_name(folder, path.value_or(name));
    if (!known && folder.has(*path, Folder::Kind::file)) {
      throw ApiError(409, *path, "a file of that name is there already", "Name the list otherwise");
    }
    changed.emplace_back(*path, &text->second);
  }
  if (folder.leads_out(draft.file)) {
    throw InputError(draft.file, "the file lies outside the folder that is served",
                     "Copy it into the folder");
  }
  if (!old || old->texts.toml != draft.texts.toml) {
    changed.emplace_back(draft.file, &draft.texts.toml);
  }
  for (const auto& [path, text] : changed) {
    auto parts = *relative_parts(path);
    parts.pop_back();
    folder.make_folders(parts);
    write_file_atomically(folder.absolute(path), *text);
  }
}

}  // namespace manoscope::serve

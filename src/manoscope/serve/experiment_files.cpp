#include "manoscope/serve/experiment_files.hpp"

#include <fmt/format.h>
#include <unistd.h>

#include <algorithm>
#include <array>
#include <cerrno>
#include <memory>

#include "manoscope/core/provenance.hpp"
#include "manoscope/io/map_address.hpp"
#include "manoscope/serve/address.hpp"
#include "manoscope/serve/api_error.hpp"
#include "manoscope/serve/staged_file.hpp"

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

/// The path of a name as the readers open it: with `..` as it stands, for that leads elsewhere
/// behind a link than in front of one.
std::string as_opened(const std::string& experiment_file, const std::string& name) {
  return (fs::path(experiment_file).parent_path() / name).string();
}

/// Whether a name, or the file of one that names a page (FILE#n), leads out.
bool leads_out(const Folder& folder, const std::string& experiment_file, const std::string& name) {
  if (!beneath(experiment_file, name)) return true;
  const std::string path = as_opened(experiment_file, name);
  if (folder.leads_out(path)) return true;
  const std::string file = path.substr(0, path.rfind('#'));
  return file != path && folder.leads_out(file);
}

bool is_hidden(const std::string& path) {
  const fs::path parts(path);
  return std::any_of(parts.begin(), parts.end(),
                     [](const fs::path& part) { return part.string().starts_with('.'); });
}

bool is_list_name(const std::string& path) {
  const std::string extension = fs::path(path).extension().string();
  return relative_parts(path) &&
         (extension == ".csv" || extension == ".tsv" || extension == ".txt");
}

/// The text of a list, nullopt if it is not there or not to be read here.
std::optional<std::string> read_list(const Folder& folder, const std::string& file,
                                     const std::string& name) {
  const auto path = beneath(file, name);
  if (!path || !is_list_name(*path) || leads_out(folder, file, name)) return std::nullopt;
  return read_text(folder, as_opened(file, name));
}

/// Where a list is to be written.
std::string path_of_list(const Folder& folder, const std::string& file, const std::string& name) {
  const auto path = beneath(file, name);
  if (!path || !is_list_name(*path)) {
    throw InputError(path.value_or(name), "this is no name for a list",
                     "Name a .csv beneath the folder that is served");
  }
  // Behind a link `..` is another folder than it looks.
  if (leads_out(folder, file, name) || folder.leads_out(*path) ||
      folder.without_links(as_opened(file, name)) != folder.without_links(*path)) {
    throw InputError(*path, "the list lies outside the folder that is served",
                     "Copy it into the folder");
  }
  return *path;
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
  // Nearly every name is that of a file alone: nothing is to be taken apart.
  if (!name.empty() && name.find('/') == std::string::npos && name != "." && name != "..") {
    return experiment_file.substr(0, experiment_file.rfind('/') + 1) + name;
  }
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
    if (!path || !is_list_name(*path) || leads_out(folder, file, name)) continue;
    if (auto text = read_list(folder, file, name)) {
      lists[name] = std::move(*text);
    } else if (!folder.has(*path, Folder::Kind::folder)) {
      lists[name] = "";
    }
  }
  return lists;
}

void adopt_lists(const Folder& folder, ExperimentDraft& draft, experiment::Form& form) {
  for (auto* list : {&form.hydrostatic, &form.flow}) {
    if (!*list || (*list)->file.empty() || draft.texts.lists.contains((*list)->file)) continue;
    auto text = read_list(folder, draft.file, (*list)->file);
    if (!text || text->empty()) continue;
    const experiment::FormList there = experiment::read_csv_form(*text, (*list)->file);
    if (!(*list)->rows.empty() && !same_table(there, **list)) continue;
    *list = there;
    draft.texts.lists[there.file] = std::move(*text);
  }
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
    if (leads_out(folder, from, name)) {
      faults.emplace_back(where, fmt::format("\"{}\" lies outside the folder that is served", name),
                          "Copy it into the folder, or serve the folder above");
    } else if (is_hidden(*beneath(from, name))) {
      faults.emplace_back(where, fmt::format("\"{}\" is hidden, and so is not served", name),
                          "Name a file without a dot in front");
    }
  };
  const auto look_at_list = [&](const char* section,
                                const std::optional<experiment::FormList>& list) {
    if (!list) return;
    std::string from;
    if (!list->file.empty()) {
      const std::string where = fmt::format("{}: {}.list", path, section);
      const std::size_t before = faults.size();
      look(where, list->file, draft.file);
      if (faults.size() == before && !is_list_name(*beneath(draft.file, list->file))) {
        faults.emplace_back(where, fmt::format("\"{}\" is no name for a list", list->file),
                            "Name a .csv, .tsv or .txt");
      }
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

namespace {

/// A file to be written, on the disk already under another name.
struct Staged {
  std::unique_ptr<StagedFile> file;
  bool replaces = false;
  std::string list;  ///< its name in the experiment; "" for experiment.toml itself
  std::string path, text;
};

/// @param replaces  a file that was read; where none was, none is replaced, for whatever reason.
Staged stage(const Folder& folder, const std::string& list, const std::string& path,
             const std::string& text, bool replaces) {
  std::vector<std::string> parts;
  for (const fs::path& part : fs::path(folder.without_links(path))) parts.push_back(part.string());
  Staged staged{std::make_unique<StagedFile>(folder, parts), replaces, list, path, text};
  staged.file->write(text);
  if (replaces) staged.file->resemble_target();
  staged.file->finish();
  return staged;
}

[[noreturn]] void refuse_changed(const std::string& file) {
  throw ApiError(412, file, "the file or one of its lists has changed in the meantime",
                 "Look at what is there now, then write again");
}

[[noreturn]] void refuse_taken(const std::string& path) {
  throw ApiError(409, path, "a file of that name is there already, with another table",
                 "Name the list otherwise; a list without rows takes what the file holds");
}

/// Whether a list is to be written: not if the same is there already.
/// @throws ApiError 409 if the draft names it anew and something else is there.
bool list_differs(const Folder& folder, const std::optional<ExperimentDraft>& old,
                  const ExperimentDraft& draft, const std::string& name, const OwnLists& own) {
  const std::string& text = draft.texts.lists.at(name);
  if (old && old->texts.lists.contains(name)) return old->texts.lists.at(name) != text;
  const std::string path = path_of_list(folder, draft.file, name);
  const auto there = read_list(folder, draft.file, name);
  if (!there) return true;
  if (*there == text) return false;
  const auto left = own.find(path);
  if (left == own.end() || left->second != sha256(*there)) refuse_taken(path);
  return true;
}

}  // namespace

void write_experiment(const Folder& folder, const std::optional<ExperimentDraft>& old,
                      const ExperimentDraft& draft, OwnLists& own) {
  std::vector<Staged> changed;
  for (const std::string& name : experiment::list_files(draft.texts.toml)) {
    const auto text = draft.texts.lists.find(name);
    if (text == draft.texts.lists.end() || text->second.empty()) continue;
    if (!list_differs(folder, old, draft, name, own)) continue;
    const std::string path = path_of_list(folder, draft.file, name);
    const bool is_there = read_list(folder, draft.file, name).has_value();
    changed.push_back(stage(folder, name, path, text->second, is_there));
  }
  if (!old || old->texts.toml != draft.texts.toml) {
    changed.push_back(stage(folder, "", draft.file, draft.texts.toml, old.has_value()));
  }
  // All is on the disk; what takes time is behind us. Between this look and the new names an
  // editor's change would be lost: a moment in which nothing is written.
  const auto now = load_experiment(folder, draft.file);
  if (bool(now) != bool(old) || (now && revision_of(*now) != revision_of(*old))) {
    refuse_changed(draft.file);
  }
  for (const Staged& staged : changed) {
    if (!staged.list.empty()) list_differs(folder, old, draft, staged.list, own);
  }
  for (const Staged& staged : changed) {
    const bool is_list = !staged.list.empty();
    if (staged.replaces) {
      staged.file->replace();
    } else if (!staged.file->appear()) {
      is_list ? refuse_taken(staged.path) : refuse_changed(staged.path);
    }
    if (is_list && (!staged.replaces || own.contains(staged.path))) {
      own[staged.path] = sha256(staged.text);
    }
  }
}

}  // namespace manoscope::serve

#include "manoscope/serve/state_api.hpp"

#include <nlohmann/json.hpp>

#include "manoscope/core/provenance.hpp"
#include "manoscope/io/reader.hpp"
#include "manoscope/io/toml_document.hpp"
#include "manoscope/serve/api_error.hpp"
#include "manoscope/serve/experiment_files.hpp"
#include "manoscope/serve/json.hpp"

namespace manoscope::serve {
namespace {

using nlohmann::json;

constexpr std::size_t kMostEntries = 5000;

std::string parent_of(const std::string& path) {
  const auto slash = path.rfind('/');
  return slash == std::string::npos ? "" : path.substr(0, slash);
}

bool is_named(const std::string& path, const std::string& name) {
  return path == name || path.ends_with("/" + name);
}

bool is_map(const std::filesystem::path& path) {
  try {
    io::find_reader(path);
    return true;
  } catch (const InputError&) {
    return false;
  }
}

}  // namespace

std::string StateApi::name_of(const std::string& file, const Scan::File& status) {
  Named& known = names_[file];
  if (known.file == status) return known.name;
  known = {status, ""};
  try {
    const auto draft = load_experiment(*folder_, file);
    const io::TomlValue root = io::parse_toml(draft ? draft->texts.toml : "", file);
    if (const io::TomlValue* name = root.find("name")) known.name = name->text;
  } catch (const InputError&) {
    // told when the experiment is opened
  }
  return known.name;
}

Reply StateApi::state(const json& job) {
  const Scan found = scan(*folder_);
  json experiments = json::array(), results = json::array();
  const std::scoped_lock lock(mutex_);
  for (const auto& [path, file] : found.files) {
    if (is_named(path, "experiment.toml")) {
      experiments.push_back({{"file", path},
                             {"folder", parent_of(path)},
                             {"name", name_of(path, file)},
                             {"modified", file.modified}});
    } else if (is_named(path, "result.nc")) {
      const std::string folder = parent_of(path);
      results.push_back({{"folder", folder},
                         {"modified", file.modified},
                         {"report", found.files.contains(under(folder, "report.html"))}});
    }
  }
  return json_reply(
      {{"version", program_version()},
       {"revision", source_revision()},
       {"folder",
        {{"name", folder_->path().filename().string()}, {"path", folder_->path().string()}}},
       {"experiments", experiments},
       {"results", results},
       {"truncated", found.truncated},
       {"job", job}});
}

Reply StateApi::list(const Address& address) const {
  const std::string folder = address.value("folder").value_or("");
  if (!relative_parts(folder) || !folder_->has(folder, Folder::Kind::folder)) {
    throw ApiError(404, folder, "there is no such folder", "Look at its spelling");
  }
  const std::vector<Entry> entries = list_folder(*folder_, folder, kMostEntries);
  json list = json::array();
  for (const Entry& entry : entries) {
    const std::string path = under(folder, entry.name);
    const auto holds = [&](const char* name) {
      return entry.is_folder && folder_->has(under(path, name), Folder::Kind::file);
    };
    list.push_back({{"name", entry.name},
                    {"kind", entry.is_folder ? "folder" : "file"},
                    {"size", entry.size},
                    {"modified", entry.modified},
                    {"map", !entry.is_folder && is_map(folder_->absolute(path))},
                    {"experiment", holds("experiment.toml")},
                    {"result", holds("result.nc")}});
  }
  return json_reply(
      {{"folder", folder}, {"entries", list}, {"truncated", entries.size() >= kMostEntries}});
}

std::vector<std::string> StateApi::changes() {
  Scan now = scan(*folder_);
  const std::scoped_lock lock(mutex_);
  std::vector<std::string> changed;
  if (scanned_) changed = changed_files(last_, now);
  last_ = std::move(now);
  scanned_ = true;
  return changed;
}

}  // namespace manoscope::serve

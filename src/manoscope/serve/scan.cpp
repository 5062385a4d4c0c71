#include "manoscope/serve/scan.hpp"

#include <dirent.h>
#include <fcntl.h>
#include <sys/stat.h>

#include <algorithm>
#include <memory>
#include <optional>

#include "manoscope/serve/address.hpp"

namespace manoscope::serve {
namespace {

constexpr std::size_t kMostFiles = 5000;
constexpr std::size_t kMostSeen = 50000;  // names read, some 100 ms
constexpr int kDeepest = 6;

struct CloseFolder {
  void operator()(DIR* folder) const { ::closedir(folder); }
};

Entry entry_of(std::string name, const struct stat& status) {
  return {std::move(name), S_ISDIR(status.st_mode) != 0, static_cast<std::uint64_t>(status.st_size),
          static_cast<double>(status.st_mtim.tv_sec) +
              1e-9 * static_cast<double>(status.st_mtim.tv_nsec)};
}

/// What the link `relative` leads to, if that is a file or folder beneath.
std::optional<Entry> follow(const Folder& folder, const std::string& relative,
                            const std::string& name) {
  for (const auto kind : {Folder::Kind::file, Folder::Kind::folder}) {
    const Descriptor opened = folder.open(relative, kind);
    struct stat status {};
    if (opened && ::fstat(opened.number(), &status) == 0) return entry_of(name, status);
  }
  return std::nullopt;
}

/// Calls `take` with every entry; links are told as what they lead to, with `linked`.
template <class Take>
void each_entry(const Folder& folder, const std::string& relative, const Take& take) {
  Descriptor opened = folder.open(relative, Folder::Kind::folder);
  if (!opened) return;
  const std::unique_ptr<DIR, CloseFolder> list(::fdopendir(opened.number()));
  if (!list) return;
  const int number = opened.release();  // closed with the list from here on
  while (const dirent* read = ::readdir(list.get())) {
    const std::string name = read->d_name;
    struct stat status {};
    if (!is_plain_name(name) ||
        ::fstatat(number, name.c_str(), &status, AT_SYMLINK_NOFOLLOW) != 0) {
      continue;
    }
    const bool linked = S_ISLNK(status.st_mode) != 0;
    std::optional<Entry> entry;
    if (linked) {
      entry = follow(folder, under(relative, name), name);
    } else if (S_ISDIR(status.st_mode) || S_ISREG(status.st_mode)) {
      entry = entry_of(name, status);
    }
    if (entry && !take(std::move(*entry), linked)) return;
  }
}

/// What makes an experiment or a result is found in however many files it lies.
bool always_counts(const std::string& name) {
  return name == "experiment.toml" || name == "result.nc" || name == "report.html";
}

/// A scan level by level: what lies near the top is found, however much lies deep in one branch.
class Scanner {
 public:
  explicit Scanner(const Folder& folder) : folder_(folder) {}

  Scan run() {
    std::vector<std::string> level{""};
    for (int depth = 0; !level.empty(); ++depth) {
      if (depth > kDeepest) {
        found_.truncated = true;
        break;
      }
      std::vector<std::string> next;
      for (const std::string& path : level) look_into(path, next);
      std::sort(next.begin(), next.end());
      level = std::move(next);
    }
    return std::move(found_);
  }

 private:
  void look_into(const std::string& relative, std::vector<std::string>& folders) {
    each_entry(folder_, relative, [&](const Entry& entry, bool linked) {
      const std::string path = under(relative, entry.name);
      if (entry.is_folder && !linked) {
        folders.push_back(path);
      } else if (!entry.is_folder) {
        take(path, entry);
      }
      if (++n_seen_ < kMostSeen) return true;
      found_.truncated = true;
      return false;
    });
  }
  void take(const std::string& path, const Entry& entry) {
    const bool room = n_usual_ < kMostFiles;
    if (!room) found_.truncated = true;
    if (!room && !always_counts(entry.name)) return;
    n_usual_ += !always_counts(entry.name);
    found_.files[path] = {entry.size, entry.modified};
  }

  const Folder& folder_;
  Scan found_;
  std::size_t n_seen_ = 0, n_usual_ = 0;
};

}  // namespace

std::vector<Entry> list_folder(const Folder& folder, const std::string& relative,
                               std::size_t most) {
  std::vector<Entry> entries;
  each_entry(folder, relative, [&](Entry entry, bool) {
    entries.push_back(std::move(entry));
    return entries.size() < most;
  });
  std::sort(entries.begin(), entries.end(), [](const Entry& a, const Entry& b) {
    return a.is_folder != b.is_folder ? a.is_folder : a.name < b.name;
  });
  return entries;
}

Scan scan(const Folder& folder) { return Scanner(folder).run(); }

std::vector<std::string> changed_files(const Scan& before, const Scan& after) {
  std::vector<std::string> changed;
  for (const auto& [path, file] : after.files) {
    const auto old = before.files.find(path);
    if (old == before.files.end() || old->second != file) changed.push_back(path);
  }
  for (const auto& [path, file] : before.files) {
    if (!after.files.contains(path)) changed.push_back(path);
  }
  return changed;
}

}  // namespace manoscope::serve

#include "manoscope/serve/fault_json.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <charconv>
#include <nlohmann/json.hpp>

#include "manoscope/core/error.hpp"

namespace manoscope::serve {
namespace {

using experiment::FormList;
using nlohmann::json;

/// "FILE:LINE: KEY", of which line and key may be missing.
struct FaultPlace {
  std::string file;  ///< "" if it is none of the experiment's
  int line = 0;
  std::string key;
};

std::optional<FaultPlace> place_in(const std::string& where, const std::string& path,
                                   const std::string& file) {
  if (!where.starts_with(path)) return std::nullopt;
  FaultPlace place{file, 0, ""};
  std::string_view rest = std::string_view(where).substr(path.size());
  if (!rest.empty() && rest.front() != ':') return std::nullopt;
  if (rest.size() > 1 && rest[1] != ' ') {
    const auto [end, error] =
        std::from_chars(rest.data() + 1, rest.data() + rest.size(), place.line);
    if (error != std::errc()) return std::nullopt;
    rest.remove_prefix(static_cast<std::size_t>(end - rest.data()));
  }
  if (rest.starts_with(": ")) place.key = rest.substr(2);
  return place;
}

/// "hydrostatic.maps entry 3: pressure" is column pressure of row 2.
bool split_entry(std::string& key, std::optional<std::size_t>& row, std::string& column) {
  constexpr std::string_view kEntry = ".maps entry ";
  const auto at = key.find(kEntry);
  if (at == std::string::npos) return false;
  std::size_t number = 0;
  const char* begin = key.data() + at + kEntry.size();
  const auto [end, error] = std::from_chars(begin, key.data() + key.size(), number);
  if (error != std::errc() || number == 0) return false;
  row = number - 1;
  const std::string_view rest(end, static_cast<std::size_t>(key.data() + key.size() - end));
  if (rest.starts_with(": ")) column = rest.substr(2);
  key.resize(at);
  return true;
}

std::optional<std::size_t> row_of_line(const FormList& list, int line) {
  const auto found = std::find(list.lines.begin(), list.lines.end(), line);
  if (found == list.lines.end()) return std::nullopt;
  return static_cast<std::size_t>(found - list.lines.begin());
}

/// The row of a map whose file is at fault: "PATH" or "PATH: ...".
std::optional<std::size_t> row_of_map(const Folder& folder, const ExperimentDraft& draft,
                                      const FormList& list, const std::string& where) {
  const auto column = std::find(list.columns.begin(), list.columns.end(), "map");
  if (column == list.columns.end()) return std::nullopt;
  const auto at = static_cast<std::size_t>(column - list.columns.begin());
  for (std::size_t i = 0; i < list.rows.size(); ++i) {
    const auto path = beneath(draft.file, list.rows[i][at]);
    if (path && where.starts_with(folder.absolute(*path).string())) return i;
  }
  return std::nullopt;
}

}  // namespace

json fault_json(const Folder& folder, const ExperimentDraft& draft, const experiment::Form* form,
                const InputError& fault) {
  const std::string top = folder.path().string() + "/";
  const auto shown = [&](std::string text) {
    for (auto at = text.find(top); at != std::string::npos; at = text.find(top)) {
      text.erase(at, top.size());
    }
    return text;
  };
  json result = {{"file", shown(fault.where())},
                 {"line", nullptr},
                 {"key", nullptr},
                 {"row", nullptr},
                 {"column", nullptr}};
  result["found"] = shown(fault.found());
  result["mend"] = shown(fault.mend());
  result["text"] = fmt::format("{}. {}.", shown(fault.found()), shown(fault.mend()));

  std::optional<std::size_t> row;
  std::string column;
  auto place = place_in(fault.where(), folder.absolute(draft.file).string(), draft.file);
  if (place) split_entry(place->key, row, column);
  const std::pair<const char*, const std::optional<FormList>*> lists[] = {
      {"hydrostatic", form == nullptr ? nullptr : &form->hydrostatic},
      {"flow", form == nullptr ? nullptr : &form->flow}};
  for (const auto& [section, list] : lists) {
    if (place || list == nullptr || !*list) continue;
    const auto path = beneath(draft.file, (*list)->file);
    if (path && !(*list)->file.empty()) {
      place = place_in(fault.where(), folder.absolute(*path).string(), *path);
    }
    if (place) {
      column = place->key;
      place->key = section;
      row = row_of_line(**list, place->line);
    } else if ((row = row_of_map(folder, draft, **list, fault.where()))) {
      result["key"] = fmt::format("{}.map", section);
      result["row"] = *row;
      result["column"] = "map";
      return result;
    }
  }
  if (!place) return result;
  result["file"] = place->file;
  if (place->line > 0) result["line"] = place->line;
  if (!place->key.empty()) {
    result["key"] = column.empty() ? place->key : fmt::format("{}.{}", place->key, column);
  }
  if (row) result["row"] = *row;
  if (!column.empty()) result["column"] = column;
  return result;
}

}  // namespace manoscope::serve

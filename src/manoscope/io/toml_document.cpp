#include "manoscope/io/toml_document.hpp"

#include <fmt/format.h>

#include <toml++/toml.h>
#include <algorithm>
#include <numeric>
#include <string_view>
#include <utility>

#include "manoscope/core/error.hpp"
#include "manoscope/io/faults.hpp"

namespace manoscope::io {
namespace {

constexpr std::size_t kLargestDocument = 4u << 20;
constexpr int kDeepestKey = 50;
constexpr int kDeepestValue = 64;

std::string_view line_of(std::string_view text, std::size_t line) {
  std::size_t begin = 0;
  for (std::size_t i = 1; i < line; ++i) {
    begin = text.find('\n', begin);
    if (begin == std::string_view::npos) return {};
    ++begin;
  }
  std::string_view found = text.substr(begin, text.find('\n', begin) - begin);
  if (found.ends_with('\r')) found.remove_suffix(1);
  return found;
}

/// The parser nests one table per dot of a key without limit, and unwinds them by recursion.
void refuse_deep_keys(std::string_view text, const std::filesystem::path& file) {
  int line = 1, dots = 0;
  char before = '\n';
  for (const char letter : text) {
    if (letter == '\n') ++line;
    if (letter == '.') dots = before == '.' ? 0 : dots + 1;  // ".." is in no key
    if (std::string_view("\n=,{}[]#").find(letter) != std::string_view::npos) dots = 0;
    before = letter;
    if (dots > kDeepestKey) {
      throw InputError(Place{file, line, ""}.text(), "a key or text of dozens of dots",
                       "Keys have the form section.key");
    }
  }
}

std::string mend_for(std::string_view description) {
  if (description.find("escape") != std::string_view::npos) {
    return "Write paths with / instead of \\, or put the text in single quotes";
  }
  if (description.find("redefine") != std::string_view::npos) {
    return "Every key and section may stand there once: keep one of them";
  }
  if (description.find("UTF-8") != std::string_view::npos) return "Save the file as UTF-8 text";
  return "Write key = \"value\": texts and quantities stand in double quotes, e.g. "
         "length = \"15.5 mm\"";
}

[[noreturn]] void throw_syntax_error(const toml::parse_error& error, const std::string& text,
                                     const std::filesystem::path& file) {
  const auto at = error.source().begin;
  std::string description(error.description());
  std::replace(description.begin(), description.end(), '\n', ' ');
  while (description.ends_with('.')) description.pop_back();
  throw InputError(Place{file, static_cast<int>(at.line), ""}.text(),
                   fmt::format("the line {} is not TOML: column {}, {}",
                               in_quotes(line_of(text, at.line)), at.column, description),
                   mend_for(description));
}

TomlValue convert(const toml::node& node, int depth);

TomlValue convert_table(const toml::table& table, int depth) {
  using Kind = TomlValue::Kind;
  struct Entry {
    toml::source_position at;
    std::string key;
    const toml::node* value;
  };
  std::vector<Entry> entries;
  for (const auto& [key, value] : table) {
    entries.push_back({key.source().begin, std::string(key.str()), &value});
  }
  std::stable_sort(entries.begin(), entries.end(),
                   [](const Entry& a, const Entry& b) { return a.at < b.at; });
  TomlValue result;
  result.kind = Kind::table;
  for (Entry& entry : entries) {
    result.keys.push_back(std::move(entry.key));
    result.items.push_back(convert(*entry.value, depth + 1));
    // The line of a key is where a reader looks, also for a value that begins further down.
    if (result.items.back().kind != Kind::table && entry.at) {
      result.items.back().line = static_cast<int>(entry.at.line);
    }
  }
  return result;
}

TomlValue convert(const toml::node& node, int depth) {
  using Kind = TomlValue::Kind;
  TomlValue result;
  result.line = static_cast<int>(node.source().begin.line);
  if (depth > kDeepestValue) return result;  // an empty table: refused by whoever wanted a value
  if (const auto* table = node.as_table()) {
    const int line = result.line;
    result = convert_table(*table, depth);
    result.line = line;
  } else if (const auto* array = node.as_array()) {
    result.kind = Kind::list;
    for (const toml::node& item : *array) result.items.push_back(convert(item, depth + 1));
  } else if (const auto* text = node.as_string()) {
    result.kind = Kind::text;
    result.text = text->get();
  } else if (const auto* integer = node.as_integer()) {
    result.kind = Kind::integer;
    result.number = static_cast<double>(integer->get());
    result.text = fmt::format("{}", integer->get());
  } else if (const auto* real = node.as_floating_point()) {
    result.kind = Kind::real;
    result.number = real->get();
    result.text = fmt::format("{}", real->get());
  } else if (const auto* boolean = node.as_boolean()) {
    result.kind = Kind::boolean;
    result.text = boolean->get() ? "true" : "false";
  } else {
    result.kind = Kind::date;
    result.text = "a date or time";
  }
  return result;
}

}  // namespace

const TomlValue* TomlValue::find(const std::string& key) const {
  const auto at = std::find(keys.begin(), keys.end(), key);
  return at == keys.end() ? nullptr : &items[static_cast<std::size_t>(at - keys.begin())];
}

TomlValue parse_toml(const std::string& text, const std::filesystem::path& file) {
  if (text.size() > kLargestDocument) {
    throw InputError(file.string(),
                     fmt::format("{} MB: no text of settings is that large", text.size() >> 20),
                     "Name a TOML file, such as an experiment.toml, not a map");
  }
  refuse_deep_keys(text, file);
  try {
    return convert(toml::parse(text), 0);
  } catch (const toml::parse_error& error) {
    throw_syntax_error(error, text, file);
  }
}

}  // namespace manoscope::io

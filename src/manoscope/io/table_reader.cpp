#include "manoscope/io/table_reader.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <limits>
#include <utility>

#include "manoscope/core/suggest.hpp"

namespace manoscope::io {
namespace {

using Kind = TomlValue::Kind;

std::string describe(const TomlValue& value) {
  switch (value.kind) {
    case Kind::text:
      return "the text " + in_quotes(value.text);
    case Kind::integer:
    case Kind::real:
      return "the bare number " + value.text;
    case Kind::list:
      return fmt::format("a list of {}", value.items.size());
    case Kind::table:
      return "a table";
    case Kind::boolean:
    case Kind::date:
      break;
  }
  return value.text;
}

bool is_number(const TomlValue& value) {
  return value.kind == Kind::integer || value.kind == Kind::real;
}

bool contains(const std::vector<std::string>& words, const std::string& word) {
  return std::find(words.begin(), words.end(), word) != words.end();
}

}  // namespace

TableReader::TableReader(const TomlValue& table, std::string path, std::filesystem::path file,
                         Faults& faults)
    : table_(&table), path_(std::move(path)), file_(std::move(file)), faults_(&faults) {}

Place TableReader::place(const std::string& key) const {
  const TomlValue* value = table_->find(key);
  const bool joined = path_.empty() || path_.ends_with(' ');
  return {file_, std::max(1, value != nullptr ? value->line : table_->line),
          path_ + (joined ? "" : ".") + key};
}

const TomlValue* TableReader::find(const std::string& key, Need need, const std::string& example) {
  known_.push_back(key);
  const TomlValue* value = table_->find(key);
  if (value == nullptr && need == Need::required) missing_.push_back({key, example});
  return value;
}

std::optional<double> TableReader::si_value(const std::string& key, const UnitInfo& any_unit,
                                            const Bounds& bounds, Need need) {
  const UnitInfo unit = with_example(any_unit, bounds);
  const TomlValue* value = find(key, need, fmt::format("{} = \"{}\"", key, unit.example));
  if (value == nullptr) return std::nullopt;
  if (value->kind == Kind::text) {
    return checked_quantity(value->text, unit, bounds, place(key), *faults_);
  }
  faults_->add(place(key), fmt::format("{} has no unit", describe(*value)),
               fmt::format("Write the {} with its unit in quotes, e.g. {} = \"{}\"", unit.kind, key,
                           unit.example));
  return std::nullopt;
}

std::optional<std::array<double, 2>> TableReader::si_pair(const std::string& key,
                                                          const UnitInfo& any_unit,
                                                          const Bounds& bounds) {
  const UnitInfo unit = with_example(any_unit, bounds);
  const TomlValue* value = find(key, Need::optional, "");
  if (value == nullptr) return std::nullopt;
  const std::string mend = fmt::format("Write two {0}s with their units: {1} = [\"{2}\", \"{2}\"]",
                                       unit.kind, key, unit.example);
  if (value->kind != Kind::list || value->items.size() != 2) {
    faults_->add(place(key), describe(*value), mend);
    return std::nullopt;
  }
  const auto values = si_items(key, *value, unit, bounds, mend);
  if (!values) return std::nullopt;
  return std::array<double, 2>{(*values)[0], (*values)[1]};
}

std::optional<std::vector<double>> TableReader::si_list(const std::string& key,
                                                        const UnitInfo& any_unit,
                                                        const Bounds& bounds, Need need) {
  const UnitInfo unit = with_example(any_unit, bounds);
  const std::string example = fmt::format("{} = [\"{}\"]", key, unit.example);
  const TomlValue* value = find(key, need, example);
  if (value == nullptr) return std::nullopt;
  const std::string mend =
      fmt::format("Write a list, each {} with its unit: {}", unit.kind, example);
  if (value->kind != Kind::list) {
    faults_->add(place(key), fmt::format("{} is no list", describe(*value)), mend);
    return std::nullopt;
  }
  return si_items(key, *value, unit, bounds, mend);
}

std::optional<std::vector<double>> TableReader::si_items(const std::string& key,
                                                         const TomlValue& list,
                                                         const UnitInfo& unit, const Bounds& bounds,
                                                         const std::string& mend) {
  std::vector<double> values;
  for (const TomlValue& item : list.items) {
    Place at = place(key);
    at.line = item.line > 0 ? item.line : at.line;
    if (item.kind != Kind::text) {
      faults_->add(at, fmt::format("{} has no unit", describe(item)), mend);
      continue;
    }
    const auto number = checked_quantity(item.text, unit, bounds, at, *faults_);
    if (number) values.push_back(*number);
  }
  return values.size() == list.items.size() ? std::optional(values) : std::nullopt;
}

std::optional<double> TableReader::number(const std::string& key, const Bounds& bounds,
                                          const char* example) {
  const TomlValue* value = find(key, Need::optional, "");
  if (value == nullptr) return std::nullopt;
  if (!is_number(*value)) {
    faults_->add(place(key), fmt::format("{} is no number", describe(*value)),
                 fmt::format("Write a number without unit or quotes: {} = {}", key, example));
    return std::nullopt;
  }
  if (!check_bounds(value->number, bounds, value->text, nullptr, place(key), *faults_)) {
    return std::nullopt;
  }
  return value->number;
}

std::optional<int> TableReader::integer(const std::string& key, Need need) {
  const TomlValue* value = find(key, need, key + " = 1");
  if (value == nullptr) return std::nullopt;
  if (value->kind != Kind::integer ||
      std::abs(value->number) > static_cast<double>(std::numeric_limits<int>::max())) {
    faults_->add(place(key), fmt::format("{} is no whole number", describe(*value)),
                 fmt::format("Write a whole number without quotes: {} = 1", key));
    return std::nullopt;
  }
  return static_cast<int>(value->number);
}

std::optional<bool> TableReader::boolean(const std::string& key) {
  const TomlValue* value = find(key, Need::optional, "");
  if (value == nullptr) return std::nullopt;
  if (value->kind != Kind::boolean) {
    faults_->add(place(key), fmt::format("{} is neither true nor false", describe(*value)),
                 fmt::format("Write {} = true or {} = false, without quotes", key, key));
    return std::nullopt;
  }
  return value->text == "true";
}

std::optional<std::string> TableReader::text(const std::string& key, Need need) {
  const TomlValue* value = find(key, need, key + " = \"...\"");
  if (value == nullptr) return std::nullopt;
  if (value->kind != Kind::text || (need == Need::required && value->text.empty())) {
    faults_->add(place(key),
                 value->kind == Kind::text ? "an empty text" : describe(*value) + " is no text",
                 fmt::format("Write a text in quotes: {} = \"...\"", key));
    return std::nullopt;
  }
  return value->text;
}

std::optional<std::size_t> TableReader::choose(const std::string& key,
                                               std::span<const std::string> words) {
  const auto word = text(key);
  if (!word) return std::nullopt;
  const auto at = std::find(words.begin(), words.end(), *word);
  if (at != words.end()) return static_cast<std::size_t>(at - words.begin());
  faults_->add(
      place(key),
      fmt::format("{} is not one of its words{}", in_quotes(*word), did_you_mean(*word, words)),
      fmt::format("Write one of \"{}\"", fmt::join(words, "\", \"")));
  return std::nullopt;
}

const TomlValue* TableReader::list(const std::string& key, const char* item) {
  const TomlValue* value = find(key, Need::optional, "");
  if (value != nullptr && value->kind != Kind::list) {
    faults_->add(place(key), fmt::format("{} is no list", describe(*value)),
                 fmt::format("Write {} = [{}, ...]", key, item));
    return nullptr;
  }
  return value;
}

std::optional<TableReader> TableReader::table(const std::string& key, Need need) {
  const TomlValue* value = find(key, need, fmt::format("a section [{}] with its keys", key));
  if (value == nullptr) return std::nullopt;
  if (value->kind != Kind::table) {
    faults_->add(place(key), fmt::format("{} stands where a section belongs", describe(*value)),
                 path_.empty() ? fmt::format("Write a section [{}] with its keys below", key)
                               : fmt::format("Write {} = {{...}} with its keys inside", key));
    return std::nullopt;
  }
  return TableReader(*value, path_.empty() ? key : path_ + "." + key, file_, *faults_);
}

void TableReader::finish() {
  std::vector<std::string> meant;
  std::vector<std::string> absent;  // a key that is there cannot be what another was meant to be
  for (const std::string& key : known_) {
    if (!has(key)) absent.push_back(key);
  }
  for (const std::string& key : table_->keys) {
    if (contains(known_, key)) continue;
    std::string near = nearest_word(key, absent);
    if (near.empty()) near = nearest_word(key, known_);
    const bool section = table_->find(key)->kind == Kind::table && path_.empty();
    faults_->add(place(key),
                 fmt::format("unknown {} {}{}", section ? "section" : "key", in_quotes(key),
                             near.empty() ? "" : fmt::format(" (did you mean \"{}\"?)", near)),
                 near.empty() ? fmt::format("Remove it; known here: {}", fmt::join(known_, ", "))
                              : fmt::format("Write {}, or remove it", near));
    meant.push_back(near);
  }
  for (const Missing& missing : missing_) {
    if (contains(meant, missing.key)) continue;
    faults_->add(place(missing.key), fmt::format("{} is missing", in_quotes(missing.key)),
                 "Add " + missing.example);
  }
}

}  // namespace manoscope::io

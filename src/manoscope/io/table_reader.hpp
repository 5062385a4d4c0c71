#pragma once

#include <array>
#include <filesystem>
#include <optional>
#include <span>
#include <string>
#include <vector>

#include "manoscope/core/words.hpp"
#include "manoscope/io/bounds.hpp"
#include "manoscope/io/faults.hpp"
#include "manoscope/io/toml_document.hpp"

namespace manoscope::io {

enum class Need { optional, required };

/// Reads the keys of one TOML table, each with its type and bounds, and notes every fault.
///
/// Keys asked for are the known ones: there is no second list. `finish` then reports those that
/// nobody asked for, and the required ones that are not there.
class TableReader {
 public:
  /// @param path  Names the table in messages: "channel" gives "channel.height"; a path that ends
  ///              in a space is put in front as it is.
  TableReader(const TomlValue& table, std::string path, std::filesystem::path file, Faults& faults);

  template <class Q>
  std::optional<Q> quantity(const std::string& key, const Bounds& bounds,
                            Need need = Need::optional) {
    const auto value = si_value(key, unit_info<Q>(), bounds, need);
    return value ? std::optional<Q>(Q::from_si(*value)) : std::nullopt;
  }
  /// A list of exactly two quantities.
  template <class Q>
  std::optional<std::array<Q, 2>> pair(const std::string& key, const Bounds& bounds) {
    const auto values = si_pair(key, unit_info<Q>(), bounds);
    if (!values) return std::nullopt;
    return std::array<Q, 2>{Q::from_si((*values)[0]), Q::from_si((*values)[1])};
  }
  /// A list of quantities, each with its unit; nullopt if any is unusable.
  template <class Q>
  std::optional<std::vector<Q>> quantities(const std::string& key, const Bounds& bounds,
                                           Need need = Need::optional) {
    const auto values = si_list(key, unit_info<Q>(), bounds, need);
    if (!values) return std::nullopt;
    std::vector<Q> list;
    for (const double value : *values) list.push_back(Q::from_si(value));
    return list;
  }
  /// A plain number; `example` shows how to write one.
  std::optional<double> number(const std::string& key, const Bounds& bounds, const char* example);
  std::optional<int> integer(const std::string& key, Need need = Need::optional);
  std::optional<bool> boolean(const std::string& key);
  std::optional<std::string> text(const std::string& key, Need need = Need::optional);
  template <class E, std::size_t N>
  std::optional<E> choice(const std::string& key, const Word<E> (&words)[N]) {
    std::vector<std::string> names;
    for (const auto& word : words) names.emplace_back(word.word);
    const auto chosen = choose(key, names);
    return chosen ? std::optional<E>(words[*chosen].value) : std::nullopt;
  }
  /// A list of tables, nullptr if absent or no list; `item` shows how to write one of them.
  const TomlValue* list(const std::string& key, const char* item = "{map = \"a.gsf\", ...}");
  std::optional<TableReader> table(const std::string& key, Need need = Need::optional);

  /// Reports unknown and missing keys. A missing key that an unknown one was meant to be is told
  /// once.
  void finish();

  bool has(const std::string& key) const { return table_->find(key) != nullptr; }
  int line() const { return table_->line; }
  const std::filesystem::path& file() const { return file_; }
  /// The place of a key that is there, else of the table.
  Place place(const std::string& key) const;

 private:
  struct Missing {
    std::string key, example;
  };

  const TomlValue* find(const std::string& key, Need need, const std::string& example);
  std::optional<double> si_value(const std::string& key, const UnitInfo& unit, const Bounds& bounds,
                                 Need need);
  std::optional<std::array<double, 2>> si_pair(const std::string& key, const UnitInfo& unit,
                                               const Bounds& bounds);
  std::optional<std::vector<double>> si_list(const std::string& key, const UnitInfo& unit,
                                             const Bounds& bounds, Need need);
  /// The SI values of the items of a list; faults are told with `mend`.
  std::optional<std::vector<double>> si_items(const std::string& key, const TomlValue& list,
                                              const UnitInfo& unit, const Bounds& bounds,
                                              const std::string& mend);
  std::optional<std::size_t> choose(const std::string& key, std::span<const std::string> words);

  const TomlValue* table_;
  std::string path_;
  std::filesystem::path file_;
  Faults* faults_;
  std::vector<std::string> known_;
  std::vector<Missing> missing_;
};

}  // namespace manoscope::io

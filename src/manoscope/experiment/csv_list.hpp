#pragma once

#include <filesystem>
#include <optional>
#include <span>
#include <string>
#include <vector>

#include "manoscope/core/unit_text.hpp"
#include "manoscope/io/bounds.hpp"
#include "manoscope/io/csv_table.hpp"
#include "manoscope/io/faults.hpp"
#include "manoscope/io/table_reader.hpp"

namespace manoscope::experiment {

/// One column a list may have. `unit.si == nullptr`: no unit in its head.
struct ListColumn {
  const char* name;
  io::UnitInfo unit;
  io::Need need;
};

/// A list of maps as CSV, its head checked against the columns that exist.
class CsvList {
 public:
  /// Reads the table; nullopt, with a fault added, if there is none to read.
  /// @param text  what the file holds; nullptr: it is read.
  static std::optional<CsvList> read(const std::filesystem::path& path, const std::string* text,
                                     std::span<const ListColumn> columns, io::Faults& faults);

  const io::CsvTable& table() const { return table_; }
  io::Place place(int line, const std::string& column) const { return {table_.path, line, column}; }

  /// Cell of a row: nullptr if the column is absent, or unusable (which is told once, at the head).
  const std::string* cell(const io::CsvRow& row, const std::string& column) const;
  /// To SI, for a column whose head names a good unit.
  std::optional<UnitScale> scale(const std::string& column) const;

 private:
  struct Known {
    std::string name;
    std::size_t index;
    UnitScale scale;
  };

  void check_head(std::span<const ListColumn> columns, io::Faults& faults);
  const Known* find(const std::string& column) const;

  io::CsvTable table_;
  std::vector<Known> known_;
};

/// Reads the cells of one row by column, as TableReader reads the keys of an inline entry.
class CsvRowReader {
 public:
  CsvRowReader(const CsvList& list, const io::CsvRow& row, io::Faults& faults)
      : list_(&list), row_(&row), faults_(&faults) {}

  template <class Q>
  std::optional<Q> quantity(const std::string& column, const io::Bounds& bounds,
                            io::Need need = io::Need::optional) {
    const auto value = si_value(column, io::unit_info<Q>(), bounds, need);
    return value ? std::optional<Q>(Q::from_si(*value)) : std::nullopt;
  }
  std::optional<std::string> text(const std::string& column, io::Need need = io::Need::optional);
  std::optional<int> integer(const std::string& column, io::Need need = io::Need::optional);
  template <class E, std::size_t N>
  std::optional<E> choice(const std::string& column, const Word<E> (&words)[N]) {
    std::vector<std::string> names;
    for (const auto& word : words) names.emplace_back(word.word);
    const auto chosen = choose(column, names);
    return chosen ? std::optional<E>(words[*chosen].value) : std::nullopt;
  }
  void finish() {}  ///< unknown columns are told at the head

  int line() const { return row_->line; }
  io::Place place(const std::string& column) const { return list_->place(row_->line, column); }

 private:
  /// The cell, nullptr if there is nothing in it (a fault if required).
  const std::string* find(const std::string& column, io::Need need);
  std::optional<double> si_value(const std::string& column, const io::UnitInfo& unit,
                                 const io::Bounds& bounds, io::Need need);
  std::optional<std::size_t> choose(const std::string& column, std::span<const std::string> words);

  const CsvList* list_;
  const io::CsvRow* row_;
  io::Faults* faults_;
};

}  // namespace manoscope::experiment

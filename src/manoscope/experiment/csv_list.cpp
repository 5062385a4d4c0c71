#include "manoscope/experiment/csv_list.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <limits>

#include "manoscope/core/suggest.hpp"

namespace manoscope::experiment {
namespace {

std::string head_of(const ListColumn& column) {
  if (column.unit.si == nullptr) return column.name;
  const std::string_view example = column.unit.example;  // "70 mL/min"
  return fmt::format("{} [{}]", column.name, example.substr(example.find(' ') + 1));
}

std::string heads_of(std::span<const ListColumn> columns) {
  std::vector<std::string> heads;
  for (const ListColumn& column : columns) heads.push_back(head_of(column));
  return fmt::format("{}", fmt::join(heads, ","));
}

/// "pressure (Pa)", "Pressure" and "pressure_Pa" are meant to be the column "pressure".
const ListColumn* meant_column(const std::string& name, std::span<const ListColumn> columns) {
  std::vector<std::string> names;
  for (const ListColumn& column : columns) names.emplace_back(column.name);
  std::string near = nearest_word(name, names);
  if (near.empty()) {
    for (const std::string& known : names) {
      if (name.starts_with(known) && known.size() > near.size()) near = known;
    }
  }
  const auto at = std::find(names.begin(), names.end(), near);
  return at == names.end() ? nullptr : &columns[static_cast<std::size_t>(at - names.begin())];
}

}  // namespace

std::optional<CsvList> CsvList::read(const std::filesystem::path& path, const std::string* text,
                                     std::span<const ListColumn> columns, io::Faults& faults) {
  CsvList list;
  std::vector<io::CsvRowFault> row_faults;
  try {
    list.table_ = text != nullptr ? io::parse_csv_table(*text, path, row_faults)
                                  : io::read_csv_table(path, row_faults);
  } catch (const InputError& error) {
    // Its `where` is "path" or "path:line"; keep the line for the order of the report.
    io::Place place{path, 0, ""};
    const std::string prefix = path.string() + ':';
    if (error.where().starts_with(prefix)) {
      const auto line = parse_number(error.where().substr(prefix.size()));
      place.line = line ? static_cast<int>(*line) : 0;
    }
    faults.add(place, error.found(), error.mend());
    return std::nullopt;
  }
  for (const io::CsvRowFault& fault : row_faults) {
    faults.add({path, fault.line, ""}, fault.found, fault.mend);
  }
  list.check_head(columns, faults);
  return list;
}

void CsvList::check_head(std::span<const ListColumn> columns, io::Faults& faults) {
  const int line = table_.header_line;
  std::vector<std::string> meant;
  for (std::size_t i = 0; i < table_.columns.size(); ++i) {
    const io::CsvColumn& head = table_.columns[i];
    const auto known = std::find_if(columns.begin(), columns.end(),
                                    [&](const ListColumn& c) { return c.name == head.name; });
    if (known == columns.end()) {
      const ListColumn* near = meant_column(head.name, columns);
      faults.add(place(line, head.name),
                 fmt::format("unknown column {}{}", io::in_quotes(head.name),
                             near ? fmt::format(" (did you mean \"{}\"?)", near->name) : ""),
                 near ? fmt::format("Write {}, or remove the column", head_of(*near))
                      : fmt::format("Remove it; known here: {}", heads_of(columns)));
      if (near != nullptr) meant.emplace_back(near->name);
      continue;
    }
    meant.emplace_back(known->name);
    UnitScale scale;
    if (known->unit.si == nullptr) {
      if (!head.unit.empty()) {
        faults.add(place(line, head.name),
                   fmt::format("column {} has the unit {}", io::in_quotes(head.name),
                               io::in_quotes(head.unit)),
                   fmt::format("It has no unit: write {}", head.name));
      }
    } else if (head.unit.empty()) {
      faults.add(place(line, head.name),
                 fmt::format("column {} names no unit", io::in_quotes(head.name)),
                 fmt::format("Write the unit in the head: {}", head_of(*known)));
      continue;
    } else if (const auto found = unit_scale(head.unit, known->unit.si)) {
      scale = *found;
    } else {
      faults.add(
          place(line, head.name),
          is_known_unit(head.unit)
              ? fmt::format("{} is not a unit of {}", io::in_quotes(head.unit), known->unit.kind)
              : fmt::format("unknown unit {}", io::in_quotes(head.unit)),
          fmt::format("Write a unit of {}, e.g. {}", known->unit.kind, head_of(*known)));
      continue;
    }
    known_.push_back({known->name, i, scale});
  }
  for (const ListColumn& column : columns) {
    if (column.need == io::Need::required &&
        std::find(meant.begin(), meant.end(), column.name) == meant.end()) {
      faults.add(place(line, column.name), fmt::format("the column \"{}\" is missing", column.name),
                 fmt::format("Add a column {}", head_of(column)));
    }
  }
}

const CsvList::Known* CsvList::find(const std::string& column) const {
  const auto at = std::find_if(known_.begin(), known_.end(),
                               [&](const Known& known) { return known.name == column; });
  return at == known_.end() ? nullptr : &*at;
}

const std::string* CsvList::cell(const io::CsvRow& row, const std::string& column) const {
  const Known* known = find(column);
  return known == nullptr ? nullptr : &row.cells[known->index];
}

std::optional<UnitScale> CsvList::scale(const std::string& column) const {
  const Known* known = find(column);
  return known == nullptr ? std::nullopt : std::optional(known->scale);
}

const std::string* CsvRowReader::find(const std::string& column, io::Need need) {
  const std::string* cell = list_->cell(*row_, column);
  if (cell == nullptr || !cell->empty()) return cell;
  if (need == io::Need::required) {
    faults_->add(place(column), "the cell is empty", fmt::format("Every row needs its {}", column));
  }
  return nullptr;
}

std::optional<double> CsvRowReader::si_value(const std::string& column, const io::UnitInfo& unit,
                                             const io::Bounds& bounds, io::Need need) {
  const std::string* cell = find(column, need);
  const auto scale = list_->scale(column);
  if (cell == nullptr || !scale) return std::nullopt;
  if (io::is_placeholder(*cell)) {
    faults_->add(place(column),
                 fmt::format("{} is still the placeholder of a draft", io::in_quotes(*cell)),
                 fmt::format("Write the {} of this map", unit.kind));
    return std::nullopt;
  }
  const auto number = list_->table().cell_number(*row_, *list_->table().column(column));
  constexpr double kAbsurd = 1e100;  // far beyond any bound, far from overflow
  if (!number || !std::isfinite(*number) || std::abs(*number) > kAbsurd) {
    faults_->add(place(column), fmt::format("{} is no number", io::in_quotes(*cell)),
                 "Write a plain number; its unit stands in the head of the column");
    return std::nullopt;
  }
  const double value = scale->to_si(*number);
  if (!io::check_bounds(value, bounds, *cell, unit.si, place(column), *faults_))
    return std::nullopt;
  return value;
}

std::optional<std::string> CsvRowReader::text(const std::string& column, io::Need need) {
  const std::string* cell = find(column, need);
  return cell == nullptr ? std::nullopt : std::optional(*cell);
}

std::optional<int> CsvRowReader::integer(const std::string& column, io::Need need) {
  const std::string* cell = find(column, need);
  if (cell == nullptr) return std::nullopt;
  const auto number = parse_number(*cell);
  if (!number || !std::isfinite(*number) ||
      std::abs(*number) > static_cast<double>(std::numeric_limits<int>::max()) ||
      *number != std::floor(*number)) {
    faults_->add(place(column), fmt::format("{} is no whole number", io::in_quotes(*cell)),
                 "Write a whole number such as 1, or leave the cell empty");
    return std::nullopt;
  }
  return static_cast<int>(*number);
}

std::optional<std::size_t> CsvRowReader::choose(const std::string& column,
                                                std::span<const std::string> words) {
  const auto word = text(column);
  if (!word) return std::nullopt;
  const auto at = std::find(words.begin(), words.end(), *word);
  if (at != words.end()) return static_cast<std::size_t>(at - words.begin());
  faults_->add(
      place(column),
      fmt::format("{} is not one of its words{}", io::in_quotes(*word), did_you_mean(*word, words)),
      fmt::format("Write one of {}, or leave the cell empty", fmt::join(words, ", ")));
  return std::nullopt;
}

}  // namespace manoscope::experiment

#include "manoscope/experiment/lists.hpp"

#include <fmt/format.h>

#include <span>

#include "manoscope/experiment/csv_list.hpp"
#include "manoscope/io/map_address.hpp"

namespace manoscope::experiment {
namespace {

constexpr io::UnitInfo kNoUnit{};
constexpr ListColumn kHydrostaticColumns[] = {
    {"map", kNoUnit, io::Need::required},
    {"pressure", io::unit_info<Pressure>(), io::Need::required},
    {"pressure_uncertainty", io::unit_info<Pressure>(), io::Need::optional},
    {"sequence", kNoUnit, io::Need::optional},
    {"direction", kNoUnit, io::Need::optional},
    {"repeat", kNoUnit, io::Need::optional}};
constexpr ListColumn kFlowColumns[] = {
    {"map", kNoUnit, io::Need::required},
    {"flow_rate", io::unit_info<FlowRate>(), io::Need::required},
    {"pressure_drop", io::unit_info<Pressure>(), io::Need::optional},
    {"pressure_drop_uncertainty", io::unit_info<Pressure>(), io::Need::optional},
    {"outlet_pressure", io::unit_info<Pressure>(), io::Need::optional},
    {"time", io::unit_info<Time>(), io::Need::optional},
    {"run", kNoUnit, io::Need::optional}};
constexpr Word<SweepDirection> kSweepDirections[] = {{"up", SweepDirection::up},
                                                     {"down", SweepDirection::down}};

/// `Row` is a TableReader (inline) or a CsvRowReader: both know keys, units and bounds.
template <class Row>
HydrostaticMap hydrostatic_row(Row& row, const std::optional<Pressure>& default_uncertainty) {
  HydrostaticMap map;
  map.name = row.text("map", io::Need::required).value_or("");
  map.pressure =
      row.template quantity<Pressure>("pressure", io::bounds::kGaugePressure, io::Need::required)
          .value_or(Pressure{});
  map.pressure_uncertainty =
      row.template quantity<Pressure>("pressure_uncertainty", io::bounds::kPressureUncertainty);
  map.vented = map.pressure == Pressure{} && map.pressure_uncertainty == Pressure{};
  if (!map.pressure_uncertainty) map.pressure_uncertainty = default_uncertainty;
  map.sequence = row.integer("sequence");
  map.direction = row.choice("direction", kSweepDirections).value_or(SweepDirection::unknown);
  row.integer("repeat");  // a number for the user's own bookkeeping: equal levels are repeats
  return map;
}

template <class Row>
FlowMap flow_row(Row& row, const std::optional<Pressure>& default_uncertainty) {
  FlowMap map;
  map.name = row.text("map", io::Need::required).value_or("");
  map.flow_rate =
      row.template quantity<FlowRate>("flow_rate", io::bounds::kFlowRate, io::Need::required)
          .value_or(FlowRate{});
  map.pressure_drop = row.template quantity<Pressure>("pressure_drop", io::bounds::kPressureDrop);
  map.pressure_drop_uncertainty = row.template quantity<Pressure>("pressure_drop_uncertainty",
                                                                  io::bounds::kPressureUncertainty);
  if (!map.pressure_drop_uncertainty) map.pressure_drop_uncertainty = default_uncertainty;
  map.outlet_pressure =
      row.template quantity<Pressure>("outlet_pressure", io::bounds::kGaugePressure);
  map.time = row.template quantity<Time>("time", io::bounds::kTime);
  map.run = row.text("run").value_or("");
  if (map.run.empty()) {
    const auto [file, page] = io::map_address(map.name);
    map.run = file.stem().string() + (page == 0 ? std::string() : fmt::format("#{}", page));
  }
  return map;
}

template <class T, class ReadRow>
void read_csv(const std::filesystem::path& path, const std::string* text,
              std::span<const ListColumn> columns, MapList<T>& list, io::Faults& faults,
              const ReadRow& read_row) {
  list.whole = {path, 1, ""};
  const auto csv = CsvList::read(path, text, columns, faults);
  if (!csv) return;
  for (const io::CsvRow& row : csv->table().rows) {
    CsvRowReader reader(*csv, row, faults);
    list.maps.push_back(read_row(reader));
    list.maps.back().line = row.line;
    list.rows.push_back(csv->place(row.line, ""));
  }
  if (csv->table().rows.empty()) {
    faults.add(list.whole, "the list has no rows", "Add a row for every map below the header");
  }
}

template <class T, class ReadRow>
void read_inline(const io::TableReader& section, const io::TomlValue& maps, const std::string& path,
                 MapList<T>& list, io::Faults& faults, const ReadRow& read_row) {
  for (std::size_t i = 0; i < maps.items.size(); ++i) {
    const std::string prefix = fmt::format("{} entry {}: ", path, i + 1);
    const io::TomlValue& entry = maps.items[i];
    const io::Place place{section.file(), entry.line, prefix};
    if (entry.kind != io::TomlValue::Kind::table) {
      faults.add({place.file, place.line, fmt::format("{} entry {}", path, i + 1)},
                 fmt::format("{} stands where a map belongs", io::in_quotes(entry.text)),
                 "Write {map = \"a.gsf\", ...} for every map");
      continue;
    }
    io::TableReader reader(entry, prefix, section.file(), faults);
    list.maps.push_back(read_row(reader));
    reader.finish();
    list.maps.back().line = entry.line;
    list.rows.push_back(place);
  }
  if (maps.items.empty()) {
    faults.add(list.whole, "the list has no maps", "Write {map = \"a.gsf\", ...} for every map");
  }
}

template <class T, class ReadRow>
MapList<T> read_list(io::TableReader& section, const std::string& name, const char* example,
                     std::span<const ListColumn> columns, MapFiles& files, io::Faults& faults,
                     const ReadRow& read_row) {
  MapList<T> list;
  const std::size_t n_faults = faults.size();
  const bool both = section.has("list") && section.has("maps");
  const bool neither = !section.has("list") && !section.has("maps");
  const auto file = section.text("list");
  const io::TomlValue* maps = section.list("maps");
  section.finish();
  list.whole = section.place(section.has("maps") ? "maps" : "list");
  if (both) {
    faults.add(section.place("maps"), "both `list` and `maps` are given", "Keep one of the two");
  } else if (neither && faults.size() == n_faults) {
    faults.add(section.place("list"), "the section names no maps",
               fmt::format("Add list = \"{}.csv\", or maps = [{}, ...]", name, example));
  } else if (file) {
    const std::size_t before = faults.size();
    const auto path = files.find(*file, section.place("list"), faults);
    if (faults.size() == before) {
      read_csv(path, files.text_instead(path), columns, list, faults, read_row);
    }
  } else if (maps != nullptr) {
    read_inline(section, *maps, name + ".maps", list, faults, read_row);
  }
  list.complete = faults.size() == n_faults && !list.maps.empty();
  for (std::size_t i = 0; i < list.maps.size(); ++i) {
    T& map = list.maps[i];
    if (!map.name.empty()) map.map = files.find(map.name, list.place(i, "map"), faults);
  }
  return list;
}

}  // namespace

MapList<HydrostaticMap> read_hydrostatic(io::TableReader& section,
                                         const InstrumentSection& instrument, MapFiles& files,
                                         io::Faults& faults) {
  return read_list<HydrostaticMap>(
      section, "hydrostatic", "{map = \"h00.gsf\", pressure = \"0 Pa\"}", kHydrostaticColumns,
      files, faults, [&](auto& row) { return hydrostatic_row(row, instrument.pressure_noise); });
}

MapList<FlowMap> read_flow(io::TableReader& section, const InstrumentSection& instrument,
                           MapFiles& files, io::Faults& faults) {
  return read_list<FlowMap>(
      section, "flow", "{map = \"f00.gsf\", flow_rate = \"5 mL/min\"}", kFlowColumns, files, faults,
      [&](auto& row) { return flow_row(row, instrument.pressure_drop_uncertainty); });
}

}  // namespace manoscope::experiment

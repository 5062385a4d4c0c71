#pragma once

#include <filesystem>
#include <string>
#include <vector>

#include "manoscope/experiment/experiment.hpp"
#include "manoscope/experiment/map_files.hpp"
#include "manoscope/io/table_reader.hpp"

namespace manoscope::experiment {

/// The maps of one list, from CSV or inline, and where each of them stands for messages.
template <class T>
struct MapList {
  std::vector<T> maps;
  std::vector<io::Place> rows;  ///< one per map; `key` is what goes before a column's name
  io::Place whole;              ///< the list itself
  bool complete = false;        ///< every row was read without fault

  io::Place place(std::size_t i, const std::string& column) const {
    return {rows[i].file, rows[i].line, rows[i].key + column};
  }
};

/// Reads section [hydrostatic]: `list = "file.csv"` or `maps = [{map, pressure, ...}]`.
///
/// A row without `pressure_uncertainty` gets `instrument.pressure_noise`, if that is given. A map
/// is vented only where the row itself says 0 Pa with an uncertainty of 0. Every map is looked for
/// on disk.
MapList<HydrostaticMap> read_hydrostatic(io::TableReader& section,
                                         const InstrumentSection& instrument, MapFiles& files,
                                         io::Faults& faults);

/// Reads section [flow] in the same way. A row without `pressure_drop_uncertainty` gets
/// `instrument.pressure_drop_uncertainty`, if that is given. A row without `run` is a run of its
/// own, named after the map without its extension.
MapList<FlowMap> read_flow(io::TableReader& section, const InstrumentSection& instrument,
                           MapFiles& files, io::Faults& faults);

}  // namespace manoscope::experiment

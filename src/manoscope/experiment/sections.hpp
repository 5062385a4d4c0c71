#pragma once

#include "manoscope/experiment/experiment.hpp"
#include "manoscope/io/table_reader.hpp"

namespace manoscope::experiment {

/// The sections of the file that hold no lists, each key with its unit and its bounds. Faults go
/// to the reader; a value at fault is left at its default.
ChannelSection read_channel(io::TableReader& table, io::Faults& faults);
InletSection read_inlet(io::TableReader& table, io::Faults& faults);
WallSection read_wall(io::TableReader& table);
FluidSection read_fluid(io::TableReader& table, io::Faults& faults);
/// `reference` is taken as written; whether the map is there is checked by whoever knows the
/// folder.
InstrumentSection read_instrument(io::TableReader& table);

}  // namespace manoscope::experiment

#pragma once

#include "manoscope/experiment/experiment.hpp"
#include "manoscope/experiment/table_reader.hpp"

namespace manoscope::experiment {

/// The sections of the file that hold no lists, each key with its unit and its bounds. Faults go
/// to the reader; a value at fault is left at its default.
ChannelSection read_channel(TableReader& table, Faults& faults);
WallSection read_wall(TableReader& table);
FluidSection read_fluid(TableReader& table);
/// `reference` is taken as written; whether the map is there is checked by whoever knows the
/// folder.
InstrumentSection read_instrument(TableReader& table);
RigidSection read_rigid(TableReader& table);

}  // namespace manoscope::experiment

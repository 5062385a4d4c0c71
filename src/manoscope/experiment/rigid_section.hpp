#pragma once

#include "manoscope/experiment/experiment.hpp"
#include "manoscope/io/table_reader.hpp"

namespace manoscope::experiment {

/// Reads section [rigid]: the passages with what stands at their ends and in them, and simulated
/// drops. Faults go to the reader; a value at fault is left at its default.
///
/// Refused: a port longer than its passage or beside a step at the same end, a step to a section
/// smaller than the passage's own or to two sections at once, bends that are no whole number from
/// 0, an uncertainty of the height that is not below it, a simulation without flow rate or drop,
/// two at one flow rate. Whether the simulations reach the flow rates of the runs is for
/// simulated_drop() to say.
RigidSection read_rigid(io::TableReader& table, io::Faults& faults);

}  // namespace manoscope::experiment

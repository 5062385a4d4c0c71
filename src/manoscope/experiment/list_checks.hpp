#pragma once

#include "manoscope/experiment/lists.hpp"

namespace manoscope::experiment {

/// What only the lists as wholes can tell, and only files that exist.
///
/// Refused: a map named twice, whatever its spelling; a map in both lists; the reference map in a
/// list; fewer than three distinct pressures (a constitutive curve needs them); a run with two flow
/// rates.
void check_lists(const MapList<HydrostaticMap>& hydrostatic, const MapList<FlowMap>& flow,
                 io::Faults& faults);

/// The instrument's own flat reference shows no wall: it is none of the listed maps.
void check_reference(const std::filesystem::path& reference, const io::Place& place,
                     const MapList<HydrostaticMap>& hydrostatic, const MapList<FlowMap>& flow,
                     io::Faults& faults);

}  // namespace manoscope::experiment

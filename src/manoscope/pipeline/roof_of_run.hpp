#pragma once

#include <optional>
#include <string>

#include "manoscope/pipeline/flow_knowledge.hpp"
#include "manoscope/pipeline/stages.hpp"
#include "manoscope/validation/roof_effect.hpp"
#include "manoscope/validation/smooth_roof.hpp"

namespace manoscope::pipeline {

/// What the roof of a three-dimensional simulation is bent like across.
enum class RoofChoice {
  map_if_told,  ///< as the run's own maps show it, if they do; else as `response`
  map,
  response,  ///< one shape all along: as between the lowest and the highest level
};

/// The roof of a run across, in three dimensions.
struct RunRoof {
  std::optional<validation::SmoothRoof> map;     ///< none: the one shape
  std::optional<validation::RoofEffect> effect;  ///< of the map
  std::string words;
};

/// Takes the shape across from the maps of a run (validation::SmoothRoof).
/// @throws InputError if the gap below the map closes somewhere, or `map` is asked for and the maps
///         hold too few cells for it.
RunRoof roof_of_run(const FlowRun& run, const validation::SmoothShape& along,
                    const FlowKnowledge& known, RoofChoice choice);

}  // namespace manoscope::pipeline

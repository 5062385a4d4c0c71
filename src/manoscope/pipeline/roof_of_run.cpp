#include "manoscope/pipeline/roof_of_run.hpp"

#include <fmt/format.h>

#include <cmath>
#include <string>

#include "manoscope/core/error.hpp"

namespace manoscope::pipeline {
namespace {

/// A share as a change in percent; one that no print shows is told as such.
std::string change(double share) {
  constexpr double kShown = 5e-6;
  if (std::abs(share) < kShown) return "less than 0.001 %";
  return fmt::format("{:+.2g} %", 100.0 * share);
}

std::string map_words(const validation::SmoothRoof& roof, const validation::RoofEffect& effect) {
  return fmt::format(
      "across as its own maps show, by {} even and {} odd departures from the shape between lowest "
      "and highest level: {:.2g} nm rms taken away a cell, stated noise {:.2g} nm ({:.2g} nm "
      "within half a width of the ends); it departs by "
      "{:.3g} nm rms, which changes the drop of the channel by {}; what is odd across, {:.2g} ± "
      "{:.2g} nm rms, is left out and would change it by {}",
      roof.modes().n_even(), roof.modes().n_odd(), roof.taken().in(nm), roof.noise().in(nm),
      roof.end_taken().in(nm), roof.departure().in(nm), change(effect.departure), roof.odd().in(nm),
      2.0 * roof.odd_standard().in(nm), change(effect.odd));
}

}  // namespace

RunRoof roof_of_run(const FlowRun& run, const validation::SmoothShape& along,
                    const FlowKnowledge& known, RoofChoice choice) {
  const validation::FlowSetup& setup = known.setup;
  RunRoof result;
  result.words = fmt::format(
      "across as between lowest and highest level, crest {:.3g} times the "
      "mean",
      setup.shape.crest());
  if (choice == RoofChoice::response) return result;
  result.map = validation::SmoothRoof::through(along, run.sections, setup.channel, setup.shape);
  if (!result.map) {
    if (choice == RoofChoice::map) {
      throw InputError(run.name, "its maps show too few pixels across the channel for a roof",
                       "Take maps with 28 pixels or more across the width, or leave the roof to "
                       "the shape between the levels");
    }
    result.words += " (its own maps show too few pixels across)";
    return result;
  }
  result.effect =
      validation::roof_effect(*result.map, setup.shape, setup.fluid.viscosity, run.flow_rate);
  result.words = map_words(*result.map, *result.effect);
  return result;
}

}  // namespace manoscope::pipeline

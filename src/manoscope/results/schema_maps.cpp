#include "manoscope/results/schema_parts.hpp"

namespace manoscope::results {
namespace {

using M = Measurement;

}  // namespace

std::vector<Dimension> map_dimensions() {
  return {
      {"map", [](const M& m) { return static_cast<Index>(m.map.size()); }, "maps that were read"},
      {"response_x", [](const M& m) { return m.response_x.size(); },
       "cells of the picture of the wall's response along the flow"},
      {"response_z", [](const M& m) { return m.response_z.size(); }, "the same across"},
  };
}

std::vector<Variable> map_variables() {
  return {
      {"map", {"map"}, "1", "file name of the map", &M::map},
      {"map_pressure",
       {"map"},
       "Pa",
       "applied pressure, gauge; NaN of a map under flow",
       &M::map_pressure},
      {"map_tilt_x", {"map"}, "1", "slope of the rim's plane along the flow", &M::map_tilt_x},
      {"map_tilt_z", {"map"}, "1", "slope of the rim's plane across the flow", &M::map_tilt_z},
      {"map_noise", {"map"}, "m", "standard deviation of one pixel on the rim", &M::map_noise},
      {"map_missing", {"map"}, "1", "fraction of pixels without a height", &M::map_missing},
      {"map_spikes", {"map"}, "1", "fraction of pixels flagged as spikes", &M::map_spikes},
      {"map_shift",
       {"map"},
       "m",
       "distance by which the wall had moved along the flow, taken back",
       &M::map_shift},
      {"map_shift_uncertainty",
       {"map"},
       "m",
       "standard uncertainty of the map's position along the flow",
       &M::map_shift_uncertainty},
      {"map_shift_across",
       {"map"},
       "m",
       "distance by which the wall had moved across the flow, taken back",
       &M::map_shift_across},
      {"map_shift_across_uncertainty",
       {"map"},
       "m",
       "standard uncertainty of the map's position across the flow",
       &M::map_shift_across_uncertainty},
      {"map_rotation",
       {"map"},
       "rad",
       "angle by which the wall had turned in the map, taken back",
       &M::map_rotation},
      {"map_rotation_uncertainty",
       {"map"},
       "rad",
       "standard uncertainty of the wall's angle in the map",
       &M::map_rotation_uncertainty},
      {"map_mended",
       {"map"},
       "1",
       "fraction of pixels in patches of a false fringe order, mended",
       &M::map_mended},
      {"map_unmended",
       {"map"},
       "1",
       "fraction of pixels in patches of a false fringe order that could not be mended, left out",
       &M::map_unmended},
      {"map_rim_bend",
       {"map"},
       "m",
       "bend of the rim beyond its plane, at mid-channel on the centre line",
       &M::map_rim_bend},
      {"map_rim_bend_uncertainty",
       {"map"},
       "m",
       "standard uncertainty of the rim's bend",
       &M::map_rim_bend_uncertainty},
      {"response_x",
       {"response_x"},
       "m",
       "distance from the inlet edge along the flow",
       &M::response_x},
      {"response_z",
       {"response_z"},
       "m",
       "distance from the centre line across the flow",
       &M::response_z},
      {"wall_response",
       {"response_z", "response_x"},
       "m",
       "deflection at the highest pressure minus that at the lowest, means over cells",
       &M::wall_response},
  };
}

}  // namespace manoscope::results

#include "manoscope/results/schema.hpp"

#include <fmt/format.h>
#include <fmt/ranges.h>

#include "manoscope/core/error.hpp"
#include "manoscope/results/schema_checks.hpp"

namespace manoscope::results {
namespace {

using M = Measurement;

Index size_of(const auto& values) { return static_cast<Index>(values.size()); }

template <class List>
List joined(List list, const List& more) {
  list.insert(list.end(), more.begin(), more.end());
  return list;
}

}  // namespace

const std::vector<Dimension>& dimensions() {
  static const std::vector<Dimension> own{
      {"x", [](const M& m) { return m.x.size(); }, "stations along the flow"},
      {"x_other", [](const M& m) { return m.x.size(); }, "the same stations, second index"},
      {"level", [](const M& m) { return m.level_pressure.size(); }, "calibration pressures"},
      {"run", [](const M& m) { return size_of(m.run); }, "flow runs"},
      {"bound", [](const M&) { return Index{2}; }, "start and end"},
      {"budget_source", [](const M& m) { return size_of(m.budget_source); },
       "sources of uncertainty"},
      {"crossing", [](const M& m) { return size_of(m.crossing_run); },
       "crossings of flow and static profiles"},
      {"map", [](const M& m) { return size_of(m.map); }, "maps that were read"},
      {"response_x", [](const M& m) { return m.response_x.size(); },
       "cells of the picture of the wall's response along the flow"},
      {"response_z", [](const M& m) { return m.response_z.size(); }, "the same across"},
  };
  static const std::vector<Dimension> list = joined(own, check_dimensions());
  return list;
}

const Dimension& dimension(std::string_view name) {
  for (const Dimension& candidate : dimensions()) {
    if (candidate.name == name) return candidate;
  }
  throw InternalError(fmt::format("the result file has no dimension {}", name));
}

const std::vector<GlobalText>& global_texts() {
  static const std::vector<GlobalText> list{
      {"title", &M::title, "name of the experiment"},
      {"source", &M::source, "program, version and source revision"},
      {"history", &M::history, "the command that made the file"},
      {"experiment", &M::experiment, "the whole experiment.toml"},
      {"inputs", &M::inputs, "name and SHA-256 of every map, one a line"},
      {"settings", &M::settings, "every option in force, one a line"},
      {"reading", &M::reading, "how p(x) was read: by which wall, or why by none"},
      {"tube_law", &M::tube_law, "b of the tube law in words, or why there is none"},
  };
  return list;
}

const std::vector<Variable>& variables() {
  static const std::vector<Variable> own{
      {"x", {"x"}, "m", "distance from the channel's inlet edge along the flow", &M::x},
      {"run", {"run"}, "1", "label of the flow run", &M::run},

      {"channel_length", {}, "m", "length of the channel along the flow", &M::channel_length},
      {"channel_width", {}, "m", "width of the channel across the flow", &M::channel_width},
      {"channel_height",
       {},
       "m",
       "gap 2h0 under the undeflected wall",
       &M::channel_height,
       "channel_height_uncertainty"},
      {"channel_height_uncertainty",
       {},
       "m",
       "standard uncertainty of the gap 2h0, k = 1",
       &M::channel_height_uncertainty},
      {"viscosity",
       {},
       "Pa s",
       "dynamic viscosity of the fluid",
       &M::viscosity,
       "viscosity_uncertainty"},
      {"viscosity_uncertainty",
       {},
       "Pa s",
       "standard uncertainty of the viscosity, k = 1; 0 where it counts as exact",
       &M::viscosity_uncertainty},
      {"density", {}, "kg m-3", "density of the fluid", &M::density},
      {"coverage", {}, "1", "coverage probability of the intervals", &M::coverage},

      {"level_pressure",
       {"level"},
       "Pa",
       "applied hydrostatic gauge pressure",
       &M::level_pressure,
       "level_pressure_uncertainty"},
      {"level_pressure_uncertainty",
       {"level"},
       "Pa",
       "standard uncertainty of the applied hydrostatic pressure, k = 1; 0 where it counts as "
       "exact",
       &M::level_pressure_uncertainty},
      {"level_estimate",
       {"level"},
       "Pa",
       "pressure of the level that the constitutive curves go through: what all applied pressures "
       "together say of it",
       &M::level_estimate,
       "level_estimate_uncertainty"},
      {"level_estimate_uncertainty",
       {"level"},
       "Pa",
       "standard uncertainty of that pressure, k = 1, shared errors of the gauge left out",
       &M::level_estimate_uncertainty},
      {"static_deflection",
       {"level", "x"},
       "m",
       "width-averaged deflection of the wall at uniform pressure (constitutive curves)",
       &M::static_deflection,
       "static_deflection_uncertainty"},
      {"static_deflection_uncertainty",
       {"level", "x"},
       "m",
       "standard uncertainty of the static deflection, k = 1",
       &M::static_deflection_uncertainty},
      {"crest_deflection",
       {"level"},
       "m",
       "deflection at mid-channel on the centre line at uniform pressure",
       &M::crest_deflection,
       "crest_deflection_uncertainty"},
      {"crest_deflection_uncertainty",
       {"level"},
       "m",
       "standard uncertainty of the crest deflection, k = 1",
       &M::crest_deflection_uncertainty},

      {"flow_rate",
       {"run"},
       "m3 s-1",
       "volumetric flow rate",
       &M::flow_rate,
       "flow_rate_uncertainty"},
      {"flow_rate_uncertainty",
       {"run"},
       "m3 s-1",
       "standard uncertainty of the flow rate, k = 1, one error common to all runs; 0 where it "
       "counts "
       "as exact",
       &M::flow_rate_uncertainty},
      {"deflection",
       {"run", "x"},
       "m",
       "width-averaged deflection of the wall under flow, positive away from the fluid",
       &M::deflection,
       "deflection_uncertainty"},
      {"deflection_uncertainty",
       {"run", "x"},
       "m",
       "standard uncertainty of the deflection under flow, k = 1",
       &M::deflection_uncertainty},
      {"pressure",
       {"run", "x"},
       "Pa",
       "gauge pressure in the channel",
       &M::pressure,
       "pressure_uncertainty pressure_lower pressure_upper pressure_covariance pressure_flags"},
      {"pressure_uncertainty",
       {"run", "x"},
       "Pa",
       "combined standard uncertainty of the gauge pressure, k = 1",
       &M::pressure_uncertainty},
      {"pressure_lower",
       {"run", "x"},
       "Pa",
       "lower end of the coverage interval of the pressure",
       &M::pressure_lower},
      {"pressure_upper",
       {"run", "x"},
       "Pa",
       "upper end of the coverage interval of the pressure",
       &M::pressure_upper},
      {"pressure_local",
       {"run", "x"},
       "Pa",
       "gauge pressure with each station read on its own, as if the wall did not feel its "
       "neighbourhood",
       &M::pressure_local,
       "pressure_local_uncertainty"},
      {"pressure_local_uncertainty",
       {"run", "x"},
       "Pa",
       "standard uncertainty of that, k = 1",
       &M::pressure_local_uncertainty},
      {"pressure_band_factor",
       {"run"},
       "1",
       "k of the simultaneous band, pressure +- k pressure_uncertainty: it holds the whole of p(x) "
       "with the coverage probability",
       &M::pressure_band_factor},
      {"half_response_wavelength",
       {"run"},
       "m",
       "wavelength of a ripple of the pressure, at mid-channel, of which the wall shows half; "
       "missing where each station was read on its own",
       &M::half_response_wavelength},
      {"pressure_covariance",
       {"run", "x", "x_other"},
       "Pa2",
       "covariance of the gauge pressure between stations of one run",
       &M::pressure_covariance},
      {"pressure_flags",
       {"run", "x"},
       "1",
       "why a pressure is missing or needs care",
       &M::pressure_flags,
       {},
       "status_flag"},
      {"test_section",
       {"run", "bound"},
       "m",
       "start and end of the section where the pressure is "
       "trusted",
       &M::test_section},
      {"budget_source", {"budget_source"}, "1", "source of uncertainty", &M::budget_source},
      {"pressure_variance",
       {"budget_source", "run", "x"},
       "Pa2",
       "variance of the gauge pressure by source of uncertainty",
       &M::pressure_variance},

      {"crossing_run", {"crossing"}, "1", "run of the crossing, counted from 0", &M::crossing_run},
      {"crossing_x",
       {"crossing"},
       "m",
       "station where a flow profile crosses a static profile",
       &M::crossing_x,
       "crossing_x_uncertainty"},
      {"crossing_x_uncertainty",
       {"crossing"},
       "m",
       "standard uncertainty of the crossing station, k = 1",
       &M::crossing_x_uncertainty},
      {"crossing_pressure",
       {"crossing"},
       "Pa",
       "gauge pressure of the crossed static profile",
       &M::crossing_pressure},

      {"extracted_drop",
       {"run"},
       "Pa",
       "pressure drop over the test section read off the wall",
       &M::extracted_drop,
       "extracted_drop_uncertainty"},
      {"extracted_drop_uncertainty",
       {"run"},
       "Pa",
       "standard uncertainty of the extracted drop, k = 1",
       &M::extracted_drop_uncertainty},
      {"resistance_drop",
       {"run"},
       "Pa",
       "flow rate times hydraulic resistance of the test section",
       &M::resistance_drop,
       "resistance_drop_uncertainty"},
      {"resistance_drop_uncertainty",
       {"run"},
       "Pa",
       "standard uncertainty of the resistance drop, k = 1",
       &M::resistance_drop_uncertainty},
      {"channel_resistance_drop",
       {"run"},
       "Pa",
       "flow rate times hydraulic resistance of the whole channel",
       &M::channel_resistance_drop},
      {"resistance_pressure",
       {"run", "x"},
       "Pa",
       "gauge pressure from the hydraulic resistance, tied to the reading at the end of the test "
       "section",
       &M::resistance_pressure},
      {"reynolds",
       {"run"},
       "1",
       "Reynolds number 2Q / (nu [w + 2h]), mean over the channel",
       &M::reynolds},
      {"transducer_drop",
       {"run"},
       "Pa",
       "pressure drop read by the transducer, parasitic part included",
       &M::transducer_drop},
      {"parasitic_drop",
       {"run"},
       "Pa",
       "pressure drop in the rigid inlet and outlet passages",
       &M::parasitic_drop},
      {"en_number",
       {"run"},
       "1",
       "extracted minus resistance drop over the expanded uncertainty of the difference, absolute",
       &M::en_number},

      {"stiffness",
       {"level", "x"},
       "Pa m-1",
       "dp/dzeta of the wall at uniform pressure: a(x) of the tube law, the wall's ends included",
       &M::stiffness,
       "stiffness_uncertainty"},
      {"stiffness_uncertainty",
       {"level", "x"},
       "Pa m-1",
       "standard uncertainty of the stiffness, k = 1, by the errors of the level and its "
       "neighbours",
       &M::stiffness_uncertainty},
      {"tube_law_deflection",
       {"run"},
       "m",
       "deflection, freed from the wall's ends, to which a and b of the tube law belong",
       &M::tube_law_deflection},
      {"tube_law_a", {"run"}, "Pa m-1", "a of the tube law, dp/dzeta there", &M::tube_law_a},
      {"tube_law_b",
       {"run"},
       "N m-1",
       "b of the tube law p = f(zeta) + b zeta'' under flow; negative under tension",
       &M::tube_law_b,
       "tube_law_b_uncertainty tube_law_misfit"},
      {"tube_law_b_uncertainty",
       {"run"},
       "N m-1",
       "standard uncertainty of b, k = 1, the law's misfit included",
       &M::tube_law_b_uncertainty},
      {"tube_law_misfit",
       {"run"},
       "N m-1",
       "by how much b differs from place to place; 0 where errors may explain it",
       &M::tube_law_misfit},
      {"healing_length",
       {"run"},
       "m",
       "sqrt(-b/a): length over which the wall forgets a disturbance; missing where b is not "
       "negative",
       &M::healing_length},
      {"tube_law_at_rest_deflection",
       {"level"},
       "m",
       "deflection at uniform pressure, freed from the wall's ends",
       &M::tube_law_at_rest_deflection},
      {"tube_law_at_rest_a",
       {"level"},
       "Pa m-1",
       "a of the tube law, dp/dzeta there",
       &M::tube_law_at_rest_a},
      {"tube_law_at_rest_b",
       {"level"},
       "N m-1",
       "b of the tube law from the ends of the wall at uniform pressure",
       &M::tube_law_at_rest_b,
       "tube_law_at_rest_b_uncertainty tube_law_at_rest_misfit"},
      {"tube_law_at_rest_b_uncertainty",
       {"level"},
       "N m-1",
       "standard uncertainty of that b, k = 1, the law's misfit included",
       &M::tube_law_at_rest_b_uncertainty},
      {"tube_law_at_rest_misfit",
       {"level"},
       "N m-1",
       "by how much that b differs from place to place; 0 where errors may explain it",
       &M::tube_law_at_rest_misfit},
      {"tube_law_at_rest_b_small",
       {},
       "N m-1",
       "limit of that b for small deflections, from all levels",
       &M::tube_law_at_rest_b_small,
       "tube_law_at_rest_b_small_uncertainty"},
      {"tube_law_at_rest_b_small_uncertainty",
       {},
       "N m-1",
       "standard uncertainty of the limit, k = 1",
       &M::tube_law_at_rest_b_small_uncertainty},

      {"map", {"map"}, "1", "file name of the map", &M::map},
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
  static const std::vector<Variable> list = joined(own, check_variables());
  return list;
}

namespace {

/// Shape of a member as a list; a member without values has shape {0, ...}.
struct ShapeOf {
  const Measurement& measurement;
  std::vector<std::vector<Index>> operator()(double M::*) const { return {{}}; }
  std::vector<std::vector<Index>> operator()(Array1 M::*member) const {
    return {{(measurement.*member).size()}};
  }
  std::vector<std::vector<Index>> operator()(Array2 M::*member) const {
    return {{(measurement.*member).rows(), (measurement.*member).cols()}};
  }
  std::vector<std::vector<Index>> operator()(Flags2 M::*member) const {
    return {{(measurement.*member).rows(), (measurement.*member).cols()}};
  }
  std::vector<std::vector<Index>> operator()(std::vector<std::string> M::*member) const {
    return {{size_of(measurement.*member)}};
  }
  std::vector<std::vector<Index>> operator()(std::vector<int> M::*member) const {
    return {{size_of(measurement.*member)}};
  }
  std::vector<std::vector<Index>> operator()(std::vector<Matrix> M::*member) const {
    return stack(measurement.*member);
  }
  std::vector<std::vector<Index>> operator()(std::vector<Array2> M::*member) const {
    return stack(measurement.*member);
  }
  static std::vector<std::vector<Index>> stack(const auto& layers) {
    std::vector<std::vector<Index>> shapes;
    for (const auto& layer : layers)
      shapes.push_back({size_of(layers), layer.rows(), layer.cols()});
    if (shapes.empty()) shapes.push_back({0, 0, 0});
    return shapes;
  }
};

Index product(const std::vector<Index>& shape) {
  Index n = 1;
  for (const Index length : shape) n *= length;
  return n;
}

}  // namespace

void check_shapes(const Measurement& measurement) {
  for (const Variable& variable : variables()) {
    std::vector<Index> expected;
    for (const auto name : variable.dimensions) {
      expected.push_back(dimension(name).length(measurement));
    }
    for (const auto& found : std::visit(ShapeOf{measurement}, variable.member)) {
      const bool both_empty = product(expected) == 0 && product(found) == 0;
      if (found != expected && !both_empty) {
        throw InternalError(fmt::format("result variable {} has shape ({}), its dimensions ({})",
                                        variable.name, fmt::join(found, ", "),
                                        fmt::join(expected, ", ")));
      }
    }
  }
}

std::string schema_as_markdown() {
  std::string text = "| variable | dimensions | unit | meaning |\n|---|---|---|---|\n";
  for (const Variable& variable : variables()) {
    text += fmt::format("| `{}` | {} | {} | {} |\n", variable.name,
                        fmt::join(variable.dimensions, ", "), variable.units, variable.long_name);
  }
  return text;
}

}  // namespace manoscope::results

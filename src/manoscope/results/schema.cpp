#include "manoscope/results/schema.hpp"

#include <fmt/format.h>
#include <fmt/ranges.h>

#include "manoscope/core/error.hpp"
#include "manoscope/results/schema_parts.hpp"

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
  static const std::vector<Dimension> kOwn{
      {"x", [](const M& m) { return m.x.size(); }, "stations along the flow"},
      {"x_other", [](const M& m) { return m.x.size(); }, "the same stations, second index"},
      {"level", [](const M& m) { return m.level_pressure.size(); }, "calibration pressures"},
      {"run", [](const M& m) { return size_of(m.run); }, "flow runs"},
      {"bound", [](const M&) { return Index{2}; }, "start and end"},
      {"budget_source", [](const M& m) { return size_of(m.budget_source); },
       "sources of uncertainty"},
      {"crossing", [](const M& m) { return size_of(m.crossing_run); },
       "crossings of flow and static profiles"},
  };
  static const std::vector<Dimension> list =
      joined(joined(kOwn, flow_dimensions()), joined(map_dimensions(), check_dimensions()));
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
      {"flow_setup", &M::flow_setup, "section and inlet that the flow models take, in words"},
      {"verdict_model", &M::verdict_model, "flow model of verdict, inference and prediction"},
  };
  return list;
}

const std::vector<Variable>& variables() {
  static const std::vector<Variable> kOwn{
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
  };
  static const std::vector<Variable> list =
      joined(joined(joined(kOwn, flow_variables()), joined(tube_law_variables(), map_variables())),
             check_variables());
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

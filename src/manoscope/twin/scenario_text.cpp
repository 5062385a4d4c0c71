#include "manoscope/twin/scenario_text.hpp"

#include <fmt/format.h>

#include <sstream>
#include <vector>

#include "manoscope/core/frame_words.hpp"
#include "manoscope/io/toml_edit.hpp"
#include "manoscope/twin/toml_text.hpp"

namespace manoscope::twin {
namespace {

using io::toml_quoted;
using toml_text::best;
using toml_text::in_unit;

std::string text_of(double value) { return fmt::format("{:.10g}", value); }
std::string text_of(int value) { return fmt::format("{}", value); }
std::string text_of(bool value) { return value ? "true" : "false"; }
std::string text_of(const std::string& value) { return toml_quoted(value); }
std::string text_of(Pressure value) { return best(value); }
std::string text_of(Length value) { return value == Length{} ? in_unit(0.0, "um") : best(value); }
std::string text_of(Angle value) { return in_unit(value.in(1e-3 * rad), "mrad"); }

std::string line(const char* key, const std::string& value) {
  return fmt::format("{} = {}\n", key, value);
}

/// Every option of a struct with describe().
template <class Options>
std::string option_lines(Options options) {
  std::string text;
  options.describe([&](const char* name, const auto& value, const char*) {
    text += line(name, text_of(value));
  });
  return text;
}

std::string channel_section(const Scenario& scenario) {
  return "[channel]\n" + line("length", best(scenario.channel.length)) +
         line("width", best(scenario.channel.width)) +
         line("height", best(scenario.channel.height)) +
         line("height_uncertainty", text_of(scenario.height_uncertainty));
}

std::string wall_section(const Scenario& scenario) {
  const wall::ClampedWall& wall = scenario.wall;
  const bool membrane = scenario.wall_law == WallLaw::tapered_membrane;
  std::string text = "[wall]\n";
  if (!scenario.wall_material.empty())
    text += line("material", toml_quoted(scenario.wall_material));
  text +=
      line("law", toml_quoted(membrane ? "tapered_membrane" : "foppl_von_karman")) +
      line("thickness", best(wall.thickness)) + line("youngs_modulus", best(wall.youngs_modulus)) +
      line("poisson_ratio", text_of(wall.poisson_ratio)) + line("prestress", best(wall.prestress)) +
      line("shear_correction", text_of(wall.shear_correction)) +
      line("preload", best(wall.preload.load)) +
      line("preload_lopsidedness", text_of(wall.preload.lopsidedness)) +
      line("initial_crest", text_of(wall.initial_shape.crest)) +
      line("initial_lopsidedness", text_of(wall.initial_shape.lopsidedness));
  return text + option_lines(scenario.wall_grid);
}

std::string fluid_section(const Scenario& scenario) {
  std::string text = "[fluid]\n";
  if (!scenario.fluid_name.empty()) text += line("name", toml_quoted(scenario.fluid_name));
  return text + line("viscosity", in_unit(scenario.fluid.viscosity.in(mPa_s), "mPa s")) +
         line("density", in_unit(scenario.fluid.density.si(), "kg/m3"));
}

/// A list in square brackets, six a line.
std::string list_of(const std::vector<std::string>& values) {
  constexpr std::size_t kAcross = 6;
  std::string text = "[";
  for (std::size_t i = 0; i < values.size(); ++i) {
    text += (i % kAcross == 0 ? "\n  " : " ") + values[i] + ",";
  }
  return text + "\n]";
}

std::string runs_sections(const Scenario& scenario) {
  std::vector<std::string> levels, flow_rates;
  for (const Pressure level : scenario.levels) levels.push_back(in_unit(level.si(), "Pa"));
  std::string text = "[hydrostatic]\n" + line("levels", list_of(levels));
  if (scenario.flow_rates.empty()) return text;
  for (const FlowRate flow_rate : scenario.flow_rates) {
    flow_rates.push_back(in_unit(flow_rate.in(mL_per_min), "mL/min"));
  }
  const double resistance = scenario.outlet.tubing_resistance / (Pa / mL_per_min).si();
  return text + "\n[flow]\n" + line("flow_rates", list_of(flow_rates)) +
         line("outlet_pressure", best(scenario.outlet.head)) +
         line("tubing_resistance", in_unit(resistance, "Pa/(mL/min)"));
}

std::string rigid_section(const Scenario& scenario) {
  if (!scenario.inlet_passage && !scenario.outlet_passage) return "";
  const auto passage = [](const char* name, const std::optional<flow::RigidPassage>& rigid) {
    if (!rigid) return std::string();
    return line(name, fmt::format("{{length = {}, width = {}, height = {}}}", best(rigid->length),
                                  best(rigid->width), best(rigid->height)));
  };
  return "\n[rigid]\n" + passage("inlet", scenario.inlet_passage) +
         passage("outlet", scenario.outlet_passage);
}

std::string camera_section(const Scenario& scenario) {
  const InterferometerOptions& camera = scenario.camera;
  return "[camera]\n" + option_lines(camera) +
         line("flow", toml_quoted(word_of(kFlowDirections, camera.flow))) +
         line("outward", toml_quoted(word_of(kOutwards, camera.outward)));
}

}  // namespace

std::string scenario_toml(const Scenario& scenario, const std::string& comment) {
  std::string text;
  std::istringstream lines(comment);
  for (std::string one; std::getline(lines, one);) text += "# " + one + "\n";
  text += "scenario = 1\n" + line("name", toml_quoted(scenario.name)) + "\n";
  text += channel_section(scenario) + "\n" + wall_section(scenario) + "\n";
  text += fluid_section(scenario) + "\n" + runs_sections(scenario) + rigid_section(scenario);
  text += "\n" + camera_section(scenario) + "\n[gauge]\n" + option_lines(scenario.gauge);
  text += "\n[pump]\n" + option_lines(scenario.pump);
  return text + "\n[solver]\n" + option_lines(scenario.solver);
}

}  // namespace manoscope::twin

#include "manoscope/twin/experiment_files.hpp"

#include <fmt/format.h>

#include <system_error>

#include "manoscope/core/atomic_file.hpp"
#include "manoscope/core/error.hpp"
#include "manoscope/io/writer.hpp"

namespace manoscope::twin {
namespace {

/// Ten digits: shorter than round-trip, so that 0.175 mm reads as 175 um.
std::string in_unit(double number, const char* unit) {
  return fmt::format("\"{:.10g} {}\"", number, unit);
}

/// A TOML basic string.
std::string quoted(const std::string& text) {
  std::string result = "\"";
  for (const char letter : text) {
    if (letter == '"' || letter == '\\') {
      result += '\\';
      result += letter;
    } else if (static_cast<unsigned char>(letter) < 0x20) {
      result += fmt::format("\\u{:04x}", static_cast<unsigned>(letter));
    } else {
      result += letter;
    }
  }
  return result + '"';
}

const char* direction_text(FlowDirection flow) {
  switch (flow) {
    case FlowDirection::plus_columns:
      return "+columns";
    case FlowDirection::minus_columns:
      return "-columns";
    case FlowDirection::plus_rows:
      return "+rows";
    case FlowDirection::minus_rows:
      return "-rows";
  }
  return "";
}

std::string channel_section(const Scenario& scenario, Length stated_height) {
  const ChannelFrame frame = channel_frame(scenario.channel, scenario.camera);
  std::string text = "[channel]\n";
  text += fmt::format("length = {}\n", in_unit(scenario.channel.length.in(mm), "mm"));
  text += fmt::format("width = {}\n", in_unit(scenario.channel.width.in(mm), "mm"));
  text += fmt::format("height = \"{:.2f} um\"\n", stated_height.in(um));
  if (scenario.height_uncertainty > Length{}) {
    text +=
        fmt::format("height_uncertainty = {}\n", in_unit(scenario.height_uncertainty.in(um), "um"));
  }
  text += fmt::format("origin = [{}, {}]\n", in_unit(frame.origin_x.in(mm), "mm"),
                      in_unit(frame.origin_y.in(mm), "mm"));
  text += fmt::format("flow = \"{}\"\n", direction_text(frame.flow));
  if (frame.rotation != Angle{}) {
    text += fmt::format("rotation = {}\n", in_unit(frame.rotation.in(deg), "deg"));
  }
  text += fmt::format("outward = \"{}\"\n",
                      frame.outward == Outward::plus_height ? "+height" : "-height");
  return text;
}

std::string wall_section(const Scenario& scenario) {
  const wall::Membrane& membrane = scenario.membrane;
  std::string text = "[wall]\n";
  if (!scenario.wall_material.empty()) {
    text += fmt::format("material = {}\n", quoted(scenario.wall_material));
  }
  text += fmt::format("thickness = {}\n", in_unit(membrane.thickness.in(um), "um"));
  text += fmt::format("youngs_modulus = {}\n", in_unit(membrane.youngs_modulus.in(GPa), "GPa"));
  text += fmt::format("poisson_ratio = {:.10g}\n", membrane.poisson_ratio);
  text += fmt::format("prestress = {}\n", in_unit(membrane.prestress.in(MPa), "MPa"));
  return text;
}

std::string instrument_section(const Scenario& scenario) {
  const GaugeOptions& gauge = scenario.gauge;
  std::string text = "[instrument]\n";
  if (scenario.camera.noise > Length{}) {
    text += fmt::format("height_noise = {}\n", in_unit(scenario.camera.noise.in(nm), "nm"));
  }
  text += fmt::format("pressure_noise = {}\n", in_unit(gauge.noise.in(Pa), "Pa"));
  if (gauge.gain_uncertainty > 0.0) {
    text += fmt::format("pressure_gain_uncertainty = {:.10g}\n", gauge.gain_uncertainty);
  }
  if (gauge.zero_uncertainty > Pressure{}) {
    text += fmt::format("pressure_zero_uncertainty = {}\n",
                        in_unit(gauge.zero_uncertainty.in(Pa), "Pa"));
  }
  return text;
}

std::string rigid_section(const Scenario& scenario) {
  if (!scenario.inlet_passage && !scenario.outlet_passage) return "";
  const auto line = [](const char* name, const std::optional<flow::RigidPassage>& passage) {
    if (!passage) return std::string();
    return fmt::format("{} = {{length = {}, width = {}, height = {}}}\n", name,
                       in_unit(passage->length.in(mm), "mm"), in_unit(passage->width.in(mm), "mm"),
                       in_unit(passage->height.in(um), "um"));
  };
  return "\n[rigid]\n" + line("inlet", scenario.inlet_passage) +
         line("outlet", scenario.outlet_passage);
}

}  // namespace

std::string run_label(FlowRate flow_rate) {
  return fmt::format("Q{:.6g}", flow_rate.in(mL_per_min));
}

std::string experiment_toml(const Scenario& scenario, Length stated_height) {
  std::string text = "manoscope = 1\n";
  text += fmt::format("name = {}\n\n", quoted(scenario.name));
  text += channel_section(scenario, stated_height) + "\n";
  text += wall_section(scenario) + "\n";
  text += "[fluid]\n";
  if (!scenario.fluid_name.empty()) text += fmt::format("name = {}\n", quoted(scenario.fluid_name));
  text += fmt::format("viscosity = {}\n", in_unit(scenario.fluid.viscosity.in(mPa_s), "mPa s"));
  text += fmt::format("density = {}\n\n", in_unit(scenario.fluid.density.si(), "kg/m3"));
  text += instrument_section(scenario) + "\n";
  text += "[hydrostatic]\nlist = \"hydrostatic.csv\"\n";
  if (!scenario.flow_rates.empty()) text += "\n[flow]\nlist = \"flow.csv\"\n";
  return text + rigid_section(scenario);
}

std::string hydrostatic_csv(const Scenario& scenario, const std::vector<LevelTruth>& levels) {
  std::string text = "map,pressure [Pa],pressure_uncertainty [Pa],sequence\n";
  for (std::size_t i = 0; i < levels.size(); ++i) {
    const bool vented = levels[i].pressure == Pressure{};
    text += fmt::format("{},{:.1f},{:.10g},{}\n", levels[i].map, levels[i].label.si(),
                        vented ? 0.0 : scenario.gauge.noise.si(), i);
  }
  return text;
}

std::string flow_csv(const std::vector<RunScalars>& runs) {
  std::string text = "map,flow_rate [mL/min],pressure_drop [Pa],run\n";
  for (std::size_t i = 0; i < runs.size(); ++i) {
    text += fmt::format("f{:02d}.gsf,{:.10g},{:.1f},{}\n", i, runs[i].flow_rate.in(mL_per_min),
                        runs[i].transducer_reading.si(), run_label(runs[i].flow_rate));
  }
  return text;
}

void write_experiment(const std::filesystem::path& folder, const VirtualExperiment& experiment,
                      bool overwrite) {
  const auto toml = folder / "experiment.toml";
  std::error_code error;
  if (std::filesystem::exists(toml, error) && !overwrite) {
    throw InputError(toml.string(), "an experiment stands there already",
                     "Choose another folder, or ask to overwrite it");
  }
  error.clear();
  std::filesystem::create_directories(folder / "truth", error);
  if (error) {
    throw InputError((folder / "truth").string(),
                     fmt::format("the folder cannot be made ({})", error.message()),
                     "Choose a place where you may write");
  }
  // A folder with an experiment.toml is complete: withdraw the old one before its maps change.
  std::filesystem::remove(toml, error);
  if (error) {
    throw InputError(toml.string(), fmt::format("it cannot be replaced ({})", error.message()),
                     "Choose a place where you may write");
  }
  for (const NamedMap& map : experiment.maps) io::write_map(folder / map.name, map.map, map.title);
  const auto truth = folder / "truth";
  write_file_atomically(truth / "truth.csv", truth_csv(experiment.truth));
  write_file_atomically(truth / "truth_scalars.csv",
                        truth_scalars_csv(experiment.scalars, experiment.height));
  write_file_atomically(truth / "truth_levels.csv", truth_levels_csv(experiment.levels));
  write_file_atomically(truth / "truth_static.csv",
                        truth_static_csv(experiment.truth.x, experiment.levels));
  write_file_atomically(folder / "hydrostatic.csv", experiment.hydrostatic_csv);
  if (!experiment.truth.runs.empty()) {
    write_file_atomically(folder / "flow.csv", experiment.flow_csv);
  }
  write_file_atomically(toml, experiment.experiment_toml);
}

}  // namespace manoscope::twin

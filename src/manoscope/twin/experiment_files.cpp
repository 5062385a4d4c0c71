#include "manoscope/twin/experiment_files.hpp"

#include <fmt/format.h>

#include <cmath>
#include <system_error>
#include <utility>
#include <vector>

#include "manoscope/core/atomic_file.hpp"
#include "manoscope/core/error.hpp"
#include "manoscope/core/frame_words.hpp"
#include "manoscope/core/provenance.hpp"
#include "manoscope/io/toml_edit.hpp"
#include "manoscope/io/writer.hpp"
#include "manoscope/twin/toml_text.hpp"

namespace manoscope::twin {
namespace {

namespace fs = std::filesystem;
using io::toml_quoted;
using toml_text::best;
using toml_text::in_unit;

const char* const kStaging = ".manoscope-twin";
const char* const kToml = "experiment.toml";

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
  text += fmt::format("flow = \"{}\"\n", word_of(kFlowDirections, frame.flow));
  if (frame.rotation != Angle{}) {
    text += fmt::format("rotation = {}\n", in_unit(frame.rotation.in(deg), "deg"));
  }
  text += fmt::format("outward = \"{}\"\n", word_of(kOutwards, frame.outward));
  return text;
}

std::string wall_section(const Scenario& scenario) {
  const wall::ClampedWall& wall = scenario.wall;
  std::string text = "[wall]\n";
  if (!scenario.wall_material.empty()) {
    text += fmt::format("material = {}\n", toml_quoted(scenario.wall_material));
  }
  text += fmt::format("thickness = {}\n", best(wall.thickness));
  text += fmt::format("youngs_modulus = {}\n", best(wall.youngs_modulus));
  text += fmt::format("poisson_ratio = {:.10g}\n", wall.poisson_ratio);
  text += fmt::format("prestress = {}\n", best(wall.prestress));
  return text;
}

std::string instrument_section(const Scenario& scenario) {
  const GaugeOptions& gauge = scenario.gauge;
  std::string text = "[instrument]\n";
  if (scenario.camera.noise > Length{}) {
    text += fmt::format("height_noise = {}\n", best(scenario.camera.noise));
  }
  text += fmt::format("wavelength = {}\n", in_unit(scenario.camera.wavelength.in(nm), "nm"));
  text += fmt::format("pressure_noise = {}\n", best(gauge.noise));
  if (gauge.gain_uncertainty > 0.0) {
    text += fmt::format("pressure_gain_uncertainty = {:.10g}\n", gauge.gain_uncertainty);
  }
  if (gauge.zero_uncertainty > Pressure{}) {
    text += fmt::format("pressure_zero_uncertainty = {}\n", best(gauge.zero_uncertainty));
  }
  if (!scenario.flow_rates.empty()) {
    text += fmt::format("pressure_drop_uncertainty = {}\n", best(gauge.transducer_noise));
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

/// Folders that were not there; gone again, if empty, unless they are kept.
class NewFolders {
 public:
  /// @throws InputError if the folder cannot be made.
  explicit NewFolders(const fs::path& folder) {
    std::error_code error;
    std::vector<fs::path> missing;
    for (fs::path path = folder; !path.empty() && !fs::exists(path, error);
         path = path.parent_path()) {
      missing.push_back(path);
    }
    error.clear();
    for (auto path = missing.rbegin(); path != missing.rend(); ++path) {
      if (fs::create_directory(*path, error)) made_.push_back(*path);
      if (error) break;
    }
    if (!error && !fs::is_directory(folder, error)) {
      error = std::make_error_code(std::errc::not_a_directory);
    }
    if (!error) return;
    withdraw();
    throw InputError(folder.string(),
                     fmt::format("the folder cannot be made ({})", error.message()),
                     "Choose a place where you may write");
  }
  ~NewFolders() { withdraw(); }
  NewFolders(const NewFolders&) = delete;
  NewFolders& operator=(const NewFolders&) = delete;

  void keep() { made_.clear(); }

 private:
  void withdraw() {
    std::error_code ignored;
    for (auto path = made_.rbegin(); path != made_.rend(); ++path) fs::remove(*path, ignored);
    made_.clear();
  }

  std::vector<fs::path> made_;
};

/// A folder for files that are not yet in place; gone with all it holds.
class Staging {
 public:
  explicit Staging(fs::path folder) : folder_(std::move(folder)) {
    std::error_code ignored;
    fs::remove_all(folder_, ignored);  // of a run that was killed
    NewFolders made(folder_ / "truth");
    made.keep();
  }
  ~Staging() {
    std::error_code ignored;
    fs::remove_all(folder_, ignored);
  }
  Staging(const Staging&) = delete;
  Staging& operator=(const Staging&) = delete;

  const fs::path& folder() const { return folder_; }

 private:
  fs::path folder_;
};

/// Every file of an experiment but experiment.toml, and the name of each.
std::vector<fs::path> write_all(const fs::path& folder, const VirtualExperiment& experiment,
                                const Monitor& monitor) {
  std::vector<fs::path> names;
  TruthHeader header = experiment.header;
  for (const NamedMap& map : experiment.maps) {
    monitor.checkpoint();
    io::write_map(folder / map.name, map.map, map.title);
    header.inputs += fmt::format("{}  {}\n", map.name, sha256(read_file(folder / map.name)));
    names.emplace_back(map.name);
  }
  const auto text = [&](const fs::path& name, const std::string& bytes) {
    write_file_atomically(folder / name, bytes);
    names.push_back(name);
  };
  const Truth& truth = experiment.truth;
  text("truth/truth.csv", truth_csv(truth));
  write_truth_netcdf(folder / "truth/truth.nc", truth, experiment.scalars, header);
  names.emplace_back("truth/truth.nc");
  text("truth/truth_scalars.csv", truth_scalars_csv(experiment.scalars, header.channel.height));
  text("truth/truth_levels.csv", truth_levels_csv(truth.levels));
  text("truth/truth_static.csv", truth_static_csv(truth.x, truth.levels));
  text("hydrostatic.csv", experiment.hydrostatic_csv);
  if (!truth.runs.empty()) text("flow.csv", experiment.flow_csv);
  return names;
}

/// Refuses a folder that holds an experiment, or maps and lists of names that would be replaced.
void check_free(const fs::path& folder, bool overwrite) {
  std::error_code error;
  if (overwrite) return;
  if (fs::exists(folder / kToml, error)) {
    throw InputError((folder / kToml).string(), "an experiment stands there already",
                     "Choose another folder, or add --overwrite");
  }
  for (fs::directory_iterator file(folder, error), end; !error && file != end;
       file.increment(error)) {
    const std::string name = file->path().filename().string();
    if (file->path().extension() != ".gsf" && name != "hydrostatic.csv" && name != "flow.csv") {
      continue;
    }
    throw InputError(file->path().string(), "maps or lists stand there already",
                     "Choose an empty folder, or add --overwrite to replace those of equal name");
  }
}

}  // namespace

std::string run_label(FlowRate flow_rate) {
  return fmt::format("Q{:.6g}", flow_rate.in(mL_per_min));
}

std::string experiment_name(const Scenario& scenario, std::uint64_t seed) {
  return fmt::format("{}, seed {}", scenario.name, seed);
}

std::string experiment_toml(const Scenario& scenario, const std::string& name,
                            Length stated_height) {
  std::string text = "manoscope = 1\n";
  text += fmt::format("name = {}\n\n", toml_quoted(name));
  text += channel_section(scenario, stated_height) + "\n";
  text += wall_section(scenario) + "\n";
  text += "[fluid]\n";
  if (!scenario.fluid_name.empty())
    text += fmt::format("name = {}\n", toml_quoted(scenario.fluid_name));
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

void check_destination(const fs::path& folder, bool overwrite) {
  check_free(folder, overwrite);
  const NewFolders made(folder);
  // Withdrawn again without commit().
  const AtomicFile beside(folder / "hydrostatic.csv");
  std::error_code error;
  if (fs::exists(folder / "truth", error)) {
    const AtomicFile apart(folder / "truth" / "truth.csv");
  }
}

void write_experiment(const fs::path& folder, const VirtualExperiment& experiment, bool overwrite,
                      const Monitor& monitor) {
  check_destination(folder, overwrite);
  NewFolders made(folder);
  const Staging staging(folder / kStaging);
  const std::vector<fs::path> names = write_all(staging.folder(), experiment, monitor);
  write_file_atomically(staging.folder() / kToml, experiment.experiment_toml);

  std::error_code error;
  const auto check = [&](const fs::path& path) {
    if (!error) return;
    throw InputError(path.string(), fmt::format("it cannot be replaced ({})", error.message()),
                     "Choose a place where you may write");
  };
  NewFolders truth(folder / "truth");
  // A folder with an experiment.toml is complete: the old one goes before its maps change.
  fs::remove(folder / kToml, error);
  check(folder / kToml);
  for (const fs::path& name : names) {
    fs::rename(staging.folder() / name, folder / name, error);
    check(folder / name);
  }
  fs::rename(staging.folder() / kToml, folder / kToml, error);
  check(folder / kToml);
  truth.keep();
  made.keep();
}

}  // namespace manoscope::twin

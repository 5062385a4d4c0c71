#include "manoscope/twin/scenario_file.hpp"

#include <fmt/format.h>
#include <fmt/ranges.h>

#include <array>
#include <fstream>
#include <iterator>
#include <utility>

#include "manoscope/core/error.hpp"
#include "manoscope/core/frame_words.hpp"
#include "manoscope/core/suggest.hpp"
#include "manoscope/io/table_reader.hpp"
#include "manoscope/twin/hydraulic_resistance.hpp"

namespace manoscope::twin {
namespace {

namespace fs = std::filesystem;
using io::Need;
using io::TableReader;

constexpr int kSchema = 1;
/// Of options: their own validate() knows the range.
constexpr io::Bounds kAny{-1e300, 1e300, false, "Give a finite value"};
constexpr io::Bounds kNotNegative{0.0, 1e300, false, "Give zero or more"};

constexpr Word<WallLaw> kWallLaws[] = {{"foppl_von_karman", WallLaw::foppl_von_karman},
                                       {"tapered_membrane", WallLaw::tapered_membrane}};

template <class Q>
Q required(TableReader& table, const char* key, const io::Bounds& bounds) {
  return table.quantity<Q>(key, bounds, Need::required).value_or(Q{});
}

/// Sets every option of a struct with describe() that the table names.
class OptionReader {
 public:
  explicit OptionReader(TableReader& table) : table_(&table) {}

  template <int M, int L, int T, int A>
  void operator()(const char* name, Quantity<M, L, T, A>& value, const char*) {
    value = table_->quantity<Quantity<M, L, T, A>>(name, kAny).value_or(value);
  }
  void operator()(const char* name, double& value, const char*) {
    value = table_->number(name, kAny, "0.01").value_or(value);
  }
  void operator()(const char* name, int& value, const char*) {
    value = table_->integer(name).value_or(value);
  }
  void operator()(const char* name, bool& value, const char*) {
    value = table_->boolean(name).value_or(value);
  }
  void operator()(const char* name, std::string& value, const char*) {
    value = table_->text(name).value_or(value);
  }

 private:
  TableReader* table_;
};

/// Adds what validate() of one part finds to the faults, at the key it begins with where there is
/// one.
template <class Part>
void check_part(const Part& part, const TableReader& table, io::Faults& faults) {
  try {
    part.validate();
  } catch (const InputError& error) {
    const std::string word = error.found().substr(0, error.found().find(' '));
    io::Place place = table.place(word);
    if (!table.has(word)) place = {table.file(), table.line(), ""};
    faults.add(std::move(place), error.found(), error.mend());
  }
}

template <class Options>
void read_options(TableReader& root, const char* section, Options& options, io::Faults& faults) {
  auto table = root.table(section);
  if (!table) return;
  OptionReader reader(*table);
  options.describe(reader);
  const std::size_t before = faults.size();
  table->finish();
  if (faults.size() == before) check_part(options, *table, faults);
}

void read_camera(TableReader& root, InterferometerOptions& camera, io::Faults& faults) {
  auto table = root.table("camera");
  if (!table) return;
  OptionReader reader(*table);
  camera.describe(reader);
  camera.flow = table->choice("flow", kFlowDirections).value_or(camera.flow);
  camera.outward = table->choice("outward", kOutwards).value_or(camera.outward);
  const std::size_t before = faults.size();
  table->finish();
  if (faults.size() == before) check_part(camera, *table, faults);
}

void read_channel(TableReader& root, Scenario& scenario) {
  auto table = root.table("channel", Need::required);
  if (!table) return;
  scenario.channel.length = required<Length>(*table, "length", io::bounds::kLength);
  scenario.channel.width = required<Length>(*table, "width", io::bounds::kWidth);
  scenario.channel.height = required<Length>(*table, "height", io::bounds::kHeight);
  scenario.height_uncertainty =
      table->quantity<Length>("height_uncertainty", io::bounds::kLengthUncertainty)
          .value_or(Length{});
  table->finish();
}

void read_wall(TableReader& root, Scenario& scenario, io::Faults& faults) {
  auto table = root.table("wall", Need::required);
  if (!table) return;
  constexpr io::Bounds kLopsided{-2.0, 2.0, false, "Choose a relative difference in [-2, 2]"};
  constexpr io::Bounds kShear{0.0, 1.0, false,
                              "Choose 0 (rigid in shear) to 1, such as 5/6 = 0.833"};
  constexpr io::Bounds kCrest{-1e-3, 1e-3, false, "Choose a height between -1 mm and 1 mm"};
  wall::ClampedWall& wall = scenario.wall;
  wall.length = scenario.channel.length;
  wall.width = scenario.channel.width;
  scenario.wall_law = table->choice("law", kWallLaws).value_or(WallLaw::foppl_von_karman);
  scenario.wall_material = table->text("material").value_or("");
  wall.thickness = required<Length>(*table, "thickness", io::bounds::kThickness);
  wall.youngs_modulus = required<Pressure>(*table, "youngs_modulus", io::bounds::kModulus);
  const auto ratio = table->number("poisson_ratio", io::bounds::kPoissonRatio, "0.23");
  if (!table->has("poisson_ratio")) {
    faults.add(table->place("poisson_ratio"), "\"poisson_ratio\" is missing",
               "Add poisson_ratio = 0.23");
  }
  wall.poisson_ratio = ratio.value_or(0.0);
  wall.prestress = required<Pressure>(*table, "prestress", io::bounds::kPrestress);
  wall.shear_correction = table->number("shear_correction", kShear, "0.833").value_or(0.0);
  wall.preload.load =
      table->quantity<Pressure>("preload", io::bounds::kGaugePressure).value_or(Pressure{});
  wall.preload.lopsidedness =
      table->number("preload_lopsidedness", kLopsided, "0.04").value_or(0.0);
  wall.initial_shape.crest = table->quantity<Length>("initial_crest", kCrest).value_or(Length{});
  wall.initial_shape.lopsidedness =
      table->number("initial_lopsidedness", kLopsided, "0.1").value_or(0.0);
  OptionReader reader(*table);
  scenario.wall_grid.describe(reader);
  table->finish();
}

/// @return false if there is none.
bool read_fluid(TableReader& root, Scenario& scenario, Need need) {
  auto table = root.table("fluid", need);
  if (!table) return false;
  scenario.fluid_name = table->text("name").value_or("");
  scenario.fluid.viscosity = required<Viscosity>(*table, "viscosity", io::bounds::kViscosity);
  scenario.fluid.density = required<Density>(*table, "density", io::bounds::kDensity);
  table->finish();
  return true;
}

void read_runs(TableReader& root, Scenario& scenario, Need need) {
  if (auto table = root.table("hydrostatic", need)) {
    scenario.levels =
        table->quantities<Pressure>("levels", io::bounds::kGaugePressure, Need::required)
            .value_or(std::vector<Pressure>{});
    table->finish();
  }
  auto table = root.table("flow");
  if (!table) return;
  scenario.flow_rates =
      table->quantities<FlowRate>("flow_rates", io::bounds::kFlowRate, Need::required)
          .value_or(std::vector<FlowRate>{});
  scenario.outlet.head =
      table->quantity<Pressure>("outlet_pressure", io::bounds::kGaugePressure).value_or(Pressure{});
  scenario.outlet.tubing_resistance =
      table->quantity<HydraulicResistance>("tubing_resistance", kNotNegative)
          .value_or(HydraulicResistance{})
          .si();
  table->finish();
}

std::optional<flow::RigidPassage> read_passage(TableReader& rigid, const char* key) {
  auto table = rigid.table(key);
  if (!table) return std::nullopt;
  flow::RigidPassage passage;
  passage.length = required<Length>(*table, "length", io::bounds::kLength);
  passage.width = required<Length>(*table, "width", io::bounds::kWidth);
  passage.height = required<Length>(*table, "height", io::bounds::kHeight);
  table->finish();
  return passage;
}

void read_rigid(TableReader& root, Scenario& scenario) {
  auto table = root.table("rigid");
  if (!table) return;
  scenario.inlet_passage = read_passage(*table, "inlet");
  scenario.outlet_passage = read_passage(*table, "outlet");
  table->finish();
}

void check_schema(TableReader& root, io::Faults& faults) {
  const auto schema = root.integer("scenario", Need::required);
  if (!schema || *schema == kSchema) return;
  faults.add(root.place("scenario"), fmt::format("schema {} of the scenario file", *schema),
             fmt::format("This program knows schema {}: write scenario = {}", kSchema, kSchema));
}

/// @param need  of name, fluid and levels.
ScenarioDraft read_sections(const std::string& text, const fs::path& file, Need need) {
  io::Faults faults;
  io::TomlValue document;
  try {
    document = io::parse_toml(text, file);
  } catch (const InputError& error) {
    throw InputErrors({error});
  }
  TableReader root(document, "", file, faults);
  ScenarioDraft draft;
  Scenario& scenario = draft.scenario;
  check_schema(root, faults);
  scenario.name = root.text("name", need).value_or(file.stem().string());
  read_channel(root, scenario);
  read_wall(root, scenario, faults);
  draft.water_assumed = !read_fluid(root, scenario, need);
  read_runs(root, scenario, need);
  read_rigid(root, scenario);
  read_camera(root, scenario.camera, faults);
  read_options(root, "gauge", scenario.gauge, faults);
  read_options(root, "pump", scenario.pump, faults);
  read_options(root, "solver", scenario.solver, faults);
  root.finish();
  faults.throw_if_any(file);
  return draft;
}

void validate(const Scenario& scenario, const fs::path& file) {
  try {
    scenario.validate();
  } catch (const InputError& error) {
    throw InputErrors({InputError(file.string(), error.found(), error.mend())});
  }
}

std::string read_text(const fs::path& file) {
  constexpr std::size_t kLargest = 4u << 20;
  const auto refuse = [&](const std::string& found) {
    throw InputErrors({InputError(file.string(), found, "Give a scenario as a TOML file")});
  };
  std::error_code error;
  if (fs::is_directory(file, error)) refuse("this is a folder");
  std::ifstream stream(file, std::ios::binary);
  if (!stream) refuse("the file cannot be opened");
  const auto size = fs::file_size(file, error);
  if (!error && size > kLargest)
    refuse(fmt::format("{} MB: no scenario is that large", size >> 20));
  std::string text{std::istreambuf_iterator<char>(stream), {}};
  if (stream.bad()) refuse("the file cannot be read");
  return text;
}

/// A text and the file that it is named after.
struct Source {
  std::string text;
  fs::path file;
};

Source find_source(const std::string& name_or_path) {
  std::vector<std::string> names;
  for (const ShippedScenario& shipped : shipped_scenarios()) {
    if (shipped.name == name_or_path) return {shipped.text, shipped.name + ".toml"};
    names.push_back(shipped.name);
  }
  std::error_code error;
  if (fs::exists(name_or_path, error)) return {read_text(name_or_path), name_or_path};
  throw InputError(name_or_path,
                   fmt::format("no scenario of that name ships, and there is no such file{}",
                               did_you_mean(name_or_path, names)),
                   fmt::format("Give one of {}, or a TOML file", fmt::join(names, ", ")));
}

}  // namespace

Scenario parse_scenario(const std::string& text, const fs::path& file) {
  Scenario scenario = read_sections(text, file, Need::required).scenario;
  validate(scenario, file);
  return scenario;
}

ScenarioDraft parse_scenario_draft(const std::string& text, const fs::path& file) {
  ScenarioDraft draft = read_sections(text, file, Need::optional);
  Scenario& scenario = draft.scenario;
  if (draft.water_assumed) {
    scenario.fluid = {1.0 * mPa_s, 998.0 * kg_per_m3};
    scenario.fluid_name = "water";
  }
  draft.has_levels = !scenario.levels.empty();
  if (!draft.has_levels) scenario.levels = {Pressure{}};
  validate(scenario, file);
  return draft;
}

Scenario read_scenario(const fs::path& file) { return parse_scenario(read_text(file), file); }

Scenario find_scenario(const std::string& name_or_path) {
  const Source source = find_source(name_or_path);
  return parse_scenario(source.text, source.file);
}

ScenarioDraft find_scenario_draft(const std::string& name_or_path) {
  const Source source = find_source(name_or_path);
  return parse_scenario_draft(source.text, source.file);
}

Scenario demo_scenario() {
  Scenario scenario = find_scenario("S1");
  scenario.flow_rates = {5.0 * mL_per_min, 20.0 * mL_per_min, 40.0 * mL_per_min, 70.0 * mL_per_min};
  scenario.camera = resized(scenario.camera, "512x96");
  scenario.wall_grid = {20, 8};
  scenario.solver.flow_model = flow::flow_model_info(flow::FlowModel::section_march).name;
  return scenario;
}

}  // namespace manoscope::twin

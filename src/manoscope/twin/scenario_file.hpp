#pragma once

#include <filesystem>
#include <string>
#include <vector>

#include "manoscope/twin/scenario.hpp"

namespace manoscope::twin {

/// Reads a scenario: the true values of a virtual experiment and the errors it is seen with.
///
///   scenario = 1                     # schema
///   name = "S1"
///   [channel]      length, width, height; height_uncertainty
///   [wall]         thickness, youngs_modulus, poisson_ratio, prestress; material,
///                  shear_correction, preload, preload_lopsidedness, initial_crest,
///                  initial_lopsidedness, law = "foppl_von_karman" | "tapered_membrane",
///                  n_cells_x, n_cells_z
///   [fluid]        viscosity, density; name
///   [hydrostatic]  levels = ["0 Pa", "150 Pa", ...]
///   [flow]         flow_rates = ["5 mL/min", ...]; outlet_pressure, tubing_resistance
///   [rigid]        inlet, outlet = {length, width, height}
///   [camera]       the options of InterferometerOptions; flow, outward as in experiment.toml
///   [gauge] [pump] [solver]   the options of GaugeOptions, PumpOptions, CoupledOptions, such as
///                             flow_model = "rectangle" | "section-march" | ...
///
/// Names before a semicolon are required. Dimensional values are texts with their unit; options
/// left out keep their defaults.
///
/// @param file  named in messages; it need not exist.
/// @throws InputErrors with every fault of the text at once, each with its line: unknown keys (with
///         the nearest known one), missing ones, bare numbers, wrong units, values out of range.
///         Faults between sections (a compressed wall) come up once the text itself is sound.
Scenario parse_scenario(const std::string& text, const std::filesystem::path& file);

/// The same from a file.
/// @throws InputErrors also if it cannot be read.
Scenario read_scenario(const std::filesystem::path& file);

/// What is known of an experiment before it is planned.
struct ScenarioDraft {
  /// Without levels of its own it has one of 0 Pa.
  Scenario scenario;
  bool has_levels = false;
  bool water_assumed = false;  ///< no [fluid]: 1.0 mPa s, 998 kg/m3
};

/// The same from a text that may leave out name (that of the file), [fluid] and [hydrostatic]: for
/// planning.
ScenarioDraft parse_scenario_draft(const std::string& text, const std::filesystem::path& file);

/// A scenario that comes with the program.
struct ShippedScenario {
  std::string name;   ///< "S1"
  std::string title;  ///< first comment line of its text
  std::string text;   ///< TOML
};

/// Those that ship, by name.
const std::vector<ShippedScenario>& shipped_scenarios();

/// The shipped scenario of that name, else the file of that path.
/// @throws InputError if there is neither (with the names that ship), and as read_scenario().
Scenario find_scenario(const std::string& name_or_path);

/// The same of a draft.
ScenarioDraft find_scenario_draft(const std::string& name_or_path);

/// The shipped S1 in small, made in seconds: four flow rates, a camera of 512 x 96 pixels, fewer
/// cells of the wall (deflections within 1e-3 of those of S1); its flow is marched on the bulged
/// section ("section-march"), as a real one is.
Scenario demo_scenario();

}  // namespace manoscope::twin

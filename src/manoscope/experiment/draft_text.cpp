#include "manoscope/experiment/draft_text.hpp"

#include <fmt/format.h>

#include "manoscope/core/error.hpp"
#include "manoscope/io/csv_table.hpp"
#include "manoscope/io/toml_document.hpp"

namespace manoscope::experiment {
namespace {

std::string csv_cell(const std::string& text) {
  if (text.find_first_of(",;\t\"#\r\n") == std::string::npos) return text;
  std::string quoted = "\"";
  for (const char letter : text) {
    if (letter == '"') quoted += '"';
    quoted += letter;
  }
  quoted += '"';
  return quoted;
}

std::string toml_text(const std::string& text) {
  std::string quoted = "\"";
  for (const char letter : text) {
    if (letter == '"' || letter == '\\') quoted += '\\';
    quoted += letter;
  }
  quoted += '"';
  return quoted;
}

/// Ten digits hide the round-off of the unit conversion (2.3 kPa is 2300, not 2299.9999999999995).
std::string number(double value) { return fmt::format("{:.10g}", value); }

std::string about_the_map(const std::optional<CameraGrid>& grid, const std::string& map) {
  if (!grid) return "# No map could be read for its size.\n";
  const bool along_columns = grid->size_x() >= grid->size_y();
  return fmt::format(
      "# The maps are {:g} mm along columns by {:g} mm along rows, {} x {} pixels ({}).\n"
      "# CONFIRM: the longer side suggests that the channel runs along the {}.\n",
      grid->size_x().in(mm), grid->size_y().in(mm), grid->nx, grid->ny, map,
      along_columns ? "columns" : "rows");
}

std::string flow_key(const std::optional<CameraGrid>& grid) {
  const bool rows = grid && grid->size_x() < grid->size_y();
  return fmt::format(
      "# flow = \"{}\"          # which way the flow runs in the map: \"+columns\", \"-columns\", "
      "\"+rows\", \"-rows\"\n",
      rows ? "+rows" : "+columns");
}

}  // namespace

std::string draft_toml(const std::string& name, const std::optional<CameraGrid>& grid,
                       const std::string& grid_map, bool with_flow,
                       const std::vector<std::string>& unassigned) {
  std::string text =
      "# Drafted by `manoscope init`. Replace every \"?\", look at every CONFIRM, then run\n"
      "# `manoscope check` on this folder. A # starts a comment; quantities carry their unit.\n"
      "manoscope = 1\n";
  if (!name.empty()) text += fmt::format("name = {}\n", toml_text(name));
  text += "\n[channel]\n" + about_the_map(grid, grid_map);
  text +=
      "length = \"? mm\"   # FILL IN: along the flow\n"
      "width  = \"? mm\"   # FILL IN: across the flow\n"
      "height = \"? um\"   # FILL IN: the gap under the undeflected wall\n"
      "# height_uncertainty = \"0.5 um\"\n"
      "# origin = [\"0.4 mm\", \"0.4 mm\"]   # the inlet-side corner in the map, [along columns, "
      "along rows]; found from the maps when absent\n";
  text += flow_key(grid);
  text +=
      "# outward = \"+height\"        # does a wall bulging away from the fluid read higher or "
      "lower?\n"
      "\n# [inlet]\n"
      "# profile = \"developed\"   # how the flow enters: \"developed\" out of a long duct of the "
      "channel's section, \"uniform\" out of a chamber\n"
      "# spread = 0.3            # 0 to 1: how far it may be from that, towards the other; not "
      "known when absent\n"
      "\n# [wall]\n"
      "# thickness = \"? um\"   # lets p(x) be read to within 0.3 mm of the ends; no more is "
      "needed\n"
      "\n[fluid]\n"
      "name = \"water\"             # CONFIRM\n"
      "viscosity = \"1.0 mPa s\"    # CONFIRM: water at 20 degC\n"
      "# viscosity_uncertainty = \"0.01 mPa s\"\n"
      "density = \"998 kg/m3\"      # CONFIRM: water at 20 degC\n"
      "\n[instrument]\n"
      "pressure_noise = \"? Pa\"    # FILL IN: standard deviation of one reading of the gauge; \"0 "
      "Pa\" claims an exact gauge\n"
      "# pressure_zero_uncertainty = \"5 Pa\"   # of the gauge, common to all levels\n"
      "# pressure_gain_uncertainty = 0.002\n"
      "# flow_rate_uncertainty = 0.01         # relative, common to all runs\n"
      "# pressure_drop_uncertainty = \"5 Pa\"   # standard, of one reading of the drop under flow\n"
      "# reference = \"flat.gsf\"    # the instrument's own map of a flat\n"
      "\n[hydrostatic]\n"
      "list = \"hydrostatic.csv\"\n";
  text += with_flow ? "\n[flow]\nlist = \"flow.csv\"\n"
                    : "\n# No map is named like one under flow.\n# [flow]\n# list = \"flow.csv\"\n";
  text +=
      "\n# [rigid]   # passages between the channel and the gauges, if readings of the drop "
      "include them\n"
      "# inlet = {length = \"? mm\", width = \"? mm\", height = \"? um\", from_reservoir = true, "
      "round_bends = 1}\n"
      "# outlet = {length = \"? mm\", width = \"? mm\", height = \"? um\", into_reservoir = "
      "true}\n";
  if (!unassigned.empty()) {
    text += "\n# In neither list, for their names tell neither pressure nor flow rate:\n";
    for (const std::string& map : unassigned) {
      if (can_be_a_name(map)) text += fmt::format("#   {}\n", map);
    }
  }
  return text;
}

std::string draft_hydrostatic(const std::vector<GuessedMap>& maps) {
  std::string comments =
      "# Maps at known uniform pressure, outlet closed. Gauge pressures. pressure_uncertainty is "
      "that\n"
      "# of one reading: empty for instrument.pressure_noise, 0 for a map vented to air.\n";
  std::string rows = "map,pressure [Pa],pressure_uncertainty [Pa]\n";
  for (const GuessedMap& map : maps) {
    const bool known = map.guess.pressure.has_value();
    const std::string value = known ? number(map.guess.pressure->si()) : "?";
    rows += fmt::format("{},{},\n", csv_cell(map.name), value);
    if (known) {
      comments += fmt::format("# CONFIRM {} Pa, from \"{}\" in {}\n", value,
                              map.guess.pressure_text, map.name);
    } else {
      comments += fmt::format("# FILL IN the pressure of {}\n", map.name);
    }
  }
  return comments + rows;
}

std::string draft_flow(const std::vector<GuessedMap>& maps) {
  std::string comments =
      "# Maps under flow. Columns that may be added: pressure_drop [Pa], pressure_drop_uncertainty "
      "[Pa],\n"
      "# outlet_pressure [Pa], time [s]. Maps of one run share its name.\n";
  std::string rows = "map,flow_rate [mL/min],run\n";
  for (const GuessedMap& map : maps) {
    const bool known = map.guess.flow_rate.has_value();
    const std::string value = known ? number(map.guess.flow_rate->in(mL_per_min)) : "?";
    rows += fmt::format("{},{},{}\n", csv_cell(map.name), value, known ? "Q" + value : "");
    if (known) {
      comments += fmt::format("# CONFIRM {} mL/min, from \"{}\" in {}\n", value,
                              map.guess.flow_rate_text, map.name);
    } else {
      comments += fmt::format("# FILL IN the flow rate of {}\n", map.name);
    }
  }
  return comments + rows;
}

bool can_be_listed(const std::string& name) {
  try {
    const auto table = io::parse_csv_table("map,run\n" + csv_cell(name) + ",\n", "draft");
    // In a comment the name must stay on its line.
    return table.rows.size() == 1 && table.rows[0].cells[0] == name &&
           name.find_first_of("\r\n") == std::string::npos;
  } catch (const InputError&) {
    return false;
  }
}

bool can_be_a_name(const std::string& name) {
  try {
    const io::TomlValue root = io::parse_toml("name = " + toml_text(name) + "\n", "draft");
    const io::TomlValue* found = root.find("name");
    return found != nullptr && found->text == name;
  } catch (const InputError&) {
    return false;
  }
}

}  // namespace manoscope::experiment

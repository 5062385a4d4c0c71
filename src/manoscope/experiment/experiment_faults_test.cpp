#include <gtest/gtest.h>

#include <algorithm>
#include <ostream>

#include "manoscope/core/error.hpp"
#include "manoscope/experiment/experiment.hpp"
#include "manoscope/experiment/test_folder.hpp"

namespace manoscope::experiment {
namespace {

namespace fs = std::filesystem;

/// The faults that read_experiment reports, none if it reads.
std::vector<InputError> faults_of(const fs::path& folder_or_file) {
  try {
    read_experiment(folder_or_file);
  } catch (const InputErrors& errors) {
    return errors.faults();
  }
  return {};
}

std::string told(const std::vector<InputError>& faults) {
  return faults.empty() ? "no fault" : InputErrors(faults).what();
}

/// One replacement in one file of the full example, and the only fault it makes.
struct Case {
  const char* name;
  const char* file;
  const char* from;
  const char* to;
  const char* where;  ///< how the place ends
  const char* found;  ///< part of what was found
  const char* mend;   ///< part of what to do
};
void PrintTo(const Case& c, std::ostream* out) { *out << c.name; }

class FaultyExperiment : public ::testing::TestWithParam<Case> {};

TEST_P(FaultyExperiment, IsToldWithPlaceFindingAndMend) {
  const Case& c = GetParam();
  const TestFolder folder;
  write_full_example(folder);
  const std::string file = c.file;
  const char* base = file == "experiment.toml" ? kFullToml
                     : file == "flow.csv"      ? kFullFlow
                                               : kFullHydrostatic;
  folder.write(file, replaced(base, c.from, c.to));
  const auto faults = faults_of(folder.path());
  ASSERT_EQ(faults.size(), 1u) << told(faults);
  const InputError& fault = faults[0];
  EXPECT_EQ(fault.where(), (folder.path() / c.where).string()) << fault.what();
  EXPECT_NE(fault.found().find(c.found), std::string::npos) << fault.what();
  EXPECT_NE(fault.mend().find(c.mend), std::string::npos) << fault.what();
}

constexpr const char* kToml = "experiment.toml";
constexpr const char* kRest = "hydrostatic.csv";
constexpr const char* kFlow = "flow.csv";

const Case kTomlCases[] = {
    {"syntax", kToml, "\"15.5 mm\" ", "15.5 mm ", "experiment.toml:5", "is not TOML: column 1",
     "double quotes"},
    {"key_twice", kToml, "width  =", "length =", "experiment.toml:6", "redefine", "keep one"},
    {"no_schema", kToml, "manoscope = 1\n", "", "experiment.toml:1: manoscope", "missing",
     "Add manoscope = 1"},
    {"newer_schema", kToml, "manoscope = 1", "manoscope = 2", "experiment.toml:1: manoscope",
     "schema 2", "use a newer manoscope"},
    {"schema_text", kToml, "manoscope = 1", "manoscope = \"1\"", "experiment.toml:1: manoscope",
     "the text \"1\" is no whole number", "without quotes"},
    {"unknown_section", kToml, "[wall]", "[wal]", "experiment.toml:14: wal",
     "unknown section \"wal\" (did you mean \"wall\"?)", "Write wall"},
    {"misspelt_required_section", kToml, "[fluid]", "[fluids]", "experiment.toml:21: fluids",
     "did you mean \"fluid\"", "Write fluid"},
    {"unknown_root_key", kToml, "name = \"S1\"", "colour = \"red\"", "experiment.toml:2: colour",
     "unknown key \"colour\"", "known here: manoscope, name"},
    {"unknown_key", kToml, "rotation", "rotatoin", "experiment.toml:11: channel.rotatoin",
     "unknown key \"rotatoin\" (did you mean \"rotation\"?)", "Write rotation"},
    {"misspelt_required_key", kToml, "height =", "heigth =", "experiment.toml:7: channel.heigth",
     "did you mean \"height\"", "Write height"},
    {"unknown_passage_key", kToml, "inlet  = {length", "inlet  = {depth = \"1 mm\", length",
     "experiment.toml:43: rigid.inlet.depth", "unknown key \"depth\"", "length, width, height"},
    {"missing_key", kToml, "viscosity = \"1.0 mPa s\"\n", "", "experiment.toml:21: fluid.viscosity",
     "\"viscosity\" is missing", "Add viscosity = \"0.89 mPa s\""},
    {"missing_section", kToml, "[hydrostatic]\nlist = \"hydrostatic.csv\"\n", "",
     "experiment.toml:1: hydrostatic", "\"hydrostatic\" is missing", "a section [hydrostatic]"},
    {"bare_number", kToml, "\"175 um\" ", "175 ", "experiment.toml:7: channel.height",
     "the bare number 175 has no unit", "height = \"175 um\""},
    {"text_without_unit", kToml, "\"998 kg/m3\"", "\"998\"", "experiment.toml:24: fluid.density",
     "\"998\" has no unit", "998 kg/m3"},
    {"wrong_dimension", kToml, "\"1.7 mm\" ", "\"1.7 kPa\" ", "experiment.toml:6: channel.width",
     "\"1.7 kPa\" is not a length", "with its unit"},
    {"kinematic_viscosity", kToml, "1.0 mPa s", "1.0 mm2/s", "experiment.toml:23: fluid.viscosity",
     "is not a dynamic viscosity", "0.89 mPa s"},
    {"unknown_unit", kToml, "250 GPa", "250 GPaa", "experiment.toml:17: wall.youngs_modulus",
     "unknown unit \"GPaa\"", "250 GPa"},
    {"decimal_comma", kToml, "\"15.5 mm\"", "\"15,5 mm\"", "experiment.toml:5: channel.length",
     "15,5 mm", "with its unit"},
    {"placeholder", kToml, "\"15.5 mm\"", "\"? mm\"", "experiment.toml:5: channel.length",
     "\"? mm\" is still the placeholder", "Write the true value with its unit, like \"15.5 mm\""},
    {"placeholder_of_the_noise", kToml, "\"10 Pa\"", "\"? Pa\"",
     "experiment.toml:29: instrument.pressure_noise", "\"? Pa\" is still the placeholder",
     "\"0 Pa\" claims an exact gauge"},
    {"bare_width", kToml, "\"1.7 mm\" ", "1.7 ", "experiment.toml:6: channel.width",
     "the bare number 1.7 has no unit", "width = \"1.7 mm\""},
    {"uncertainty_above_viscosity", kToml, "0.005 mPa s", "5 mPa s",
     "experiment.toml:25: fluid.viscosity_uncertainty", "not below the viscosity",
     "check its unit"},
    {"flow_rate_uncertainty_in_percent", kToml, "flow_rate_uncertainty = 0.01",
     "flow_rate_uncertainty = 2", "experiment.toml:32: instrument.flow_rate_uncertainty",
     "2 is above 0.5", "0.01 means 1 %"},
    {"flow_rate_uncertainty_with_unit", kToml, "flow_rate_uncertainty = 0.01",
     "flow_rate_uncertainty = \"1 mL/min\"", "experiment.toml:32: instrument.flow_rate_uncertainty",
     "is no number", "flow_rate_uncertainty = 0.01"},
    {"negative_length", kToml, "\"15.5 mm\"", "\"-15.5 mm\"", "experiment.toml:5: channel.length",
     "\"-15.5 mm\" is not positive", "micro-channel"},
    {"zero_viscosity", kToml, "1.0 mPa s", "0 mPa s", "experiment.toml:23: fluid.viscosity",
     "is not positive", "water 1 mPa s"},
    {"absurd_width", kToml, "\"1.7 mm\" ", "\"1.7 m\" ", "experiment.toml:6: channel.width",
     "\"1.7 m\" is above 0.1 m", "10 cm"},
    {"height_above_width", kToml, "\"175 um\" ", "\"1.75 mm\" ",
     "experiment.toml:7: channel.height", "1.75 mm, is above the width, 1.7 mm", "swapped"},
    {"height_above_length", kToml, "\"15.5 mm\"", "\"0.1 mm\"", "experiment.toml:7: channel.height",
     "0.175 mm, is above the length, 0.1 mm", "check both"},
    {"uncertainty_above_height", kToml, "\"0.5 um\"", "\"0.5 mm\"",
     "experiment.toml:8: channel.height_uncertainty", "not below the height", "check its unit"},
    {"negative_uncertainty", kToml, "\"0.5 um\"", "\"-0.5 um\"",
     "experiment.toml:8: channel.height_uncertainty", "is negative", "zero or positive"},
    {"origin_of_one", kToml, "[\"0.4 mm\", \"0.4 mm\"]", "[\"0.4 mm\"]",
     "experiment.toml:9: channel.origin", "a list of 1", "two lengths"},
    {"origin_bare", kToml, "[\"0.4 mm\", \"0.4 mm\"]", "[0.4, \"0.4 mm\"]",
     "experiment.toml:9: channel.origin", "bare number 0.4", "two lengths"},
    {"flow_word", kToml, "\"+columns\"", "\"columns\"", "experiment.toml:10: channel.flow",
     "\"columns\" is not one of its words (did you mean \"+columns\"?)",
     "\"+columns\", \"-columns\", \"+rows\", \"-rows\""},
    {"outward_word", kToml, "\"-height\"", "\"up\"", "experiment.toml:12: channel.outward",
     "\"up\" is not one of its words", "\"+height\", \"-height\""},
    {"large_rotation", kToml, "0.5 deg", "90 deg", "experiment.toml:11: channel.rotation",
     "\"90 deg\" is above", "`flow` chose the axis"},
    {"poisson_ratio", kToml, "0.23", "0.51", "experiment.toml:18: wall.poisson_ratio",
     "0.51 is above 0.5", "(-1, 0.5]"},
    {"poisson_ratio_low", kToml, "0.23", "-1", "experiment.toml:18: wall.poisson_ratio",
     "-1 is not above -1", "(-1, 0.5]"},
    {"poisson_ratio_nan", kToml, "0.23", "nan", "experiment.toml:18: wall.poisson_ratio",
     "is not finite", "(-1, 0.5]"},
    {"gain_as_text", kToml, "0.002", "\"0.2 %\"",
     "experiment.toml:30: instrument.pressure_gain_uncertainty", "the text \"0.2 %\" is no number",
     "pressure_gain_uncertainty = 0.002"},
    {"name_as_number", kToml, "\"S1\"", "1", "experiment.toml:2: name",
     "the bare number 1 is no text", "in quotes"},
    {"number_for_a_table", kToml,
     "outlet = {length = \"6 mm\", width = \"1.7 mm\", height = \"175 um\", height_uncertainty = "
     "\"0.6 um\", from = \"1 mm2\", into_reservoir = true, mitre_bends = 1}",
     "outlet = 5", "experiment.toml:44: rigid.outlet",
     "the bare number 5 stands where a section belongs", "outlet = {...}"},
    {"missing_list", kToml, "\"flow.csv\"", "\"flows.csv\"", "experiment.toml:40: flow.list",
     "\"flows.csv\": there is no such file", "did you mean \"flow.csv\""},
    {"list_is_a_folder", kToml, "\"flow.csv\"", "\".\"", "experiment.toml:40: flow.list",
     "it is a folder", "the file inside"},
    {"list_and_maps", kToml, "list = \"flow.csv\"", "list = \"flow.csv\"\nmaps = []",
     "experiment.toml:41: flow.maps", "both `list` and `maps`", "Keep one"},
    {"neither_list_nor_maps", kToml, "list = \"flow.csv\"", "", "experiment.toml:39: flow.list",
     "names no maps", "list = \"flow.csv\", or maps = [{map"},
    {"empty_maps", kToml, "list = \"flow.csv\"", "maps = []", "experiment.toml:40: flow.maps",
     "has no maps", "for every map"},
    {"inline_bare_number", kToml, "list = \"flow.csv\"",
     "maps = [\n{map = \"f00.gsf\", flow_rate = \"5 mL/min\"},\n{map = \"f01.gsf\", flow_rate = "
     "5}]",
     "experiment.toml:42: flow.maps entry 2: flow_rate", "bare number 5 has no unit",
     "flow_rate = \"70 mL/min\""},
    {"inline_unknown_key", kToml, "list = \"flow.csv\"",
     "maps = [{map = \"f00.gsf\", flowrate = \"5 mL/min\"}]",
     "experiment.toml:40: flow.maps entry 1: flowrate", "did you mean \"flow_rate\"",
     "Write flow_rate"},
    {"missing_reference", kToml, "flat.gsf", "flot.gsf", "experiment.toml:34: instrument.reference",
     "\"flot.gsf\": there is no such file", "did you mean \"flat.gsf\""},
    {"reference_is_a_map", kToml, "flat.gsf", "h00.gsf", "experiment.toml:34: instrument.reference",
     "also a listed map, hydrostatic.csv:2", "a map of a flat"},
};

const Case kListCases[] = {
    {"head_without_unit", kRest, "pressure [Pa]", "pressure", "hydrostatic.csv:1: pressure",
     "names no unit", "pressure [kPa]"},
    {"head_with_unknown_unit", kRest, "pressure [Pa]", "pressure [Pas]",
     "hydrostatic.csv:1: pressure", "unknown unit \"Pas\"", "a unit of pressure"},
    {"head_of_wrong_dimension", kFlow, "[mL/min]", "[mL]", "flow.csv:1: flow_rate",
     "\"mL\" is not a unit of flow rate", "flow_rate [mL/min]"},
    {"unit_where_none_belongs", kRest, "sequence", "sequence [s]", "hydrostatic.csv:1: sequence",
     "has the unit \"s\"", "It has no unit"},
    {"unknown_column", kRest, "direction", "dirction", "hydrostatic.csv:1: dirction",
     "did you mean \"direction\"", "Write direction"},
    {"unit_in_round_brackets", kRest, "pressure [Pa]", "pressure (Pa)",
     "hydrostatic.csv:1: pressure (Pa)", "did you mean \"pressure\"", "Write pressure [kPa]"},
    {"foreign_column", kRest, "direction", "temperature [K]", "hydrostatic.csv:1: temperature",
     "unknown column \"temperature\"", "known here: map,pressure [kPa]"},
    {"missing_column_map", kRest, kFullHydrostatic, "pressure [Pa]\n0\n1\n2\n",
     "hydrostatic.csv:1: map", "\"map\" is missing", "Add a column map"},
    {"missing_column_flow_rate", kFlow, kFullFlow, "map,run\nf00.gsf,Q5\n", "flow.csv:1: flow_rate",
     "\"flow_rate\" is missing", "Add a column flow_rate [mL/min]"},
    {"column_without_name", kFlow, "flow_rate [mL/min]", "", "flow.csv:1", "column 2 has no name",
     "Name every column"},
    {"column_twice", kRest, "direction", "sequence", "hydrostatic.csv:1",
     "\"sequence\" stands there twice", "Keep one"},
    {"ragged_row", kRest, "h01.gsf,100,,1,up", "h01.gsf,100,,1", "hydrostatic.csv:3",
     "4 cells under 5 columns", "as many cells"},
    {"bad_number", kRest, "h02.gsf,2500", "h02.gsf,2.5.0", "hydrostatic.csv:4: pressure",
     "\"2.5.0\" is no number", "unit stands in the head"},
    {"unit_in_cell", kRest, "h02.gsf,2500", "h02.gsf,2500 Pa", "hydrostatic.csv:4: pressure",
     "\"2500 Pa\" is no number", "unit stands in the head"},
    {"nan_in_cell", kRest, "h02.gsf,2500", "h02.gsf,nan", "hydrostatic.csv:4: pressure",
     "\"nan\" is no number", "plain number"},
    {"placeholder_in_cell", kRest, "h02.gsf,2500", "h02.gsf,?", "hydrostatic.csv:4: pressure",
     "placeholder", "Write the pressure of this map"},
    {"empty_cell", kRest, "h02.gsf,2500", "h02.gsf,", "hydrostatic.csv:4: pressure",
     "the cell is empty", "Every row needs its pressure"},
    {"empty_map", kRest, "h02.gsf,2500", ",2500", "hydrostatic.csv:4: map", "the cell is empty",
     "Every row needs its map"},
    {"below_vacuum", kRest, "h02.gsf,2500", "h02.gsf,-200000", "hydrostatic.csv:4: pressure",
     "-200000 is below", "gauge pressure"},
    {"negative_row_uncertainty", kRest, "2500,12", "2500,-12",
     "hydrostatic.csv:4: pressure_uncertainty", "-12 is negative", "zero or positive"},
    {"bad_sequence", kRest, ",3,down", ",3.5,down", "hydrostatic.csv:5: sequence",
     "\"3.5\" is no whole number", "whole number"},
    {"bad_direction", kRest, "down", "dwon", "hydrostatic.csv:5: direction",
     "did you mean \"down\"", "up, down"},
    {"missing_map", kRest, "h02.gsf", "h20.gsf", "hydrostatic.csv:4: map",
     "\"h20.gsf\": there is no such file", "did you mean"},
    {"windows_path", kRest, "h02.gsf", "maps\\h02.gsf", "hydrostatic.csv:4: map",
     "there is no such file", "paths with /"},
    {"same_map_twice", kRest, "h03.gsf,100", "h01.gsf,100", "hydrostatic.csv:5: map",
     "\"h01.gsf\" is listed twice, first in line 3", "a repeat is another map"},
    {"same_map_at_two_pressures", kRest, "h03.gsf,100", "./h01.gsf,300", "hydrostatic.csv:5: map",
     "\"./h01.gsf\" is listed twice, first in line 3", "One map has one pressure"},
    {"few_levels", kRest, "2500", "100", "hydrostatic.csv:1", "2 distinct pressure levels",
     "at least 3"},
    {"negative_flow_rate", kFlow, "f02.gsf,70", "f02.gsf,-70", "flow.csv:4: flow_rate",
     "-70 is negative", "`flow` in [channel] gives its direction"},
    {"absurd_flow_rate", kFlow, "f02.gsf,70", "f02.gsf,7e5", "flow.csv:4: flow_rate",
     "7e5 is above 0.001 m3 s-1", "below 1 L/s"},
    {"run_at_two_flow_rates", kFlow, "f01.gsf,5", "f01.gsf,6", "flow.csv:3: run",
     "run \"Q5\" has 6 mL/min here and 5 mL/min in line 2", "One run has one flow rate"},
    {"map_in_both_lists", kFlow, "f02.gsf", "h02.gsf", "flow.csv:4: map",
     "also in the hydrostatic list, hydrostatic.csv:4", "remove it from one list"},
    {"empty_list", kFlow, "\nf00.gsf,5,1420,,,Q5,3\nf01.gsf,5,1424,30,1.5,Q5,\nf02.gsf,70,,,,,\n",
     "\n", "flow.csv:1", "no rows", "Add a row"},
    {"latin_list", kFlow, "[mL/min]", "[\xB5L/min]", "flow.csv:1", "byte 0xB5 is not UTF-8",
     "UTF-8"},
    {"negative_drop_uncertainty", kFlow, ",Q5,3", ",Q5,-3", "flow.csv:2: pressure_drop_uncertainty",
     "-3 is negative", "zero or positive"},
    {"drop_uncertainty_without_unit", kFlow, "pressure_drop_uncertainty [Pa]",
     "pressure_drop_uncertainty", "flow.csv:1: pressure_drop_uncertainty", "names no unit",
     "pressure_drop_uncertainty [kPa]"},
    {"misspelt_drop_uncertainty", kFlow, "pressure_drop_uncertainty", "pressure_drop_uncertanty",
     "flow.csv:1: pressure_drop_uncertanty", "did you mean \"pressure_drop_uncertainty\"",
     "Write pressure_drop_uncertainty"},
};

const Case kInletCases[] = {
    {"misspelt_section", kToml, "[inlet]", "[inlets]", "experiment.toml:49: inlets",
     "unknown section \"inlets\" (did you mean \"inlet\"?)", "Write inlet"},
    {"misspelt_key", kToml, "spread =", "spred =", "experiment.toml:51: inlet.spred",
     "unknown key \"spred\" (did you mean \"spread\"?)", "Write spread"},
    {"profile_word", kToml, "\"uniform\"", "\"unifrom\"", "experiment.toml:50: inlet.profile",
     "\"unifrom\" is not one of its words (did you mean \"uniform\"?)",
     "\"developed\", \"uniform\""},
    {"profile_as_number", kToml, "\"uniform\"", "1", "experiment.toml:50: inlet.profile",
     "the bare number 1 is no text", "in quotes"},
    {"spread_above_1", kToml, "spread = 0.3", "spread = 30", "experiment.toml:51: inlet.spread",
     "30 is above 1", "a fraction of the way"},
    {"spread_negative", kToml, "spread = 0.3", "spread = -0.3", "experiment.toml:51: inlet.spread",
     "-0.3 is negative", "a fraction of the way"},
    {"spread_as_text", kToml, "spread = 0.3", "spread = \"30 %\"",
     "experiment.toml:51: inlet.spread", "the text \"30 %\" is no number", "spread = 0.3"},
    {"bare_developing_length", kToml, "\"2 mm\"", "2",
     "experiment.toml:52: inlet.developing_length", "the bare number 2 has no unit",
     "developing_length = \"2 mm\""},
    {"developing_length_as_volume", kToml, "\"2 mm\"", "\"2 mL\"",
     "experiment.toml:52: inlet.developing_length", "\"2 mL\" is not a length", "with its unit"},
    {"negative_developing_length", kToml, "\"2 mm\"", "\"-2 mm\"",
     "experiment.toml:52: inlet.developing_length", "is negative", "zero or more"},
    {"developing_length_of_developed_flow", kToml, "\"uniform\"", "\"developed\"",
     "experiment.toml:52: inlet.developing_length", "a flow that is developed",
     "Write profile = \"uniform\""},
    {"developing_length_without_profile", kToml, "profile = \"uniform\"\n", "",
     "experiment.toml:51: inlet.developing_length", "without a profile that develops",
     "Write profile = \"uniform\""},
    {"bare_uncertainty_of_the_drop", kToml, "\"4 Pa\"", "4",
     "experiment.toml:33: instrument.pressure_drop_uncertainty", "the bare number 4 has no unit",
     "pressure_drop_uncertainty = \"5 Pa\""},
    {"negative_uncertainty_of_the_drop", kToml, "\"4 Pa\"", "\"-4 Pa\"",
     "experiment.toml:33: instrument.pressure_drop_uncertainty", "is negative", "zero or positive"},
};

const Case kRigidCases[] = {
    {"misspelt_fitting", kToml, "round_bends", "round_bend",
     "experiment.toml:43: rigid.inlet.round_bend",
     "unknown key \"round_bend\" (did you mean \"round_bends\"?)", "Write round_bends"},
    {"misspelt_list", kToml, "simulated", "simulate", "experiment.toml:45: rigid.simulate",
     "unknown key \"simulate\" (did you mean \"simulated\"?)", "Write simulated"},
    {"section_as_length", kToml, "\"1 mm2\"", "\"1 mm\"", "experiment.toml:44: rigid.outlet.from",
     "\"1 mm\" is not a cross-section", "\"4 mm2\""},
    {"bare_section", kToml, "\"1 mm2\"", "1", "experiment.toml:44: rigid.outlet.from",
     "the bare number 1 has no unit", "from = \"4 mm2\""},
    {"no_section", kToml, "\"1 mm2\"", "\"0 mm2\"", "experiment.toml:44: rigid.outlet.from",
     "is not positive", "between 0 and 100 cm2"},
    {"section_of_a_tank", kToml, "\"1 mm2\"", "\"1 m2\"", "experiment.toml:44: rigid.outlet.from",
     "is above 0.01 m2", "from_reservoir = true"},
    {"section_before_is_smaller", kToml, "\"1 mm2\"", "\"0.2 mm2\"",
     "experiment.toml:44: rigid.outlet.from",
     "0.2 mm2, is below the passage's own, width times height = 0.2975 mm2", "at least as large"},
    {"section_behind_is_smaller", kToml, "\"0.3 mm2\"", "\"0.29 mm2\"",
     "experiment.toml:43: rigid.inlet.into", "0.29 mm2, is below the passage's own",
     "at least as large"},
    {"from_section_and_reservoir", kToml, "from_reservoir = true",
     "from = \"1 mm2\", from_reservoir = true", "experiment.toml:43: rigid.inlet.from_reservoir",
     "both `from` and `from_reservoir = true`", "Keep `from` for a section of known size"},
    {"into_section_and_reservoir", kToml, "into_reservoir = true",
     "into = \"1 mm2\", into_reservoir = true", "experiment.toml:44: rigid.outlet.into_reservoir",
     "both `into` and `into_reservoir = true`", "Keep `into` for a section of known size"},
    {"reservoir_as_text", kToml, "into_reservoir = true", "into_reservoir = \"yes\"",
     "experiment.toml:44: rigid.outlet.into_reservoir", "neither true nor false",
     "into_reservoir = true"},
    {"passage_height_less_sure_than_high", kToml, "\"0.6 um\"", "\"0.6 mm\"",
     "experiment.toml:44: rigid.outlet.height_uncertainty", "600 um, is not below the height",
     "check its unit"},
    {"negative_uncertainty_of_a_passage", kToml, "\"0.6 um\"", "\"-0.6 um\"",
     "experiment.toml:44: rigid.outlet.height_uncertainty", "is negative", "zero or positive"},
    {"negative_bends", kToml, "round_bends = 2", "round_bends = -2",
     "experiment.toml:43: rigid.inlet.round_bends", "-2 is negative", "a whole number from 0"},
    {"long_port", kToml, "from_reservoir = true, into", "port = \"6 mm\", into",
     "experiment.toml:43: rigid.inlet.port", "6 mm, is longer than the passage, 5 mm",
     "opens into the passage"},
    {"port_beside_a_step", kToml, "from_reservoir = true, into",
     "from_reservoir = true, port = \"1 mm\", into", "experiment.toml:43: rigid.inlet.port",
     "a step at the gauge's end, too (`from`)", "what the flow meets first"},
    {"side_of_no_port", kToml, "from_reservoir = true, into", "port_side = \"top\", into",
     "experiment.toml:43: rigid.inlet.port_side", "there is no port", "or remove the key"},
    {"port_in_the_floor", kToml, "from_reservoir = true, into",
     "port = \"1 mm\", port_side = \"floor\", into", "experiment.toml:43: rigid.inlet.port_side",
     "\"floor\" is no side", "\"side\" for one in a side wall"},
    {"fractional_bends", kToml, "mitre_bends = 1", "mitre_bends = 1.5",
     "experiment.toml:44: rigid.outlet.mitre_bends", "1.5 is no whole number", "mitre_bends = 1"},
    {"simulated_is_no_list", kToml,
     "[\n  {flow_rate = \"20 mL/min\", drop = \"310 Pa\", uncertainty = \"10 Pa\"},\n"
     "  {flow_rate = \"70 mL/min\", drop = \"1.4 kPa\"}]",
     "\"310 Pa\"", "experiment.toml:45: rigid.simulated", "the text \"310 Pa\" is no list",
     "simulated = [{flow_rate = \"20 mL/min\", drop = \"310 Pa\""},
    {"simulated_is_empty", kToml,
     "[\n  {flow_rate = \"20 mL/min\", drop = \"310 Pa\", uncertainty = \"10 Pa\"},\n"
     "  {flow_rate = \"70 mL/min\", drop = \"1.4 kPa\"}]",
     "[]", "experiment.toml:45: rigid.simulated", "no simulations", "or remove the key"},
    {"simulation_is_no_table", kToml, "{flow_rate = \"70 mL/min\", drop = \"1.4 kPa\"}",
     "\"1.4 kPa\"", "experiment.toml:47: rigid.simulated entry 2",
     "\"1.4 kPa\" stands where a simulation belongs", "Write {flow_rate = \"20 mL/min\""},
    {"simulation_without_flow_rate", kToml, "flow_rate = \"20 mL/min\", ", "",
     "experiment.toml:46: rigid.simulated entry 1: flow_rate", "\"flow_rate\" is missing",
     "Add flow_rate = \"20 mL/min\""},
    {"simulation_without_drop", kToml, ", drop = \"1.4 kPa\"", "",
     "experiment.toml:47: rigid.simulated entry 2: drop", "\"drop\" is missing", "Add drop = "},
    {"simulation_misspelt", kToml, "uncertainty = \"10 Pa\"", "uncertanty = \"10 Pa\"",
     "experiment.toml:46: rigid.simulated entry 1: uncertanty", "did you mean \"uncertainty\"",
     "Write uncertainty"},
    {"simulation_at_rest", kToml, "\"20 mL/min\"", "\"0 mL/min\"",
     "experiment.toml:46: rigid.simulated entry 1: flow_rate", "is not positive", "above zero"},
    {"simulation_backwards", kToml, "\"20 mL/min\"", "\"-20 mL/min\"",
     "experiment.toml:46: rigid.simulated entry 1: flow_rate", "is not positive", "above zero"},
    {"simulation_bare_drop", kToml, "\"310 Pa\"", "310",
     "experiment.toml:46: rigid.simulated entry 1: drop", "the bare number 310 has no unit",
     "drop = "},
    {"simulation_drop_as_length", kToml, "\"310 Pa\"", "\"31 mm\"",
     "experiment.toml:46: rigid.simulated entry 1: drop", "\"31 mm\" is not a pressure",
     "with its unit"},
    {"simulation_negative_uncertainty", kToml, "uncertainty = \"10 Pa\"",
     "uncertainty = \"-10 Pa\"", "experiment.toml:46: rigid.simulated entry 1: uncertainty",
     "is negative", "zero or positive"},
    {"simulation_twice", kToml, "\"70 mL/min\"", "\"333.3333333 uL/s\"",
     "experiment.toml:47: rigid.simulated entry 2: flow_rate",
     "20 mL/min is simulated twice, first in line 46", "Keep one"},
};

std::string case_name(const ::testing::TestParamInfo<Case>& info) { return info.param.name; }
INSTANTIATE_TEST_SUITE_P(Toml, FaultyExperiment, ::testing::ValuesIn(kTomlCases), case_name);
INSTANTIATE_TEST_SUITE_P(Lists, FaultyExperiment, ::testing::ValuesIn(kListCases), case_name);
INSTANTIATE_TEST_SUITE_P(Inlet, FaultyExperiment, ::testing::ValuesIn(kInletCases), case_name);
INSTANTIATE_TEST_SUITE_P(Rigid, FaultyExperiment, ::testing::ValuesIn(kRigidCases), case_name);

}  // namespace
}  // namespace manoscope::experiment

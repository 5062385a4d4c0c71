#include "manoscope/experiment/experiment.hpp"

#include <fmt/format.h>

#include <system_error>
#include <utility>

#include "manoscope/experiment/list_checks.hpp"
#include "manoscope/experiment/lists.hpp"
#include "manoscope/experiment/map_files.hpp"
#include "manoscope/experiment/rigid_section.hpp"
#include "manoscope/experiment/sections.hpp"
#include "manoscope/io/table_reader.hpp"
#include "manoscope/io/toml_document.hpp"

namespace manoscope::experiment {
namespace {

namespace fs = std::filesystem;

constexpr int kSchema = 1;

/// The experiment.toml that the user means.
fs::path find_file(const fs::path& folder_or_file, io::Faults& faults) {
  std::error_code error;
  if (!fs::is_directory(folder_or_file, error)) {
    if (!fs::exists(folder_or_file, error)) {
      faults.add({folder_or_file, 0, ""}, "there is no such file or folder",
                 "Name an experiment folder or its experiment.toml");
      faults.throw_if_any(folder_or_file);
    }
    return folder_or_file;
  }
  fs::path file = folder_or_file / "experiment.toml";
  if (!fs::exists(file, error)) {
    faults.add(
        {folder_or_file, 0, ""}, "the folder holds no experiment.toml",
        fmt::format("Draft one from the maps in it: manoscope init {}", folder_or_file.string()));
    faults.throw_if_any(folder_or_file);
  }
  return file;
}

io::TomlValue read_document(Experiment& experiment, const FileTexts& instead, io::Faults& faults) {
  const fs::path& file = experiment.file;
  if (const auto given = instead.find(file.lexically_normal()); given != instead.end()) {
    experiment.text = given->second;
  } else {
    auto text = read_file(file, {file, 0, ""}, faults);
    faults.throw_if_any(file);
    experiment.text = std::move(*text);
  }
  try {
    return io::parse_toml(experiment.text, file);
  } catch (const InputError& error) {
    throw InputErrors({error});
  }
}

void check_schema(io::TableReader& root, io::Faults& faults) {
  const auto schema = root.integer("manoscope", io::Need::required);
  if (!schema || *schema == kSchema) return;
  faults.add(root.place("manoscope"), fmt::format("schema {} of the experiment file", *schema),
             *schema > kSchema
                 ? fmt::format("This program knows schema {}: use a newer manoscope", kSchema)
                 : fmt::format("Write manoscope = {}", kSchema));
}

/// Of a folder given as ".", too.
std::string folder_name(const fs::path& file) {
  std::error_code error;
  const fs::path whole = fs::weakly_canonical(fs::absolute(file, error), error);
  return error ? std::string("experiment") : whole.parent_path().filename().string();
}

void read_sections(io::TableReader& root, Experiment& experiment, io::Faults& faults) {
  if (auto table = root.table("channel", io::Need::required)) {
    experiment.channel = read_channel(*table, faults);
  }
  if (auto table = root.table("inlet")) experiment.inlet = read_inlet(*table, faults);
  if (auto table = root.table("wall")) experiment.wall = read_wall(*table);
  if (auto table = root.table("fluid", io::Need::required)) {
    experiment.fluid = read_fluid(*table, faults);
  }
  if (auto table = root.table("rigid")) experiment.rigid = read_rigid(*table, faults);
}

void read_maps(io::TableReader& root, Experiment& experiment, const FileTexts& instead,
               io::Faults& faults) {
  MapFiles files(experiment.file.parent_path(), instead);
  InstrumentSection& instrument = experiment.instrument;
  auto instrument_table = root.table("instrument");
  if (instrument_table) instrument = read_instrument(*instrument_table);
  MapList<HydrostaticMap> hydrostatic;
  MapList<FlowMap> flow;
  if (auto table = root.table("hydrostatic", io::Need::required)) {
    hydrostatic = read_hydrostatic(*table, instrument, files, faults);
  }
  if (auto table = root.table("flow")) flow = read_flow(*table, instrument, files, faults);
  check_lists(hydrostatic, flow, faults);
  if (instrument.reference) {
    const io::Place place = instrument_table->place("reference");
    instrument.reference = files.find(instrument.reference->string(), place, faults);
    check_reference(*instrument.reference, place, hydrostatic, flow, faults);
  }
  experiment.hydrostatic = std::move(hydrostatic.maps);
  experiment.flow = std::move(flow.maps);
}

void read_whole(Experiment& experiment, const FileTexts& instead, io::Faults& faults) {
  const io::TomlValue document = read_document(experiment, instead, faults);
  io::TableReader root(document, "", experiment.file, faults);
  check_schema(root, faults);
  experiment.name = root.text("name").value_or("");
  if (experiment.name.empty()) experiment.name = folder_name(experiment.file);
  read_sections(root, experiment, faults);
  read_maps(root, experiment, instead, faults);
  root.finish();
  faults.throw_if_any(experiment.file);
}

}  // namespace

Experiment read_experiment(const fs::path& folder_or_file) {
  io::Faults faults;
  Experiment experiment;
  experiment.file = find_file(folder_or_file, faults);
  read_whole(experiment, {}, faults);
  return experiment;
}

ExperimentAttempt attempt_experiment(const fs::path& file, const FileTexts& instead) {
  ExperimentAttempt attempt;
  attempt.experiment.file = file;
  io::Faults faults;
  try {
    read_whole(attempt.experiment, instead, faults);
  } catch (const InputErrors& errors) {
    attempt.faults = errors.faults();
  }
  return attempt;
}

}  // namespace manoscope::experiment

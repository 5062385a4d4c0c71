// Small virtual experiments on disk, for the tests of this folder.
#pragma once

#include <gtest/gtest.h>

#include <string>
#include <utility>
#include <vector>

#include "manoscope/core/error.hpp"
#include "manoscope/experiment/experiment.hpp"
#include "manoscope/io/writer.hpp"
#include "manoscope/pipeline/measure.hpp"
#include "manoscope/twin/experiment_files.hpp"
#include "manoscope/twin/virtual_experiment.hpp"
#include "tests/support/temporary_folder.hpp"

namespace manoscope::pipeline {

/// The shipped scenario through a small camera, at two flow rates; without blobs, for one of 7
/// pixels would take out a station of so few pixels across.
inline twin::Scenario small_scenario() {
  twin::Scenario scenario = twin::small_s1();
  scenario.name = "small";
  scenario.camera.n_along = 256;
  scenario.camera.n_across = 64;
  scenario.camera.blobs = 0.0;
  scenario.solver.steps = 200;
  scenario.flow_rates = {20.0 * mL_per_min, 70.0 * mL_per_min};
  return scenario;
}

/// The same, its flow a momentum balance on the sections.
inline twin::Scenario momentum_scenario(std::vector<FlowRate> flow_rates) {
  twin::Scenario scenario = small_scenario();
  scenario.flow_rates = std::move(flow_rates);
  scenario.solver.momentum_factor = 1.2;  // of the rectangle: as if not told
  scenario.solver.flow_model = "momentum";
  return scenario;
}

/// The wall of small_scenario() answers to the pressure at x alone: there are no neighbours to
/// heed. Flow models have tests of their own.
inline MeasureOptions station_by_station() {
  MeasureOptions options;
  options.nonlocal.nonlocal = false;
  options.flow.flow_models = false;
  return options;
}

/// A virtual experiment whose files can be changed before they are measured.
class TestExperiment {
 public:
  explicit TestExperiment(twin::Scenario made_of = small_scenario(), std::uint64_t seed = 1)
      : scenario(std::move(made_of)), twin(twin::make_virtual_experiment(scenario, seed)) {}
  TestExperiment(twin::Scenario made_of, twin::VirtualExperiment made)
      : scenario(std::move(made_of)), twin(std::move(made)) {}

  twin::Scenario scenario;
  twin::VirtualExperiment twin;

  /// Replaces a text that must stand in the experiment file exactly once.
  void replace(const std::string& text, const std::string& by) {
    replace_in(twin.experiment_toml, text, by);
  }
  static void replace_in(std::string& whole, const std::string& text, const std::string& by) {
    const auto at = whole.find(text);
    if (at == std::string::npos) throw InternalError("the test finds no \"" + text + "\"");
    whole.replace(at, text.size(), by);
  }
  /// Takes out the line of the experiment file that begins with `key`.
  void remove_line(const std::string& key) {
    std::string& toml = twin.experiment_toml;
    const auto at = toml.find("\n" + key);
    if (at == std::string::npos) throw InternalError("the test finds no line \"" + key + "\"");
    toml.erase(at, toml.find('\n', at + 1) - at);
  }
  void leave_out_place() {
    for (const char* key : {"origin", "flow =", "outward"}) remove_line(key);
  }
  HeightMap& map(const std::string& name) {
    for (auto& candidate : twin.maps) {
      if (candidate.name == name) return candidate.map;
    }
    throw InternalError("the test finds no map " + name);
  }
  /// One more map of a wall that is known already, with errors of its own.
  void add_map(const std::string& name, const twin::ChannelCurve& deflection,
               std::uint64_t map_index) {
    twin.maps.push_back(
        {name, name,
         twin::record_map(scenario.channel, deflection, scenario.camera, 99, map_index)});
  }

  const std::filesystem::path& folder() const { return folder_.path(); }
  experiment::Experiment read() {
    twin::write_experiment(folder(), twin, true);
    return experiment::read_experiment(folder());
  }
  results::Measurement measure(const MeasureOptions& options = station_by_station(),
                               int n_threads = 1) {
    return pipeline::measure(read(), options, n_threads);
  }

 private:
  test_support::TemporaryFolder folder_;
};

/// Whether any of the warnings holds this text.
inline bool warns_of(const results::Measurement& m, const std::string& text) {
  for (const std::string& warning : m.warnings) {
    if (warning.find(text) != std::string::npos) return true;
  }
  return false;
}
inline std::string all_warnings(const results::Measurement& m) {
  std::string text;
  for (const std::string& warning : m.warnings) text += warning + "\n";
  return text;
}

}  // namespace manoscope::pipeline

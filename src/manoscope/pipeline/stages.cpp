#include "manoscope/pipeline/stages.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <atomic>
#include <map>

#include "manoscope/core/error.hpp"
#include "manoscope/core/parallel.hpp"
#include "manoscope/core/provenance.hpp"
#include "manoscope/io/reader.hpp"

namespace manoscope::pipeline {
namespace {

using experiment::Experiment;

/// A map of the experiment, the instrument's own reference subtracted where one is named.
class MapSource {
 public:
  explicit MapSource(const Experiment& experiment) {
    const auto& instrument = experiment.instrument;
    if (instrument.pixel_pitch) {
      options_.pitch_x = (*instrument.pixel_pitch)[0];
      options_.pitch_y = (*instrument.pixel_pitch)[1];
    }
    options_.height_unit = instrument.height_unit;
    options_.channel = instrument.channel;
    if (instrument.reference) reference_ = io::read_height_map(*instrument.reference, options_);
  }
  HeightMap read(const std::filesystem::path& path) const {
    HeightMap map = io::read_height_map(path, options_);
    return reference_ ? maps::subtract_reference(map, *reference_, path.string()) : map;
  }

 private:
  io::ReadOptions options_;
  std::optional<HeightMap> reference_;
};

/// One experiment, one camera: stations and the channel's place are those of the first map.
void require_same_grid(const CameraGrid& first, const std::string& first_name,
                       const CameraGrid& grid, const std::string& name) {
  if (grid == first) return;
  const auto told = [](const CameraGrid& g) {
    return fmt::format("{} x {} pixels of {:.8g} x {:.8g} um", g.nx, g.ny, g.pitch_x.in(um),
                       g.pitch_y.in(um));
  };
  throw InputError(name, fmt::format("has {}, {} has {}", told(grid), first_name, told(first)),
                   "Take all maps of one experiment with the same camera settings");
}

}  // namespace

maps::FoundPlace place_channel(const Experiment& experiment) {
  const auto& levels = experiment.hydrostatic;
  const auto by_pressure = [](const auto& a, const auto& b) { return a.pressure < b.pressure; };
  const auto lowest = std::min_element(levels.begin(), levels.end(), by_pressure);
  const auto highest = std::max_element(levels.begin(), levels.end(), by_pressure);
  const auto& channel = experiment.channel;
  const maps::KnownPlace known{channel.length, channel.width,    channel.origin,
                               channel.flow,   channel.rotation, channel.outward};
  const MapSource source(experiment);
  const HeightMap low = source.read(lowest->map), high = source.read(highest->map);
  require_same_grid(low.grid(), lowest->name, high.grid(), highest->name);
  std::optional<HeightMap> flowing;
  if (!known.flow && !experiment.flow.empty()) {
    const auto fastest =
        std::max_element(experiment.flow.begin(), experiment.flow.end(),
                         [](const auto& a, const auto& b) { return a.flow_rate < b.flow_rate; });
    flowing = source.read(fastest->map);
    require_same_grid(low.grid(), lowest->name, flowing->grid(), fastest->name);
  }
  return maps::find_place({&low, &high, flowing ? &*flowing : nullptr}, known,
                          highest->map.string());
}

ReducedExperiment reduce_maps(const Experiment& experiment, const ChannelFrame& frame,
                              const maps::ReduceOptions& options, int n_threads,
                              const Monitor& monitor) {
  std::vector<std::pair<std::filesystem::path, std::string>> files;
  for (const auto& entry : experiment.hydrostatic) files.emplace_back(entry.map, entry.name);
  for (const auto& entry : experiment.flow) files.emplace_back(entry.map, entry.name);
  const MapSource source(experiment);
  std::vector<maps::ReducedMap> reduced(files.size());
  ReducedExperiment result;
  result.frame = frame;
  result.hash.resize(files.size());
  if (experiment.instrument.reference) {
    result.reference_hash = sha256(read_file(*experiment.instrument.reference));
  }
  const std::string& first_name = files.front().second;
  result.grid = source.read(files.front().first).grid();
  std::atomic<int> done{0};
  parallel_for(static_cast<Index>(files.size()), n_threads, [&](Index i) {
    monitor.checkpoint();
    const auto at = static_cast<std::size_t>(i);
    const auto& [path, name] = files[at];
    result.hash[at] = sha256(read_file(path));
    const HeightMap map = source.read(path);
    require_same_grid(result.grid, first_name, map.grid(), name);
    reduced[at] = maps::reduce_map(map, frame, experiment.instrument.height_noise, name, options);
    monitor.report("reducing maps",
                   static_cast<double>(++done) / static_cast<double>(files.size()));
  });
  const auto split = reduced.begin() + static_cast<Index>(experiment.hydrostatic.size());
  result.hydrostatic.assign(std::make_move_iterator(reduced.begin()),
                            std::make_move_iterator(split));
  result.flow.assign(std::make_move_iterator(split), std::make_move_iterator(reduced.end()));
  return result;
}

std::vector<calibration::Level> make_levels(const Experiment& experiment,
                                            const std::vector<maps::ReducedMap>& reduced) {
  std::vector<calibration::Level> levels;
  for (std::size_t k = 0; k < reduced.size(); ++k) {
    const auto& entry = experiment.hydrostatic[k];
    levels.push_back({entry.name, entry.pressure, entry.pressure_uncertainty, reduced[k].profile});
  }
  return levels;
}

std::vector<FlowRun> make_runs(const Experiment& experiment,
                               const std::vector<maps::ReducedMap>& reduced) {
  std::vector<std::string> order;
  std::map<std::string, std::vector<std::size_t>> members;
  for (std::size_t i = 0; i < experiment.flow.size(); ++i) {
    const std::string& run = experiment.flow[i].run;
    if (!members.contains(run)) order.push_back(run);
    members[run].push_back(i);
  }
  std::vector<FlowRun> runs;
  for (const std::string& name : order) {
    FlowRun run;
    run.name = name;
    std::vector<Profile> profiles;
    double transducer = 0.0;
    int n_transducer = 0;
    for (const std::size_t i : members.at(name)) {
      run.flow_rate = experiment.flow[i].flow_rate;
      profiles.push_back(reduced[i].profile);
      if (const auto& drop = experiment.flow[i].pressure_drop) {
        transducer += drop->si();
        ++n_transducer;
      }
    }
    run.profile = mean_profile(profiles);
    if (n_transducer > 0) run.transducer_drop = Pressure::from_si(transducer / n_transducer);
    runs.push_back(std::move(run));
  }
  return runs;
}

}  // namespace manoscope::pipeline

#include "manoscope/pipeline/stages.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <atomic>
#include <map>

#include "manoscope/core/error.hpp"
#include "manoscope/core/parallel.hpp"
#include "manoscope/core/provenance.hpp"
#include "manoscope/io/map_address.hpp"
#include "manoscope/io/read_ahead.hpp"
#include "manoscope/io/reader.hpp"
#include "manoscope/maps/camera_window.hpp"
#include "manoscope/pipeline/file_warnings.hpp"

namespace manoscope::pipeline {
namespace {

using experiment::Experiment;

/// Of all maps together: what a page can hold (some 6 MB).
constexpr Index kPictureCells = 7'000'000;

/// A map of the experiment in the camera window of the first one, the instrument's own reference
/// subtracted where one is named.
///
/// Files that name no window count as of the window at (0, 0): maps of other sizes without any
/// window are left for require_same_grid() to refuse.
class MapSource {
 public:
  explicit MapSource(const Experiment& experiment) : options_(reading_options(experiment)) {
    const io::LoadedMap first = io::load_height_map(experiment.hydrostatic.front().map, options_);
    window_ = {first.map.grid(), first.offset_x, first.offset_y};
    const auto& instrument = experiment.instrument;
    if (instrument.reference) {
      reference_ = in_window(io::load_height_map(*instrument.reference, options_),
                             instrument.reference->string());
    }
  }
  HeightMap read(const std::filesystem::path& path,
                 std::vector<std::string>* warnings = nullptr) const {
    io::LoadedMap loaded = io::load_height_map(path, options_);
    if (warnings != nullptr) *warnings = std::move(loaded.warnings);
    HeightMap map = in_window(std::move(loaded), path.string());
    return reference_ ? maps::subtract_reference(map, *reference_, path.string()) : std::move(map);
  }

 private:
  HeightMap in_window(io::LoadedMap loaded, const std::string& name) const {
    const bool named = loaded.offset_x != 0 || loaded.offset_y != 0 || window_.offset_x != 0 ||
                       window_.offset_y != 0;
    const bool same = loaded.map.grid() == window_.grid && loaded.offset_x == window_.offset_x &&
                      loaded.offset_y == window_.offset_y;
    if (!named || same) return std::move(loaded.map);
    return maps::into_window(loaded.map, loaded.offset_x, loaded.offset_y, window_, name);
  }

  io::ReadOptions options_;
  maps::CameraWindow window_;
  std::optional<HeightMap> reference_;
};

/// The maps of lowest and of highest pressure.
auto extreme_levels(const Experiment& experiment) {
  const auto& levels = experiment.hydrostatic;
  const auto by_pressure = [](const auto& a, const auto& b) { return a.pressure < b.pressure; };
  return std::pair(std::min_element(levels.begin(), levels.end(), by_pressure),
                   std::max_element(levels.begin(), levels.end(), by_pressure));
}

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
  const auto [lowest, highest] = extreme_levels(experiment);
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
  result.level_order = options.level_order;
  result.hash.resize(files.size());
  result.file_warnings.resize(files.size());
  if (experiment.instrument.reference) {
    result.reference_hash =
        sha256(read_file(io::map_address(*experiment.instrument.reference).file));
  }
  const std::string& first_name = files.front().second;
  const HeightMap first = source.read(files.front().first);
  result.grid = first.grid();
  maps::MapKnowledge known;
  known.height_noise = experiment.instrument.height_noise;
  known.wavelength = experiment.instrument.wavelength;
  known.picture_cells = std::max<Index>(1, kPictureCells / static_cast<Index>(files.size()));
  const bool registers = options.registration && !options.shift_uncertainty;
  std::optional<maps::FrameTexture> texture;
  if (registers) texture = maps::texture_of_reference(first, frame, known, first_name, options);
  constexpr std::size_t kAhead = 2;
  std::atomic<int> done{0};
  parallel_for(static_cast<Index>(files.size()), n_threads, [&](Index i) {
    monitor.checkpoint();
    const auto at = static_cast<std::size_t>(i);
    const auto& [path, name] = files[at];
    // The next maps come from the disk while this one is reduced.
    if (at + kAhead < files.size()) {
      io::read_ahead(io::map_address(files[at + kAhead].first).file);
    }
    result.hash[at] = sha256(read_file(io::map_address(path).file));
    const HeightMap map = source.read(path, &result.file_warnings[at]);
    require_same_grid(result.grid, first_name, map.grid(), name);
    maps::MapKnowledge its = known;
    if (texture && at > 0) its.texture = &*texture;
    reduced[at] = maps::reduce_map(map, frame, its, name, options);
    monitor.report("reducing maps",
                   static_cast<double>(++done) / static_cast<double>(files.size()));
  });
  maps::place_reference(reduced);
  // Maps whose wall lies elsewhere across the flow, or askew, once more in their own place.
  if (options.registration) {
    const Length pitch_z = frame.along_columns() ? result.grid.pitch_y : result.grid.pitch_x;
    const maps::Placements placements =
        maps::find_placements(reduced, experiment.hydrostatic.size(), frame.length, pitch_z);
    result.centre = placements.common;
    parallel_for(static_cast<Index>(files.size()), n_threads, [&](Index i) {
      const auto at = static_cast<std::size_t>(i);
      if (placements.own[at].farthest(frame.length.si()) == 0.0) return;
      monitor.checkpoint();
      maps::MapKnowledge placed = known;
      placed.placement = placements.own[at];
      const auto its_texture = reduced[at].condition.texture;
      reduced[at] =
          maps::reduce_map(source.read(files[at].first), frame, placed, files[at].second, options);
      reduced[at].condition.texture = its_texture;
    });
  }
  const auto [lowest, highest] = extreme_levels(experiment);
  result.response = maps::picture_response(source.read(lowest->map), source.read(highest->map),
                                           frame, highest->name);
  const auto split = reduced.begin() + static_cast<Index>(experiment.hydrostatic.size());
  result.hydrostatic.assign(std::make_move_iterator(reduced.begin()),
                            std::make_move_iterator(split));
  result.flow.assign(std::make_move_iterator(split), std::make_move_iterator(reduced.end()));
  // A place that was found, or given to half a pixel, is made finer by the ends of all walls; one
  // that they contradict by more is the user's, and doubted.
  const Length pitch = frame.along_columns() ? result.grid.pitch_x : result.grid.pitch_y;
  const Length largest = experiment.channel.origin ? 0.5 * pitch : frame.length;
  result.offset = maps::register_maps(result.hydrostatic, result.flow, frame.length, frame.width,
                                      options, largest);
  return result;
}

std::string inputs_text(const Experiment& experiment, const ReducedExperiment& reduced) {
  std::string text;
  for (std::size_t i = 0; i < reduced.hash.size(); ++i) {
    const std::size_t n_static = experiment.hydrostatic.size();
    const std::string& name =
        i < n_static ? experiment.hydrostatic[i].name : experiment.flow[i - n_static].name;
    text += fmt::format("{}  {}\n", name, reduced.hash[i]);
  }
  if (const auto& reference = experiment.instrument.reference) {
    text += fmt::format("{}  {}\n", reference->filename().string(), reduced.reference_hash);
  }
  return text;
}

std::vector<calibration::Level> make_levels(const Experiment& experiment,
                                            const std::vector<maps::ReducedMap>& reduced) {
  std::vector<calibration::Level> levels;
  for (std::size_t k = 0; k < reduced.size(); ++k) {
    const auto& entry = experiment.hydrostatic[k];
    levels.push_back({entry.name, entry.pressure, entry.pressure_uncertainty.value_or(Pressure{}),
                      reduced[k].profile, entry.vented ? 0.0 : 1.0});
  }
  return levels;
}

namespace {

std::optional<Pressure> mean(const std::vector<Pressure>& values) {
  if (values.empty()) return std::nullopt;
  Pressure sum{};
  for (const Pressure value : values) sum += value;
  return (1.0 / static_cast<double>(values.size())) * sum;
}

/// Standard uncertainty of the mean of independent readings.
Pressure uncertainty_of_mean(const std::vector<Pressure>& uncertainties) {
  double variance = 0.0;
  for (const Pressure one : uncertainties) variance += one.si() * one.si();
  return Pressure::from_si(std::sqrt(variance) / static_cast<double>(uncertainties.size()));
}

}  // namespace

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
    std::vector<CrossSections> sections;
    std::vector<Pressure> drops, uncertainties, outlets;
    for (const std::size_t i : members.at(name)) {
      run.flow_rate = experiment.flow[i].flow_rate;
      profiles.push_back(reduced[i].profile);
      sections.push_back(reduced[i].sections);
      sections.back().x -= reduced[i].condition.shift.shift.si();
      const experiment::FlowMap& map = experiment.flow[i];
      if (map.pressure_drop) drops.push_back(*map.pressure_drop);
      if (map.pressure_drop && map.pressure_drop_uncertainty) {
        uncertainties.push_back(*map.pressure_drop_uncertainty);
      }
      if (map.outlet_pressure) outlets.push_back(*map.outlet_pressure);
    }
    run.profile = mean_profile(profiles);
    run.sections = mean_sections(sections);
    run.transducer_drop = mean(drops);
    run.outlet_pressure = mean(outlets);
    if (!drops.empty() && uncertainties.size() == drops.size()) {
      run.transducer_uncertainty = uncertainty_of_mean(uncertainties);
    }
    runs.push_back(std::move(run));
  }
  return runs;
}

}  // namespace manoscope::pipeline

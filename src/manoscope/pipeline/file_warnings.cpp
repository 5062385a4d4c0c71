#include "manoscope/pipeline/file_warnings.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <atomic>
#include <optional>

#include "manoscope/core/parallel.hpp"

namespace manoscope::pipeline {

using experiment::Experiment;

io::ReadOptions reading_options(const Experiment& experiment) {
  io::ReadOptions options;
  const auto& instrument = experiment.instrument;
  if (instrument.pixel_pitch) {
    options.pitch_x = (*instrument.pixel_pitch)[0];
    options.pitch_y = (*instrument.pixel_pitch)[1];
  }
  options.height_unit = instrument.height_unit;
  options.channel = instrument.channel;
  return options;
}

std::vector<std::string> file_warnings(const Experiment& experiment,
                                       const std::vector<std::vector<std::string>>& warnings) {
  struct Told {
    std::string first, doubt;
    int n_others = 0;
  };
  std::vector<Told> list;
  const std::size_t n_static = experiment.hydrostatic.size();
  for (std::size_t i = 0; i < warnings.size(); ++i) {
    const std::string& name =
        i < n_static ? experiment.hydrostatic[i].name : experiment.flow[i - n_static].name;
    for (const std::string& doubt : warnings[i]) {
      const auto known = std::find_if(list.begin(), list.end(),
                                      [&](const Told& told) { return told.doubt == doubt; });
      if (known == list.end()) {
        list.push_back({name, doubt});
      } else {
        ++known->n_others;
      }
    }
  }
  std::vector<std::string> lines;
  for (const Told& told : list) {
    const std::string others =
        told.n_others == 0
            ? std::string()
            : fmt::format(" and {} other map{}", told.n_others, told.n_others == 1 ? "" : "s");
    lines.push_back(fmt::format("{}{}: {}", told.first, others, told.doubt));
  }
  return lines;
}

MapCheck check_maps(const Experiment& experiment, int n_threads, const Monitor& monitor) {
  std::vector<std::filesystem::path> paths;
  for (const auto& entry : experiment.hydrostatic) paths.push_back(entry.map);
  for (const auto& entry : experiment.flow) paths.push_back(entry.map);
  const io::ReadOptions options = reading_options(experiment);
  std::vector<std::vector<std::string>> warnings(paths.size());
  std::vector<std::optional<InputError>> faults(paths.size());
  std::atomic<int> done{0};
  parallel_for(static_cast<Index>(paths.size()), n_threads, [&](Index i) {
    monitor.checkpoint();
    const auto at = static_cast<std::size_t>(i);
    try {
      warnings[at] = io::load_height_map(paths[at], options).warnings;
    } catch (const InputError& error) {
      faults[at] = error;
    }
    monitor.report("reading maps", static_cast<double>(++done) / static_cast<double>(paths.size()));
  });
  MapCheck check;
  check.warnings = file_warnings(experiment, warnings);
  for (const auto& fault : faults) {
    if (fault) check.faults.push_back(*fault);
  }
  return check;
}

}  // namespace manoscope::pipeline

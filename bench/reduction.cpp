// Our side of the reduction benchmark: obeys compare.py line by line, as reduction.py does.
//
// bench_reduction INPUTS.json; then on standard input
//   reduce      read, hash, reduce and register every map once
//   read        read the bytes of every map and drop them
//   save FILE   write what the last reduction gave, as JSON
// Each line is answered by one JSON line: wall and processor seconds, peak resident memory.
#include <malloc.h>

#include <cstdio>
#include <iterator>

#include "manoscope/core/provenance.hpp"
#include "manoscope/io/reader.hpp"
#include "manoscope/maps/reduce.hpp"
#include "worker.hpp"

namespace manoscope::bench {
namespace {

struct Reduced {
  std::vector<std::string> hashes;
  std::vector<maps::ReducedMap> maps;
  std::vector<double> middles;  ///< m, of the wall across the flow at mid-channel
  std::vector<bool> moved;      ///< whether it lies elsewhere across the flow than the others
};

/// As pipeline::reduce_maps() with one thread, but for walls that lie elsewhere across the flow:
/// they are found, not reduced once more in their place; and but for patches of a false fringe
/// order, which the other side does not look for. Every second map, from the first, is hydrostatic.
Reduced reduce_all(const std::vector<std::string>& files, const ChannelFrame& frame) {
  Reduced all;
  std::vector<maps::ReducedMap> kinds[2];
  Length pitch_z{};
  maps::ReduceOptions options;
  options.fringe_order = false;
  for (std::size_t i = 0; i < files.size(); ++i) {
    const std::string& file = files[i];
    all.hashes.push_back(sha256(read_file(file)));
    const HeightMap map = io::read_height_map(file);
    pitch_z = map.grid().pitch_y;
    kinds[i % 2].push_back(maps::reduce_map(map, frame, {}, file, options));
  }
  auto& [hydrostatic, flow] = kinds;
  const std::size_t n_hydrostatic = hydrostatic.size();
  std::vector<maps::ReducedMap> both = std::move(hydrostatic);
  std::move(flow.begin(), flow.end(), std::back_inserter(both));
  const maps::Placements placements =
      maps::find_placements(both, n_hydrostatic, frame.length, pitch_z);
  const auto middle = both.begin() + static_cast<std::ptrdiff_t>(n_hydrostatic);
  hydrostatic.assign(std::make_move_iterator(both.begin()), std::make_move_iterator(middle));
  flow.assign(std::make_move_iterator(middle), std::make_move_iterator(both.end()));
  maps::register_maps(hydrostatic, flow, frame.length, frame.width, options);
  for (std::size_t i = 0; i < files.size(); ++i) {
    all.maps.push_back(std::move(kinds[i % 2][i / 2]));
    const auto& centre = all.maps.back().condition.centre;
    all.middles.push_back(centre ? centre->offset.si() : 0.0);
    const auto& own = placements.own[i % 2 * n_hydrostatic + i / 2];
    all.moved.push_back(own.farthest(frame.length.si()) != 0.0);
  }
  return all;
}

nlohmann::json as_json(const Reduced& all, std::size_t i) {
  const maps::ReducedMap& map = all.maps[i];
  const Profile& profile = map.profile;
  const auto list = [](const auto& array) {
    return std::vector<double>(array.data(), array.data() + array.size());
  };
  return {{"hash", all.hashes[i]},
          {"x_m", list(profile.x)},
          {"zeta_m", list(profile.zeta)},
          {"uncertainty_m", list(profile.uncertainty.standard())},
          {"flags", std::vector<int>(profile.flags.begin(), profile.flags.end())},
          {"noise_m", map.condition.noise.sigma.si()},
          {"noise_length_x", map.condition.noise.length_x},
          {"noise_length_z", map.condition.noise.length_z},
          {"spikes", map.condition.spikes},
          {"shift_m", map.condition.shift.shift.si()},
          {"middle_m", all.middles[i]},
          {"moved", static_cast<bool>(all.moved[i])},
          {"crest_m", map.crest},
          {"crest_uncertainty_m", map.crest_uncertainty}};
}

void obey_all(const std::string& inputs_file) {
  const nlohmann::json inputs = read_json(inputs_file);
  const auto files = inputs.at("maps").get<std::vector<std::string>>();
  const ChannelFrame frame = frame_of(inputs);
  Reduced last;
  obey_lines([&](const std::string& line) {
    if (line == "reduce") {
      last = reduce_all(files, frame);
    } else if (line == "read") {
      read_all(files, std::size_t{1} << 20);
    } else if (line.starts_with("save ")) {
      nlohmann::json all;
      for (std::size_t i = 0; i < last.maps.size(); ++i) {
        all.push_back(as_json(last, i));
      }
      std::ofstream(line.substr(5)) << all;
    } else {
      throw std::runtime_error("unknown order: " + line);
    }
  });
}

}  // namespace
}  // namespace manoscope::bench

int main(int argc, char** argv) try {
  mallopt(M_MMAP_THRESHOLD, 32 << 20);  // as the program does, see src/cli/main.cpp
  mallopt(M_TRIM_THRESHOLD, 256 << 20);
  if (argc != 2) throw std::runtime_error("usage: bench_reduction INPUTS.json");
  manoscope::bench::obey_all(argv[1]);
  return 0;
} catch (const std::exception& failure) {
  std::fprintf(stderr, "bench_reduction: %s\n", failure.what());
  return 1;
}

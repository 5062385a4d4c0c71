// Our side of the reduction benchmark: obeys compare.py line by line, as reduction.py does.
//
// bench_reduction INPUTS.json; then on standard input
//   reduce      read, hash and reduce every map once
//   read        read the bytes of every map and drop them
//   save FILE   write what the last reduction gave, as JSON
// Each line is answered by one JSON line: wall and processor seconds, peak resident memory.
#include <malloc.h>

#include <cstdio>

#include "manoscope/core/provenance.hpp"
#include "manoscope/io/reader.hpp"
#include "manoscope/maps/reduce.hpp"
#include "worker.hpp"

namespace manoscope::bench {
namespace {

struct Reduced {
  std::string hash;
  maps::ReducedMap map;
};

/// As pipeline::reduce_maps() with one thread.
std::vector<Reduced> reduce_all(const std::vector<std::string>& files, const ChannelFrame& frame) {
  std::vector<Reduced> all;
  for (const std::string& file : files) {
    std::string hash = sha256(read_file(file));
    all.push_back({std::move(hash), maps::reduce_map(io::read_height_map(file), frame, {}, file)});
  }
  return all;
}

nlohmann::json as_json(const Reduced& reduced) {
  const Profile& profile = reduced.map.profile;
  const auto list = [](const auto& array) {
    return std::vector<double>(array.data(), array.data() + array.size());
  };
  return {{"hash", reduced.hash},
          {"x_m", list(profile.x)},
          {"zeta_m", list(profile.zeta)},
          {"uncertainty_m", list(profile.uncertainty.standard())},
          {"flags", std::vector<int>(profile.flags.begin(), profile.flags.end())},
          {"noise_m", reduced.map.condition.noise.sigma.si()},
          {"noise_length_x", reduced.map.condition.noise.length_x},
          {"noise_length_z", reduced.map.condition.noise.length_z},
          {"spikes", reduced.map.condition.spikes},
          {"crest_m", reduced.map.crest},
          {"crest_uncertainty_m", reduced.map.crest_uncertainty}};
}

void obey_all(const std::string& inputs_file) {
  const nlohmann::json inputs = read_json(inputs_file);
  const auto files = inputs.at("maps").get<std::vector<std::string>>();
  const ChannelFrame frame = frame_of(inputs);
  std::vector<Reduced> last;
  obey_lines([&](const std::string& line) {
    if (line == "reduce") {
      last = reduce_all(files, frame);
    } else if (line == "read") {
      read_all(files, std::size_t{1} << 20);
    } else if (line.starts_with("save ")) {
      nlohmann::json all;
      for (const Reduced& reduced : last) all.push_back(as_json(reduced));
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

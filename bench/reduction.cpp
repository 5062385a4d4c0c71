// Our side of the reduction benchmark: obeys compare.py line by line, as reduction.py does.
//
// bench_reduction INPUTS.json; then on standard input
//   reduce      read, hash and reduce every map once
//   read        read the bytes of every map and drop them
//   save FILE   write what the last reduction gave, as JSON
// Each line is answered by one JSON line: wall and processor seconds, peak resident memory.
#include <fcntl.h>
#include <malloc.h>
#include <unistd.h>

#include <chrono>
#include <cstdio>
#include <ctime>
#include <fstream>
#include <iostream>
#include <nlohmann/json.hpp>
#include <stdexcept>

#include "manoscope/core/provenance.hpp"
#include "manoscope/io/reader.hpp"
#include "manoscope/maps/reduce.hpp"

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
    all.push_back(
        {std::move(hash), maps::reduce_map(io::read_height_map(file), frame, std::nullopt, file)});
  }
  return all;
}

void read_all(const std::vector<std::string>& files) {
  std::vector<char> buffer(1 << 20);
  for (const std::string& file : files) {
    const int descriptor = ::open(file.c_str(), O_RDONLY);
    if (descriptor < 0) throw std::runtime_error("cannot open " + file);
    while (::read(descriptor, buffer.data(), buffer.size()) > 0) {
    }
    ::close(descriptor);
  }
}

/// High-water mark of this program alone; getrusage() would count whoever started it.
double peak_MB() {
  std::ifstream status("/proc/self/status");
  for (std::string line; std::getline(status, line);) {
    if (line.starts_with("VmHWM:")) return std::stod(line.substr(6)) / 1024.0;
  }
  return 0.0;
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

void obey(const std::filesystem::path& inputs_file) {
  std::ifstream stream(inputs_file);
  const nlohmann::json inputs = nlohmann::json::parse(stream);
  const auto files = inputs.at("maps").get<std::vector<std::string>>();
  ChannelFrame frame;
  frame.length = Length::from_si(inputs.at("length_m"));
  frame.width = Length::from_si(inputs.at("width_m"));
  frame.origin_x = Length::from_si(inputs.at("origin_x_m"));
  frame.origin_y = Length::from_si(inputs.at("origin_z_m"));

  std::vector<Reduced> last;
  for (std::string line; std::getline(std::cin, line);) {
    const auto start = std::chrono::steady_clock::now();
    const std::clock_t processor = std::clock();
    if (line == "reduce") {
      last = reduce_all(files, frame);
    } else if (line == "read") {
      read_all(files);
    } else if (line.starts_with("save ")) {
      nlohmann::json all;
      for (const Reduced& reduced : last) all.push_back(as_json(reduced));
      std::ofstream(line.substr(5)) << all;
    } else {
      throw std::runtime_error("unknown order: " + line);
    }
    const std::chrono::duration<double> wall = std::chrono::steady_clock::now() - start;
    const nlohmann::json answer = {
        {"wall_s", wall.count()},
        {"cpu_s", static_cast<double>(std::clock() - processor) / CLOCKS_PER_SEC},
        {"peak_MB", peak_MB()}};
    std::cout << answer << std::endl;
  }
}

}  // namespace
}  // namespace manoscope::bench

int main(int argc, char** argv) try {
  mallopt(M_MMAP_THRESHOLD, 32 << 20);  // as the program does, see src/cli/main.cpp
  mallopt(M_TRIM_THRESHOLD, 256 << 20);
  if (argc != 2) throw std::runtime_error("usage: bench_reduction INPUTS.json");
  manoscope::bench::obey(argv[1]);
  return 0;
} catch (const std::exception& failure) {
  std::fprintf(stderr, "bench_reduction: %s\n", failure.what());
  return 1;
}

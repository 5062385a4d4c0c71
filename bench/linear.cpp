// Our side of the benchmark of the one-pass reduction: obeys compare.py line by line, as linear.py
// does.
//
// bench_linear INPUTS.json; then on standard input
//   reduce FORMAT THREADS   read and reduce every map of FORMAT (raw, gsf) once
//   read FORMAT             read the bytes of every map and drop them
//   save FILE               write what the last reduction gave, as JSON
// Each line is answered by one JSON line: wall and processor seconds, peak resident memory.
#include <malloc.h>

#include <cstdio>
#include <sstream>

#include "manoscope/pipeline/quick_profiles.hpp"
#include "worker.hpp"

namespace manoscope::bench {
namespace {

nlohmann::json as_json(const maps::LinearReduction& reduced) {
  const auto list = [](const auto& array) {
    return std::vector<double>(array.data(), array.data() + array.size());
  };
  const Profile& profile = reduced.profile;
  return {{"x_m", list(profile.x)},
          {"zeta_m", list(profile.zeta)},
          {"uncertainty_m", list(profile.uncertainty.standard())},
          {"flags", std::vector<int>(profile.flags.begin(), profile.flags.end())},
          {"noise_m", reduced.plane.sigma.si()}};
}

void obey_all(const std::string& inputs_file) {
  const nlohmann::json inputs = read_json(inputs_file);
  const ChannelFrame frame = frame_of(inputs);
  const CameraGrid grid{inputs.at("nx"), inputs.at("nz"), Length::from_si(inputs.at("pitch_x_m")),
                        Length::from_si(inputs.at("pitch_z_m"))};
  // The fastest of the buffers tried: larger ones leave the processor's cache.
  constexpr std::size_t kBuffer = std::size_t{128} << 10;
  std::vector<maps::LinearReduction> last;
  obey_lines([&](const std::string& line) {
    std::istringstream words(line);
    std::string order, what;
    int n_threads = 1;
    words >> order >> what >> n_threads;
    if (order == "save") {
      nlohmann::json all;
      for (const auto& reduced : last) all.push_back(as_json(reduced));
      std::ofstream(what) << all;
      return;
    }
    const auto files = inputs.at(what).get<std::vector<std::string>>();
    if (order == "read") {
      read_all(files, kBuffer);
    } else if (order == "reduce") {
      pipeline::QuickProfilesOptions options;
      if (what == "raw") options.raw = io::RawFloats{grid, 1.0};
      last = pipeline::quick_profiles({files.begin(), files.end()}, frame, options, n_threads);
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
  if (argc != 2) throw std::runtime_error("usage: bench_linear INPUTS.json");
  manoscope::bench::obey_all(argv[1]);
  return 0;
} catch (const std::exception& failure) {
  std::fprintf(stderr, "bench_linear: %s\n", failure.what());
  return 1;
}

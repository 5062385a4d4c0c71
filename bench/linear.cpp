// Our side of the benchmark of the one-pass reduction: obeys compare.py line by line, as linear.py
// does.
//
// bench_linear INPUTS.json; then on standard input
//   reduce FORMAT THREADS   read and reduce every map of FORMAT (raw, gsf) once
//   read FORMAT             read the bytes of every map and drop them
//   save FILE               write what the last reduction gave, as JSON
// Each line is answered by one JSON line: wall and processor seconds, peak resident memory.
#include <malloc.h>

#include <algorithm>
#include <cstdio>
#include <memory>
#include <sstream>

#include "manoscope/core/parallel.hpp"
#include "manoscope/io/float_rows.hpp"
#include "manoscope/maps/linear_reduction.hpp"
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

/// One pass over each map, read piece by piece; a share of the maps to a thread, which reuses what
/// it holds from map to map.
/// @param raw  layout of the files; null: .gsf
std::vector<maps::LinearReduction> reduce_all(const std::vector<std::string>& files,
                                              const ChannelFrame& frame, const io::RawFloats* raw,
                                              int n_threads) {
  std::vector<maps::LinearReduction> results(files.size());
  const CameraGrid grid = raw != nullptr ? raw->grid : io::FloatRows(files.front()).grid();
  const maps::LinearReducer reducer(grid, frame, files.front());
  const auto n_files = static_cast<Index>(files.size());
  // Several shares a thread: one that is held up leaves its last to the other.
  const Index n_shares = n_threads == 1 ? 1 : std::min<Index>(4 * n_threads, n_files);
  parallel_for(n_shares, n_threads, [&](Index share) {
    maps::LinearPass pass(reducer);
    io::PieceBuffer buffer;
    for (Index i = share * n_files / n_shares; i < (share + 1) * n_files / n_shares; ++i) {
      const std::string& file = files[static_cast<std::size_t>(i)];
      const auto map = raw != nullptr ? std::make_unique<io::FloatRows>(file, *raw, &buffer)
                                      : std::make_unique<io::FloatRows>(file, &buffer);
      if (!(map->grid() == grid)) throw std::runtime_error(file + " is of another camera");
      for (auto rows = map->next(); !rows.empty(); rows = map->next()) pass.add_rows(rows);
      results[static_cast<std::size_t>(i)] = pass.finish(map->metres_per_unit(), file);
    }
  });
  return results;
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
      const io::RawFloats raw{grid, 1.0};
      last = reduce_all(files, frame, what == "raw" ? &raw : nullptr, n_threads);
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

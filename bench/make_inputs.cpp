// bench_inputs maps FOLDER N: N synthetic maps and inputs.json, which says where the channel lies.
// bench_inputs experiment FOLDER: a virtual experiment of 33 maps with its truth.
#include <fmt/format.h>

#include <cstdio>
#include <fstream>
#include <nlohmann/json.hpp>

#include "inputs.hpp"
#include "manoscope/io/writer.hpp"
#include "manoscope/twin/experiment_files.hpp"

namespace manoscope::bench {
namespace {

void make_maps(const std::filesystem::path& folder, int n) {
  const flow::Channel channel = twin::small_s1().channel;
  const twin::InterferometerOptions camera = full_camera();
  const ChannelFrame frame = twin::channel_frame(channel, camera);
  nlohmann::json inputs = {{"length_m", frame.length.si()},
                           {"width_m", frame.width.si()},
                           {"origin_x_m", frame.origin_x.si()},
                           {"origin_z_m", frame.origin_y.si()}};
  for (int i = 0; i < n; ++i) {
    const auto path = folder / fmt::format("map{:02d}.gsf", i);
    io::write_map(path,
                  twin::record_map(channel, bulge(channel, i, n), camera, kSeed,
                                   static_cast<std::uint64_t>(i)),
                  fmt::format("benchmark map {}", i));
    inputs["maps"].push_back(path.string());
  }
  std::ofstream(folder / "inputs.json") << inputs.dump(1) << '\n';
}

}  // namespace
}  // namespace manoscope::bench

int main(int argc, char** argv) try {
  const std::vector<std::string> words(argv + 1, argv + argc);
  if (words.size() == 3 && words[0] == "maps") {
    manoscope::bench::make_maps(words[1], std::stoi(words[2]));
  } else if (words.size() == 2 && words[0] == "experiment") {
    using namespace manoscope;
    twin::write_experiment(
        words[1], twin::make_virtual_experiment(bench::full_scenario(), bench::kSeed), true);
  } else {
    std::fputs("usage: bench_inputs maps FOLDER N | bench_inputs experiment FOLDER\n", stderr);
    return 2;
  }
  return 0;
} catch (const std::exception& failure) {
  std::fprintf(stderr, "bench_inputs: %s\n", failure.what());
  return 1;
}

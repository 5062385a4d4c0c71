// bench_inputs maps FOLDER N: N synthetic maps and inputs.json, which says where the channel lies.
// bench_inputs frames FOLDER N NX NY DROPOUTS: N maps of NX x NY pixels without spikes, a share of
// them dropped out, each as .gsf and as raw 32-bit floats; and inputs.json.
#include <fmt/format.h>

#include <cstdio>
#include <fstream>
#include <limits>
#include <nlohmann/json.hpp>

#include "inputs.hpp"
#include "manoscope/io/writer.hpp"

namespace manoscope::bench {
namespace {

nlohmann::json place(const ChannelFrame& frame) {
  return {{"length_m", frame.length.si()},
          {"width_m", frame.width.si()},
          {"origin_x_m", frame.origin_x.si()},
          {"origin_z_m", frame.origin_y.si()}};
}

HeightMap make_map(const flow::Channel& channel, const twin::InterferometerOptions& camera, int i,
                   int n) {
  return twin::record_map(channel, bulge(channel, i, n), camera, kSeed,
                          static_cast<std::uint64_t>(i));
}

void make_maps(const std::filesystem::path& folder, int n) {
  const flow::Channel channel = twin::small_s1().channel;
  const twin::InterferometerOptions camera = full_camera();
  nlohmann::json inputs = place(twin::channel_frame(channel, camera));
  for (int i = 0; i < n; ++i) {
    const auto path = folder / fmt::format("map{:02d}.gsf", i);
    io::write_map(path, make_map(channel, camera, i, n), fmt::format("benchmark map {}", i));
    inputs["maps"].push_back(path.string());
  }
  std::ofstream(folder / "inputs.json") << inputs.dump(1) << '\n';
}

void write_raw(const std::filesystem::path& path, const HeightMap& map) {
  std::vector<float> pixels(static_cast<std::size_t>(map.height().size()));
  for (std::size_t i = 0; i < pixels.size(); ++i) {
    pixels[i] = map.flags().data()[i] == 0 ? static_cast<float>(map.height().data()[i])
                                           : std::numeric_limits<float>::quiet_NaN();
  }
  std::ofstream(path, std::ios::binary)
      .write(reinterpret_cast<const char*>(pixels.data()),
             static_cast<std::streamsize>(pixels.size() * sizeof(float)));
}

void make_frames(const std::filesystem::path& folder, int n, int nx, int ny, double dropouts) {
  const flow::Channel channel = twin::small_s1().channel;
  twin::InterferometerOptions camera = full_camera();
  camera.n_along = nx;
  camera.n_across = ny;
  camera.dropouts = dropouts;
  camera.spikes = 0.0;
  if (dropouts == 0.0) camera.blobs = 0.0;
  nlohmann::json inputs = place(twin::channel_frame(channel, camera));
  for (int i = 0; i < n; ++i) {
    const HeightMap map = make_map(channel, camera, i, n);
    const auto gsf = folder / fmt::format("frame{:02d}.gsf", i);
    const auto raw = folder / fmt::format("frame{:02d}.f32", i);
    io::write_map(gsf, map, fmt::format("benchmark frame {}", i));
    write_raw(raw, map);
    inputs["gsf"].push_back(gsf.string());
    inputs["raw"].push_back(raw.string());
    inputs["nx"] = map.grid().nx;
    inputs["nz"] = map.grid().ny;
    inputs["pitch_x_m"] = map.grid().pitch_x.si();
    inputs["pitch_z_m"] = map.grid().pitch_y.si();
  }
  std::ofstream(folder / "inputs.json") << inputs.dump(1) << '\n';
}

}  // namespace
}  // namespace manoscope::bench

int main(int argc, char** argv) try {
  const std::vector<std::string> words(argv + 1, argv + argc);
  if (words.size() == 3 && words[0] == "maps") {
    manoscope::bench::make_maps(words[1], std::stoi(words[2]));
  } else if (words.size() == 6 && words[0] == "frames") {
    manoscope::bench::make_frames(words[1], std::stoi(words[2]), std::stoi(words[3]),
                                  std::stoi(words[4]), std::stod(words[5]));
  } else {
    std::fputs("usage: bench_inputs maps FOLDER N | frames FOLDER N NX NY DROPOUTS\n", stderr);
    return 2;
  }
  return 0;
} catch (const std::exception& failure) {
  std::fprintf(stderr, "bench_inputs: %s\n", failure.what());
  return 1;
}

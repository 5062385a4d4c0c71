// Google Benchmark of each stage from a map file to p(x): bench_stages [--benchmark_filter=...].
#include <benchmark/benchmark.h>
#include <malloc.h>

#include <filesystem>

#include "calibration_inputs.hpp"
#include "inputs.hpp"
#include "manoscope/calibration/fit_curves.hpp"
#include "manoscope/core/provenance.hpp"
#include "manoscope/flow/section_march.hpp"
#include "manoscope/inversion/read_pressure.hpp"
#include "manoscope/io/reader.hpp"
#include "manoscope/io/writer.hpp"
#include "manoscope/maps/channel_map.hpp"
#include "manoscope/maps/despike.hpp"
#include "manoscope/maps/level.hpp"
#include "manoscope/maps/noise.hpp"
#include "manoscope/maps/reduce.hpp"
#include "manoscope/twin/scenario_file.hpp"

namespace manoscope::bench {
namespace {

/// One map of 1024 x 192 pixels, on disk and in memory, removed at the end.
class OneMap {
 public:
  OneMap() {
    std::string name = (std::filesystem::temp_directory_path() / "manoscope-bench-XXXXXX").string();
    if (::mkdtemp(name.data()) == nullptr) throw std::runtime_error("no temporary folder");
    folder = name;
    file = folder / "map.gsf";
    io::write_map(file, twin::record_map(channel, bulge(channel, 3, 4), full_camera(), kSeed, 0),
                  "benchmark");
    map = io::read_height_map(file);
    frame = twin::channel_frame(channel, full_camera());
    raw = maps::to_channel_frame(*map, frame);
    rim = maps::rim_mask(raw.grid, frame.length, frame.width, 50.0 * um);
    leveled = raw;
    maps::subtract_plane(leveled, maps::fit_rim_plane(leveled, rim, "map"));
  }
  OneMap(const OneMap&) = delete;
  OneMap& operator=(const OneMap&) = delete;
  ~OneMap() { std::filesystem::remove_all(folder); }

  flow::Channel channel = twin::small_s1().channel;
  std::filesystem::path folder, file;
  std::optional<HeightMap> map;
  ChannelFrame frame;
  maps::ChannelMap raw, leveled;
  Flags2 rim;
};

const OneMap& one_map() {
  static const OneMap map;
  return map;
}

void hash_file(benchmark::State& state) {
  for (auto _ : state) benchmark::DoNotOptimize(sha256(read_file(one_map().file)));
}

void read_gsf(benchmark::State& state) {
  for (auto _ : state) benchmark::DoNotOptimize(io::read_height_map(one_map().file));
}

void to_channel_frame(benchmark::State& state) {
  for (auto _ : state) {
    benchmark::DoNotOptimize(maps::to_channel_frame(*one_map().map, one_map().frame));
  }
}

void level(benchmark::State& state) {
  for (auto _ : state) {
    state.PauseTiming();
    maps::ChannelMap map = one_map().raw;
    state.ResumeTiming();
    maps::subtract_plane(map, maps::fit_rim_plane(map, one_map().rim, "map"));
    benchmark::DoNotOptimize(map.height.data());
  }
}

void measure_noise(benchmark::State& state) {
  for (auto _ : state) {
    benchmark::DoNotOptimize(maps::measure_noise(one_map().leveled, one_map().rim));
  }
}

void despike(benchmark::State& state) {
  for (auto _ : state) {
    state.PauseTiming();
    maps::ChannelMap map = one_map().leveled;
    state.ResumeTiming();
    benchmark::DoNotOptimize(maps::flag_spikes(map, 20.0 * nm, 6.0));
  }
}

void rim_bend(benchmark::State& state) {
  const OneMap& one = one_map();
  for (auto _ : state) {
    benchmark::DoNotOptimize(
        maps::fit_rim_bend(one.leveled, one.rim, 20.0 * nm, one.frame.length).coefficient);
  }
}

/// On a map without patches: what every map costs.
void fringe_order(benchmark::State& state) {
  maps::ChannelMap map = one_map().leveled;
  maps::flag_spikes(map, 20.0 * nm, 6.0);
  for (auto _ : state) {
    benchmark::DoNotOptimize(maps::mend_fringe_patches(map, 20.0 * nm, {}));
  }
}

void width_average(benchmark::State& state) {
  const OneMap& one = one_map();
  const maps::LeveledMap leveled = maps::level_map(*one.map, one.frame, {}, "map");
  for (auto _ : state) {
    benchmark::DoNotOptimize(maps::width_average(leveled.deflection, leveled.plane,
                                                 one.frame.length, one.frame.width, "map"));
  }
}

void reduce_map(benchmark::State& state) {
  const OneMap& one = one_map();
  for (auto _ : state) {
    benchmark::DoNotOptimize(maps::reduce_map(*one.map, one.frame, {}, "map"));
  }
}

void fit_curves(benchmark::State& state) {
  const auto levels = calibration_levels();
  for (auto _ : state) benchmark::DoNotOptimize(calibration::fit_curves(levels));
}

void read_pressure(benchmark::State& state) {
  const auto curves = calibration::fit_curves(calibration_levels());
  const Profile run = profile_at(12000.0, "f00");
  for (auto _ : state) benchmark::DoNotOptimize(inversion::read_pressure(curves, run));
}

void read_pressure_and_covariance(benchmark::State& state) {
  const auto curves = calibration::fit_curves(calibration_levels());
  const Profile run = profile_at(12000.0, "f00");
  for (auto _ : state) {
    const auto reading = inversion::read_pressure(curves, run);
    benchmark::DoNotOptimize(reading.uncertainty.covariance());
  }
}

/// The 0.2 um nitride wall of S1 on the scenario's grid, from rest, to a residual of 1e-8.
/// 1000 stations of a channel 175 um high under a wall that bulges by 33 um, at 70 mL/min.
void section_march(benchmark::State& state) {
  const Array1 x = Array1::LinSpaced(1000, 0.0, 15.5e-3);
  const Array1 ends = (1.0 - (-x / 0.6e-3).exp()) * (1.0 - ((x - 15.5e-3) / 0.6e-3).exp());
  const Array1 zeta = 33e-6 * (1.0 - 0.6 * x / 15.5e-3) * ends;
  for (auto _ : state) {
    benchmark::DoNotOptimize(
        flow::march_section({15.5 * mm, 1.7 * mm, 175.0 * um}, flow::WallShape::parabola(),
                            {1.0 * mPa_s, 998.0 * kg_per_m3}, 70.0 * mL_per_min, x, zeta)
            .pressure[0]);
  }
}

void wall_state(benchmark::State& state) {
  const twin::Scenario scenario = twin::find_scenario("S1");
  wall::FopplVonKarmanOptions options;
  options.n_cells_x = scenario.wall_grid.n_cells_x;
  options.n_cells_z = scenario.wall_grid.n_cells_z;
  options.design_pressure = scenario.levels.back();
  options.tolerance = 1e-8;
  const wall::FopplVonKarman plate(scenario.wall, options);
  const auto load = wall::WallLoad::uniform(10.0 * kPa);
  for (auto _ : state) benchmark::DoNotOptimize(plate.equilibrium(load));
}

BENCHMARK(section_march)->Unit(benchmark::kMillisecond);
BENCHMARK(wall_state)->Unit(benchmark::kMillisecond);
BENCHMARK(hash_file)->Unit(benchmark::kMillisecond);
BENCHMARK(read_gsf)->Unit(benchmark::kMillisecond);
BENCHMARK(to_channel_frame)->Unit(benchmark::kMillisecond);
BENCHMARK(level)->Unit(benchmark::kMillisecond);
BENCHMARK(measure_noise)->Unit(benchmark::kMillisecond);
BENCHMARK(rim_bend)->Unit(benchmark::kMillisecond);
BENCHMARK(despike)->Unit(benchmark::kMillisecond);
BENCHMARK(fringe_order)->Unit(benchmark::kMillisecond);
BENCHMARK(width_average)->Unit(benchmark::kMillisecond);
BENCHMARK(reduce_map)->Unit(benchmark::kMillisecond);
BENCHMARK(fit_curves)->Unit(benchmark::kMillisecond);
BENCHMARK(read_pressure)->Unit(benchmark::kMillisecond);
BENCHMARK(read_pressure_and_covariance)->Unit(benchmark::kMillisecond);

}  // namespace
}  // namespace manoscope::bench

int main(int argc, char** argv) {
  mallopt(M_MMAP_THRESHOLD, 32 << 20);  // as the program does, see src/cli/main.cpp
  mallopt(M_TRIM_THRESHOLD, 256 << 20);
  benchmark::Initialize(&argc, argv);
  if (benchmark::ReportUnrecognizedArguments(argc, argv)) return 2;
  benchmark::RunSpecifiedBenchmarks();
  benchmark::Shutdown();
  return 0;
}

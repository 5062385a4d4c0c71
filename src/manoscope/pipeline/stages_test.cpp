#include "manoscope/pipeline/stages.hpp"

#include <gtest/gtest.h>

#include <cmath>
#include <fstream>

#include "manoscope/core/random.hpp"
#include "manoscope/io/test_instrument_files.hpp"
#include "manoscope/maps/camera_window.hpp"
#include "manoscope/pipeline/test_experiment.hpp"

namespace manoscope::pipeline {
namespace {

ReducedExperiment reduce(const experiment::Experiment& experiment) {
  return reduce_maps(experiment, place_channel(experiment).frame, {}, 1, {});
}

/// The experiment with a second map of level h10 and of run Q70.
experiment::Experiment with_repeats(TestExperiment& test) {
  const auto add = [&](const std::string& from, const std::string& name, std::uint64_t seed) {
    TestExperiment other(test.scenario, seed);
    test.twin.maps.push_back({name, name, other.map(from)});
  };
  add("h10.gsf", "again.gsf", 2);
  add("f01.gsf", "g01.gsf", 3);
  // The same label as the first map of the level has.
  const auto at = test.twin.hydrostatic_csv.find("h10.gsf") + 7;
  const auto end = test.twin.hydrostatic_csv.find(',', at + 1);
  test.twin.hydrostatic_csv +=
      "again.gsf" + test.twin.hydrostatic_csv.substr(at, end - at) + ",10,17\n";
  test.twin.flow_csv =
      "map,flow_rate [mL/min],pressure_drop [Pa],run\n"
      "f01.gsf,70,12000,fast\nf00.gsf,20,,slow\ng01.gsf,70,12100,fast\n";
  return test.read();
}

TEST(MakeRuns, AverageTheMapsOfARunAndItsTransducer) {
  TestExperiment test;
  const auto experiment = with_repeats(test);
  const ReducedExperiment reduced = reduce(experiment);
  const auto runs = make_runs(experiment, reduced.flow);
  ASSERT_EQ(runs.size(), 2u);
  EXPECT_EQ(runs[0].name, "fast");  // in the order of their first map
  EXPECT_EQ(runs[1].name, "slow");
  EXPECT_NEAR(runs[0].flow_rate.in(mL_per_min), 70.0, 1e-9);
  ASSERT_TRUE(runs[0].transducer_drop);
  EXPECT_EQ(*runs[0].transducer_drop, 12050.0 * Pa);
  EXPECT_FALSE(runs[1].transducer_drop);
  const Profile &a = reduced.flow[0].profile, &b = reduced.flow[2].profile;
  for (Index ix = 0; ix < a.x.size(); ++ix) {
    if (a.flags[ix] != 0 || b.flags[ix] != 0) continue;
    EXPECT_DOUBLE_EQ(runs[0].profile.zeta[ix], 0.5 * (a.zeta[ix] + b.zeta[ix]));
    EXPECT_NEAR(runs[0].profile.uncertainty.independent[ix],
                0.5 * std::hypot(a.uncertainty.independent[ix], b.uncertainty.independent[ix]),
                1e-15);
  }
  EXPECT_TRUE((runs[1].profile.zeta == reduced.flow[1].profile.zeta).all());
}

TEST(MakeRuns, RepeatsComeNearerToTheTruth) {
  TestExperiment test;
  const auto m = measure(with_repeats(test));
  const auto single = TestExperiment().measure();
  EXPECT_EQ(m.level_pressure.size(), single.level_pressure.size());  // 18 maps at 17 levels
  EXPECT_EQ(m.map.size(), 21u);
  EXPECT_EQ(m.transducer_drop[0], 12050.0);
  EXPECT_TRUE(std::isnan(m.transducer_drop[1]));
  const Index middle = m.x.size() / 2;
  // Everything in a profile's uncertainty is of its own map, but for the quadrature across the
  // width, the same share zeta (pitch / width)^2 of every profile: 64 rows over 2.5 mm.
  const double lost = std::pow(2.5 / 64.0 / 1.7, 2);
  const auto own = [lost](double uncertainty, double zeta) {
    return std::sqrt(uncertainty * uncertainty - lost * lost * zeta * zeta);
  };
  EXPECT_NEAR(own(m.deflection_uncertainty(0, middle), m.deflection(0, middle)) /
                  own(single.deflection_uncertainty(1, middle), single.deflection(1, middle)),
              std::sqrt(0.5), 0.1);  // the repeat is another map, its place known a third better
  EXPECT_NEAR(own(m.static_deflection_uncertainty(10, middle), m.static_deflection(10, middle)) /
                  own(single.static_deflection_uncertainty(10, middle),
                      single.static_deflection(10, middle)),
              std::sqrt(0.5), 0.05);
  EXPECT_NEAR(m.level_pressure_uncertainty[10], 10.0 * std::sqrt(0.5), 1e-9);
  EXPECT_NEAR(m.crest_deflection_uncertainty[10] / single.crest_deflection_uncertainty[10],
              std::sqrt(0.5), 0.05);
}

TEST(ReduceMaps, KeepsTheOrderOfTheLists) {
  TestExperiment test;
  const auto experiment = test.read();
  const ReducedExperiment reduced = reduce(experiment);
  ASSERT_EQ(reduced.hydrostatic.size(), 17u);
  ASSERT_EQ(reduced.flow.size(), 2u);
  ASSERT_EQ(reduced.hash.size(), 19u);
  for (std::size_t k = 0; k < 17; ++k) {
    EXPECT_EQ(reduced.hydrostatic[k].condition.name, experiment.hydrostatic[k].name);
  }
  EXPECT_EQ(reduced.flow[1].condition.name, "f01.gsf");
  const auto levels = make_levels(experiment, reduced.hydrostatic);
  ASSERT_EQ(levels.size(), 17u);
  EXPECT_EQ(levels[3].name, "h03.gsf");
  EXPECT_EQ(levels[0].uncertainty, Pressure{});  // vented
  EXPECT_EQ(levels[3].uncertainty, 10.0 * Pa);
}

/// The map as Zygo MetroPro would have saved it through a window of the camera; of square pixels.
std::string zygo_file(const HeightMap& map, Index offset_x, Index offset_y) {
  io::testing::ZygoDat file;
  file.n_buckets = 0;
  file.phase_resolution = 2;
  file.lateral_resolution = static_cast<float>(map.grid().pitch_x.si());
  constexpr double kStep = 632.8e-9 * 0.5 / 131072.0;  // m, as the fixture's header says
  constexpr std::int32_t kMissing = 2147483640;
  file.phases.clear();
  for (Index i = 0; i < map.height().size(); ++i) {
    file.phases.push_back(map.flags().data()[i] != 0 ? kMissing
                                                     : static_cast<std::int32_t>(std::lround(
                                                           map.height().data()[i] / kStep)));
  }
  const auto word = [](Index value) {
    return io::testing::big(static_cast<std::uint64_t>(value), 2);
  };
  std::string bytes = file.bytes();
  io::testing::put(bytes, 64,
                   word(offset_x) + word(offset_y) + word(map.grid().nx) + word(map.grid().ny) +
                       io::testing::big(4 * file.phases.size(), 4));
  return bytes;
}

/// Another window on the same pixels: `right` and `down` of the first one, missing beyond it.
HeightMap through_window(const HeightMap& map, Index right, Index down, Index nx, Index ny) {
  return maps::into_window(map, 0, 0,
                           {{nx, ny, map.grid().pitch_x, map.grid().pitch_y}, right, down}, "a");
}

TEST(ReduceMaps, LayMapsOfOtherCameraWindowsPixelOnPixel) {
  twin::Scenario scenario = small_scenario();
  scenario.camera.n_across = 39;  // pixels of 64 um both ways, as the format has one size only
  TestExperiment test(scenario);
  const auto experiment = test.read();
  const auto write_as_zygo = [&](const std::string& name, const HeightMap& map, Index x, Index y) {
    std::ofstream(test.folder() / name, std::ios::binary) << zygo_file(map, x, y);
  };
  constexpr Index kX = 20, kY = 10;
  for (const auto& map : test.twin.maps) write_as_zygo(map.name, map.map, kX, kY);
  const ReducedExperiment same = reduce(experiment);
  // One of the same size, three columns on; one smaller; one larger.
  const Index nx = same.grid.nx, ny = same.grid.ny;
  write_as_zygo("h03.gsf", through_window(test.map("h03.gsf"), 3, 0, nx, ny), kX + 3, kY);
  write_as_zygo("h05.gsf", through_window(test.map("h05.gsf"), 2, 1, nx - 4, ny - 2), kX + 2,
                kY + 1);
  write_as_zygo("f01.gsf", through_window(test.map("f01.gsf"), -5, -4, nx + 9, ny + 6), kX - 5,
                kY - 4);
  const ReducedExperiment other = reduce(experiment);
  EXPECT_EQ(other.grid, same.grid);
  const auto expect_same = [](const maps::ReducedMap& a, const maps::ReducedMap& b) {
    SCOPED_TRACE(a.condition.name);
    Index n = 0;
    for (Index ix = 0; ix < a.profile.x.size(); ++ix) {
      if (a.profile.flags[ix] != 0 || b.profile.flags[ix] != 0) continue;
      ++n;
      // What the missing border changes is the plane of the rim: within its own uncertainty.
      EXPECT_NEAR(a.profile.zeta[ix], b.profile.zeta[ix],
                  3.0 * a.profile.uncertainty.standard()[ix]);
    }
    EXPECT_GT(n, 200);
    EXPECT_NEAR(a.condition.shift.shift.si(), b.condition.shift.shift.si(), 2e-6);
  };
  expect_same(same.hydrostatic[3], other.hydrostatic[3]);
  expect_same(same.hydrostatic[5], other.hydrostatic[5]);
  expect_same(same.flow[1], other.flow[1]);
  EXPECT_GT(other.hydrostatic[3].condition.missing, same.hydrostatic[3].condition.missing);
}

TEST(ReduceMaps, RefuseMapsOfAnotherSizeThatNameNoWindow) {
  TestExperiment test;
  test.map("h03.gsf") = through_window(test.map("h03.gsf"), 2, 1, 250, 60);
  const auto experiment = test.read();
  EXPECT_THROW(static_cast<void>(reduce(experiment)), InputError);
}

/// Middle between the two places at which a profile passes half of its greatest deflection.
double middle_of(const Profile& profile) {
  const double half = 0.5 * profile.zeta.maxCoeff();
  double first = 0.0, last = 0.0;
  for (Index ix = 0; ix + 1 < profile.x.size(); ++ix) {
    const double here = profile.zeta[ix] - half, next = profile.zeta[ix + 1] - half;
    if (here * next > 0.0 || here == next) continue;
    const double x = profile.x[ix] + (profile.x[ix + 1] - profile.x[ix]) * here / (here - next);
    if (first == 0.0) first = x;
    last = x;
  }
  return 0.5 * (first + last);
}

TEST(ReduceMaps, CountXFromTheWallsOwnEndsWhereThePlaceIsFound) {
  twin::Scenario scenario = small_scenario();
  scenario.camera.n_along = 640;  // coarser ones show too little of the wall's ends
  TestExperiment test(scenario);
  test.leave_out_place();
  const auto experiment = test.read();
  const ChannelFrame frame = place_channel(experiment).frame;
  for (const double pixels : {-0.4, 0.0, 0.4}) {
    // As if other two maps had been the ones that the place is found from.
    ChannelFrame moved = frame;
    moved.origin_x += pixels * 25.5 * um;
    const ReducedExperiment reduced = reduce_maps(experiment, moved, {}, 1, {});
    ASSERT_TRUE(reduced.offset);
    EXPECT_EQ(reduced.offset->shift, Length{});
    // Uniform pressure: the same to both ends. Noise, and a straight line over a pixel of a bent
    // flank, miss the half by a fifth of a pixel; the frames lie 0.4 pixels apart.
    for (const std::size_t k : {8U, 12U, 16U}) {
      EXPECT_NEAR(middle_of(reduced.hydrostatic[k].profile), 7.75e-3, 5e-6) << pixels << ' ' << k;
    }
  }
}

/// A camera of 24 x 23 um a pixel that sees 33 pixels of rim and never moves.
twin::Scenario rimmed_scenario() {
  twin::Scenario scenario = small_scenario();
  scenario.camera.n_along = 704;
  scenario.camera.n_across = 144;
  scenario.camera.rim = 0.8 * mm;
  scenario.camera.shift = Length{};
  return scenario;
}

/// Adds 50 nm of texture, correlated over 2 pixels, to the rim of a map.
void add_texture(HeightMap& map) {
  constexpr Index kRim = 32;
  RandomStream random(8, "texture of the rim");
  Array2 white(map.grid().ny + 4, map.grid().nx + 4);
  for (Index i = 0; i < white.size(); ++i) white.data()[i] = random.normal();
  Array2 height = map.height();
  const Index nx = map.grid().nx, ny = map.grid().ny;
  for (Index iy = 0; iy < ny; ++iy) {
    for (Index ix = 0; ix < nx; ++ix) {
      if (ix >= kRim && ix < nx - kRim && iy >= kRim && iy < ny - kRim) continue;
      height(iy, ix) += 50e-9 * white.block<5, 5>(iy, ix).sum() / 5.0;
    }
  }
  map = HeightMap(map.grid(), std::move(height), Flags2(map.flags()));
}

TEST(ReduceMaps, TakeShiftsFromTheTextureOfTheFrameWhereTheWallShowsNone) {
  constexpr Index kColumns = 2, kLevel = 5;  // 700 Pa: neither bowed nor stretched, without ends
  const auto reduced_with = [&](bool textured) {
    TestExperiment shifted(rimmed_scenario());
    for (auto& map : shifted.twin.maps) {
      if (textured) add_texture(map.map);
    }
    HeightMap& map = shifted.map("h05.gsf");
    map = through_window(map, -kColumns, 0, map.grid().nx, map.grid().ny);
    return reduce(shifted.read());
  };
  const auto bare = reduced_with(false), textured = reduced_with(true);
  const double pitch = bare.grid.pitch_x.si();
  EXPECT_FALSE(bare.hydrostatic[kLevel].condition.texture);
  // None of its own: what all maps have in common alone, of a wall not quite symmetric.
  EXPECT_LT(std::abs(bare.hydrostatic[kLevel].condition.shift.shift.si()), 0.1e-6);
  const maps::MapCondition& found = textured.hydrostatic[kLevel].condition;
  ASSERT_TRUE(found.texture);
  EXPECT_FALSE(found.texture_contradicts);
  EXPECT_LT(found.shift.uncertainty.si(), 0.05 * pitch);
  EXPECT_NEAR(found.shift.shift.si(), kColumns * pitch, 4.0 * found.shift.uncertainty.si());
}

TEST(ReduceMaps, LeaveOutATextureThatDoesNotMoveWithTheWall) {
  TestExperiment shifted(rimmed_scenario());
  std::vector<double> columns;
  for (auto& map : shifted.twin.maps) {
    const Index right = static_cast<Index>(columns.size() % 7) - 3;
    columns.push_back(static_cast<double>(right));
    map.map = through_window(map.map, right, 0, map.map.grid().nx, map.map.grid().ny);
    add_texture(map.map);
  }
  const auto reduced = reduce(shifted.read());
  ASSERT_TRUE(reduced.offset);
  int n_with_ends = 0;
  for (std::size_t k = 0; k < reduced.hydrostatic.size(); ++k) {
    const auto& condition = reduced.hydrostatic[k].condition;
    EXPECT_TRUE(condition.texture) << k;
    EXPECT_TRUE(condition.texture_contradicts);
    if (condition.shift.uncertainty > 2.0 * um) continue;  // this wall shows no ends
    ++n_with_ends;
    const double shift = (condition.shift.shift + reduced.offset->shift).si();
    // The ends of a wall seen by pixels of 24 um, whose middle is that of the frame to a pixel's
    // twentieth: a tenth of a pixel where the texture would be off by up to three.
    EXPECT_NEAR(shift, -columns[k] * reduced.grid.pitch_x.si(), 2.4e-6) << k;
  }
  EXPECT_GT(n_with_ends, 8);
}

TEST(PlaceChannel, IsFoundWithinAPixelOfTheTruth) {
  twin::Scenario scenario = small_scenario();
  scenario.camera.flow = FlowDirection::minus_rows;
  TestExperiment test(scenario);
  const ChannelFrame given = place_channel(test.read()).frame;
  test.leave_out_place();
  const maps::FoundPlace found = place_channel(test.read());
  EXPECT_EQ(found.frame.flow, FlowDirection::minus_rows);
  const auto truth = given.camera_from_channel(5e-3, 0.0);
  const auto there = found.frame.camera_from_channel(5e-3, 0.0);
  EXPECT_NEAR(there[0], truth[0], 39e-6);
  EXPECT_NEAR(there[1], truth[1], 64e-6);
  EXPECT_LT(std::abs(found.length_misfit), 0.1e-3);
}

}  // namespace
}  // namespace manoscope::pipeline

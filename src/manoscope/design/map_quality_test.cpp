#include "manoscope/design/map_quality.hpp"

#include <gtest/gtest.h>

#include <cmath>
#include <vector>

#include "manoscope/maps/reduce.hpp"
#include "manoscope/twin/interferometer.hpp"

namespace manoscope::design {
namespace {

twin::Scenario quiet_mount() {
  twin::Scenario scenario = twin::small_s1();
  scenario.camera.n_along = 256;
  scenario.camera.n_across = 64;
  scenario.camera.blobs = 0.0;
  scenario.camera.shift = Length{};
  return scenario;
}

TEST(RehearseMaps, TellsTheScatterOfRepeatedMaps) {
  const twin::Scenario scenario = quiet_mount();
  const WallSurvey survey = survey_wall(scenario, 20.0 * kPa, 0.1 * Pa);
  const MapQuality quality = rehearse_maps(scenario, survey, {300.0, 17500.0});
  // The same wall seen 25 times: about mid-channel each station scatters by its noise.
  const auto wall = survey.loaded(10.0 * kPa, 10.0 * kPa);
  const ChannelFrame frame = twin::channel_frame(scenario.channel, scenario.camera);
  maps::MapKnowledge known;
  known.height_noise = scenario.camera.noise;
  constexpr int kMaps = 25;
  constexpr Index kFirst = 80, kCount = 60;
  Array1 sum = Array1::Zero(kCount), squares = sum;
  for (int i = 0; i < kMaps; ++i) {
    const auto map = twin::record_map(scenario.channel, wall.shape, scenario.camera, 77,
                                      static_cast<std::uint64_t>(i));
    const Array1 zeta =
        maps::reduce_map(map, frame, known, "map").profile.zeta.segment(kFirst, kCount);
    sum += zeta;
    squares += zeta.square();
  }
  const Array1 variance = (squares - sum.square() / kMaps) / (kMaps - 1);
  // 24 degrees of freedom at 60 stations, and a common error of the plane: 2 % and a little.
  EXPECT_NEAR(std::sqrt(variance.mean()) / std::hypot(quality.station_noise, quality.leveling), 1.0,
              0.08);
  EXPECT_GT(quality.n_stations, 235);
  EXPECT_NEAR(quality.spacing, 16.3e-3 / 256, 1e-9);
  EXPECT_NEAR(quality.missing, 0.01, 0.003);
}

TEST(RehearseMaps, KnowsWhereAFlowMapIsNotRegistered) {
  const twin::Scenario scenario = quiet_mount();
  const WallSurvey survey = survey_wall(scenario, 20.0 * kPa, 0.1 * Pa);
  const MapQuality quality = rehearse_maps(scenario, survey, {300.0, 17500.0});
  // A wall that answers to the pressure at x alone rises at its ends otherwise than when uniform:
  // anywhere within half a pixel.
  EXPECT_LE(quality.flow_shift, 16.3e-3 / 256 / std::sqrt(12.0) * 1.0001);
  EXPECT_GT(quality.flow_shift, 0.0);
}

}  // namespace
}  // namespace manoscope::design

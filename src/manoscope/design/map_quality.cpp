#include "manoscope/design/map_quality.hpp"

#include <cmath>
#include <vector>

#include "manoscope/core/error.hpp"
#include "manoscope/maps/reduce.hpp"
#include "manoscope/twin/interferometer.hpp"

namespace manoscope::design {
namespace {

constexpr std::uint64_t kSeed = 1;

/// Maps of one camera, reduced one by one.
class Rehearsal {
 public:
  explicit Rehearsal(const twin::Scenario& scenario)
      : scenario_(scenario), frame_(twin::channel_frame(scenario.channel, scenario.camera)) {
    // What the experiment file of such a scenario states.
    if (scenario.camera.noise > Length{}) known_.height_noise = scenario.camera.noise;
    known_.wavelength = scenario.camera.wavelength;
  }

  maps::ReducedMap reduced(const twin::WallAtRest& wall, const std::string& name) {
    const HeightMap map =
        twin::record_map(scenario_.channel, wall.shape, scenario_.camera, kSeed, index_++);
    return maps::reduce_map(map, frame_, known_, name);
  }

 private:
  const twin::Scenario& scenario_;
  ChannelFrame frame_;
  maps::MapKnowledge known_;
  std::uint64_t index_ = 0;
};

/// Root of the sum of squares of the effects of one source at a station.
double effect_at(const Profile& profile, const std::string& source, Index ix) {
  double squares = 0.0;
  for (const ErrorMode& mode : profile.uncertainty.modes) {
    if (mode.source == source) squares += mode.effect[ix] * mode.effect[ix];
  }
  return std::sqrt(squares);
}

}  // namespace

MapQuality rehearse_maps(const twin::Scenario& scenario, const WallSurvey& survey,
                         const PressureSpan& range) {
  const double length = scenario.channel.length.si();
  const Pressure low = Pressure::from_si(range.low), high = Pressure::from_si(range.high);
  Rehearsal rehearsal(scenario);
  std::vector<maps::ReducedMap> hydrostatic, flow;
  for (const double share : {0.25, 0.6, 1.0}) {
    const twin::WallAtRest wall = survey.loaded(share * high, share * high);
    hydrostatic.push_back(rehearsal.reduced(wall, "hydrostatic map"));
  }
  flow.push_back(rehearsal.reduced(survey.loaded(high, low), "flow map"));
  maps::register_maps(hydrostatic, flow, scenario.channel.length, scenario.channel.width, {});

  const Profile& profile = hydrostatic.back().profile;
  MapQuality quality;
  quality.n_stations = profile.x.size();
  quality.spacing = (profile.x[quality.n_stations - 1] - profile.x[0]) /
                    static_cast<double>(quality.n_stations - 1);
  double squares = 0.0, count = 0.0;
  for (Index ix = 0; ix < quality.n_stations; ++ix) {
    const bool inside = std::abs(profile.x[ix] - 0.5 * length) < 0.25 * length;
    if (!inside || profile.flags[ix] != 0) continue;
    squares += profile.uncertainty.independent[ix] * profile.uncertainty.independent[ix];
    count += 1.0;
  }
  if (count == 0.0) {
    throw InputError("camera", "no station about mid-channel counts: too many pixels are lost",
                     "Give more pixels across the channel, or fewer dropouts and blobs");
  }
  quality.station_noise = std::sqrt(squares / count);
  quality.leveling = effect_at(profile, "leveling", quality.n_stations / 2);
  quality.flow_shift = flow.front().condition.shift.uncertainty.si();
  quality.missing = hydrostatic.back().condition.missing;
  return quality;
}

}  // namespace manoscope::design

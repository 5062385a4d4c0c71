#include "manoscope/twin/solved_scenario.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <string>
#include <utility>

#include "manoscope/core/error.hpp"
#include "manoscope/core/parallel.hpp"
#include "manoscope/twin/experiment_files.hpp"

namespace manoscope::twin {
namespace {

/// What snapped on the way from one state of a wall to a later one.
SnapTruth snaps_between(const WallAtRest& before, const WallAtRest& now) {
  SnapTruth found;
  for (std::size_t i = before.snaps.size(); i < now.snaps.size(); ++i) {
    const WallSnap& snap = now.snaps[i];
    ++found.n;
    if (std::abs(snap.jump) > std::abs(found.jump)) {
      found.jump = snap.jump;
      found.at = snap.at;
    }
  }
  return found;
}

/// Refuses a wall whose crest is found beyond what its law holds for.
void check_rise(const Scenario& scenario, const WallShape& shape) {
  const double half_width = 0.5 * std::min(scenario.wall.width, scenario.wall.length).si();
  for (const double x : pixel_stations(scenario.channel, scenario.camera)) {
    const double crest = std::abs(shape(x, 0.0));
    if (!(crest > wall::kLargestRise * half_width)) continue;
    throw InputError(
        "wall",
        fmt::format("the crest at x = {:.4g} mm is {:.4g} um, {:.2g} of the half-width: "
                    "the theory of the wall (moderate rotations) holds up to {:g}",
                    x * 1e3, crest * 1e6, crest / half_width, wall::kLargestRise),
        "Lower levels and flow rates, or make the wall thicker, stiffer or narrower");
  }
}

/// What solve() gives; its faults name the scenario and where in it they came up.
template <class Solve>
CoupledFlow named(const Scenario& scenario, const std::string& where, Solve solve) {
  try {
    CoupledFlow flow = solve();
    check_rise(scenario, flow.wall.shape);
    return flow;
  } catch (const InputError& error) {
    throw InputError(fmt::format("scenario \"{}\", {}", scenario.name, where), error.found(),
                     error.mend());
  }
}

CoupledFlow still(const Scenario& scenario, const WallModel& wall, const WallAtRest& from,
                  Pressure pressure) {
  return named(scenario, fmt::format("the level of {:g} Pa", pressure.si()), [&] {
    return fill_channel(scenario.channel, wall, from, pressure, scenario.solver);
  });
}

CoupledFlow flowing(const Scenario& scenario, const WallModel& wall, const CoupledFlow& from,
                    FlowRate flow_rate, const Monitor& monitor) {
  return named(scenario, run_label(flow_rate), [&] {
    return solve_coupled(scenario.channel, scenario.fluid, wall, from, flow_rate,
                         scenario.outlet.pressure(flow_rate), scenario.solver, monitor);
  });
}

}  // namespace

SolvedScenario solve_scenario(const Scenario& scenario, int n_threads, const Monitor& monitor,
                              const std::function<void()>& done) {
  scenario.validate();
  SolvedScenario solved;
  solved.wall = scenario.wall_model(monitor);
  const WallAtRest rest = solved.wall.rest();
  const auto fill = [&] {
    CoupledFlow now = still(scenario, solved.wall, rest, Pressure{});
    for (const Pressure level : scenario.levels) {
      monitor.checkpoint();
      CoupledFlow next = still(scenario, solved.wall, now.wall, level);
      solved.levels.push_back({next.wall, snaps_between(now.wall, next.wall)});
      now = std::move(next);
      if (done) done();
    }
  };
  const auto flow = [&] {
    CoupledFlow now = still(scenario, solved.wall, rest, Pressure{});
    for (const FlowRate flow_rate : scenario.flow_rates) {
      monitor.checkpoint();
      CoupledFlow next = flowing(scenario, solved.wall, now, flow_rate, monitor);
      solved.runs.push_back({next, snaps_between(now.wall, next.wall)});
      now = std::move(next);
      if (done) done();
    }
  };
  parallel_for(2, n_threads, [&](Index chain) { chain == 0 ? fill() : flow(); });
  return solved;
}

CoupledFlow solve_nearby(const Scenario& scenario, const SolvedScenario& solved,
                         const CoupledFlow& run, FlowRate flow_rate, const Monitor& monitor) {
  return flowing(scenario, solved.wall, run, flow_rate, monitor);
}

}  // namespace manoscope::twin

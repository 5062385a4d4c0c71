#include "manoscope/wall/continuation.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <memory>

#include "manoscope/core/error.hpp"

namespace manoscope::wall {
namespace {

WallLoad uniform(double pressure) { return WallLoad::uniform(Pressure::from_si(pressure)); }

/// A point of a branch and the direction in which the branch leaves it.
struct Point {
  WallState state;
  Eigen::VectorXd rate;   ///< d(unknowns)/dp, 1/Pa
  double softness = 0.0;  ///< d(volume)/dp, m^3/Pa
};

Point point_at(const FopplVonKarman& wall, const WallState& state) {
  Point made{state, wall.rate(state, uniform(1.0)), 0.0};
  made.softness = wall.predicted(state, 1.0, made.rate).volume() - state.volume();
  return made;
}

/// The point one step along the branch; null where the step leaves it.
std::unique_ptr<Point> step_along(const FopplVonKarman& wall, const Point& from, double pressure,
                                  double step) {
  const WallState predicted = wall.predicted(from.state, step, from.rate);
  const auto next = wall.nearby_equilibrium(uniform(pressure + step), predicted);
  if (next == nullptr || next->n_unstable() > 0) return nullptr;
  // On a branch the volume obeys the trapezoid rule, with an error of the third power of the step.
  auto point = std::make_unique<Point>(point_at(wall, *next));
  const double found = next->volume() - from.state.volume();
  const double foreseen = 0.5 * step * (from.softness + point->softness);
  if (std::abs(found - foreseen) > 0.1 * std::abs(foreseen)) return nullptr;
  // The same step backwards must come home: from another branch it does not.
  const auto home =
      wall.nearby_equilibrium(uniform(pressure), wall.predicted(point->state, -step, point->rate));
  if (home == nullptr) return nullptr;
  const double missed = std::abs(home->volume() - from.state.volume());
  if (missed > 1e-3 * std::abs(found)) return nullptr;
  return point;
}

}  // namespace

LoadPath follow_pressure(const FopplVonKarman& wall, const WallState& start,
                         const Array1& pressures, const FollowOptions& options) {
  const auto refuse = [](const std::string& found, const char* mend) {
    throw InputError("pressure path", found, mend);
  };
  if (pressures.size() == 0) refuse("there are no pressures", "Give at least one");
  for (Index i = 0; i < pressures.size(); ++i) {
    if (!std::isfinite(pressures(i))) {
      refuse(fmt::format("pressure {} is {:g} Pa", i, pressures(i)), "Give finite pressures");
    }
  }
  if (!(options.resolution > 0.0 && options.resolution <= 0.5)) {
    refuse(fmt::format("resolution is {:g}", options.resolution), "Give a value in (0, 0.5]");
  }
  double widest = 0.0;
  for (Index i = 1; i < pressures.size(); ++i) {
    widest = std::max(widest, std::abs(pressures(i) - pressures(i - 1)));
  }
  const double finest = options.resolution * widest;

  LoadPath path;
  path.pressure = pressures;
  Point now = point_at(wall, wall.equilibrium(uniform(pressures(0)), start));
  path.states.push_back(now.state);
  for (Index i = 1; i < pressures.size(); ++i) {
    double at = pressures(i - 1), step = pressures(i) - at;
    while (at != pressures(i)) {
      std::unique_ptr<Point> next;
      while (true) {
        next = step_along(wall, now, at, step);
        if (next != nullptr || std::abs(step) <= finest) break;
        step *= 0.5;
      }
      const bool last = std::abs(step) >= std::abs(pressures(i) - at);
      const double reached = last ? pressures(i) : at + step;
      if (next != nullptr) {
        now = *next;
      } else {
        const WallState after = wall.equilibrium(uniform(reached), now.state);
        path.snaps.push_back(
            {Pressure::from_si(at), Pressure::from_si(std::abs(step)), now.state, after});
        now = point_at(wall, after);
      }
      at = reached;
      step = std::copysign(std::min(2.0 * std::abs(step), std::abs(pressures(i) - at)),
                           pressures(i) - pressures(i - 1));
    }
    path.states.push_back(now.state);
  }
  return path;
}

}  // namespace manoscope::wall

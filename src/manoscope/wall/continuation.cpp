#include "manoscope/wall/continuation.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <memory>

#include "manoscope/core/error.hpp"

namespace manoscope::wall {
namespace {

/// Largest modulus of a load along the flow, Pa.
double largest(const WallLoad& load) { return load.pressure().abs().maxCoeff(); }

/// Whether two loads differ by no more than what a solution of the wall leaves open: the work of
/// such a change is all residual, and tells of no branch.
bool is_negligible(const FopplVonKarman& wall, const WallLoad& from, const WallLoad& to) {
  if (from.field() || to.field()) return false;
  const double share = 1e3 * wall.options().tolerance;
  return largest(to.plus(-1.0, from)) <= share * std::max(largest(from), largest(to));
}

/// A point of a branch and the direction in which the branch leaves it.
struct Point {
  WallState state;
  Eigen::VectorXd rate;   ///< d(unknowns)/d(share)
  double softness = 0.0;  ///< d(work of the change)/d(share), J
};

/// The way from one load to another.
class Way {
 public:
  Way(const FopplVonKarman& wall, const WallLoad& from, const WallLoad& to)
      : wall_(wall),
        from_(from),
        change_(to.plus(-1.0, from)),
        negligible_(is_negligible(wall, from, to)) {}

  WallLoad load(double share) const { return from_.plus(share, change_); }

  Point point_at(const WallState& state) const {
    Point made{state, wall_.rate(state, change_), 0.0};
    made.softness = work(wall_.predicted(state, 1.0, made.rate)) - work(state);
    return made;
  }

  /// The point one step along the branch; null where the step leaves it.
  std::unique_ptr<Point> step_along(const Point& from, double share, double step) const {
    const WallState predicted = wall_.predicted(from.state, step, from.rate);
    const auto next = wall_.nearby_equilibrium(load(share + step), predicted);
    if (next == nullptr || next->n_unstable() > 0) return nullptr;
    // On a branch the work obeys the trapezoid rule, with an error of the third power of the step.
    auto point = std::make_unique<Point>(point_at(*next));
    if (negligible_) return point;
    const double found = work(*next) - work(from.state);
    const double foreseen = 0.5 * step * (from.softness + point->softness);
    if (std::abs(found - foreseen) > 0.1 * std::abs(foreseen)) return nullptr;
    // The same step backwards must come home: from another branch it does not.
    const auto home =
        wall_.nearby_equilibrium(load(share), wall_.predicted(point->state, -step, point->rate));
    if (home == nullptr) return nullptr;
    const double missed = std::abs(work(*home) - work(from.state));
    if (missed > 1e-3 * std::abs(found)) return nullptr;
    return point;
  }

 private:
  double work(const WallState& state) const { return wall_.work(state, change_); }

  const FopplVonKarman& wall_;
  WallLoad from_, change_;
  bool negligible_;
};

FollowedLoad follow(const FopplVonKarman& wall, const WallState& start, const WallLoad& from,
                    const WallLoad& to, double finest) {
  FollowedLoad made{start, {}};
  const Way way(wall, from, to);
  Point now = way.point_at(start);
  double share = 0.0, step = 1.0;
  while (share < 1.0) {
    std::unique_ptr<Point> next;
    while (true) {
      next = way.step_along(now, share, step);
      if (next != nullptr || step <= finest) break;
      step *= 0.5;
    }
    const double reached = step >= 1.0 - share ? 1.0 : share + step;
    if (next != nullptr) {
      now = *next;
    } else {
      const WallState after = wall.equilibrium(way.load(reached), now.state);
      // Just before a fold the branch is too steep for the finest step: that step and the jump
      // which follows at once are one end.
      if (!made.ends.empty() && share <= made.ends.back().share + made.ends.back().uncertainty) {
        BranchEnd& end = made.ends.back();
        end.uncertainty = share + step - end.share;
        end.after = after;
      } else {
        made.ends.push_back({share, step, now.state, after});
      }
      now = way.point_at(after);
    }
    share = reached;
    step = std::min(2.0 * step, 1.0 - share);
  }
  made.state = now.state;
  return made;
}

}  // namespace

void FollowOptions::validate() const {
  if (!(resolution > 0.0 && resolution <= 0.5)) {
    throw InputError("load path", fmt::format("resolution is {:g}", resolution),
                     "Give a value in (0, 0.5]");
  }
}

FollowedLoad follow_load(const FopplVonKarman& wall, const WallState& start, const WallLoad& from,
                         const WallLoad& to, const FollowOptions& options) {
  options.validate();
  return follow(wall, start, from, to, options.resolution);
}

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
  options.validate();
  double widest = 0.0;
  for (Index i = 1; i < pressures.size(); ++i) {
    widest = std::max(widest, std::abs(pressures(i) - pressures(i - 1)));
  }
  const auto uniform = [&](Index i) { return WallLoad::uniform(Pressure::from_si(pressures(i))); };

  LoadPath path;
  path.pressure = pressures;
  path.states.push_back(wall.equilibrium(uniform(0), start));
  for (Index i = 1; i < pressures.size(); ++i) {
    const double change = pressures(i) - pressures(i - 1);
    if (change == 0.0) {
      path.states.push_back(path.states.back());
      continue;
    }
    const double finest = std::min(0.5, options.resolution * widest / std::abs(change));
    FollowedLoad next = follow(wall, path.states.back(), uniform(i - 1), uniform(i), finest);
    for (BranchEnd& end : next.ends) {
      path.snaps.push_back({Pressure::from_si(pressures(i - 1) + end.share * change),
                            Pressure::from_si(end.uncertainty * std::abs(change)),
                            std::move(end.before), std::move(end.after)});
    }
    path.states.push_back(std::move(next.state));
  }
  return path;
}

}  // namespace manoscope::wall

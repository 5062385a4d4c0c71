#include "manoscope/twin/wall_model.hpp"

#include <algorithm>
#include <cmath>
#include <memory>
#include <utility>

#include "manoscope/wall/continuation.hpp"

namespace manoscope::twin {
namespace {

/// Its modulus where it is largest.
Pressure largest_preload(const wall::Preload& preload) {
  return (1.0 + 0.5 * std::abs(preload.lopsidedness)) * std::max(preload.load, -preload.load);
}

/// p(x) of a load, Pa: linear between the stations, constant beyond.
double pressure_at(const wall::WallLoad& load, double x) {
  const Array1& at = load.x();
  const Array1& p = load.pressure();
  const Index n = at.size();
  if (x <= at(0)) return p(0);
  if (x >= at(n - 1)) return p(n - 1);
  const Index next = std::upper_bound(at.begin(), at.end(), x) - at.begin();
  const double share = (x - at(next - 1)) / (at(next) - at(next - 1));
  return (1.0 - share) * p(next - 1) + share * p(next);
}

WallAtRest membrane_at_rest(const wall::TaperedMembrane& wall, const wall::WallLoad& load) {
  const auto deflection = [wall, load](double x) {
    return wall.deflection(x, pressure_at(load, x));
  };
  const auto compliance = [wall, load](const Array1& x) {
    return Array1(
        x.unaryExpr([&](double at) { return wall.compliance(at, pressure_at(load, at)); }));
  };
  WallAtRest made;
  made.shape = parabolic_shape(wall.cross_section().membrane().width, deflection);
  made.deflection = [deflection](const Array1& x) { return Array1(x.unaryExpr(deflection)); };
  made.influence = [compliance](const Array1& x) {
    return Matrix(compliance(x).matrix().asDiagonal());
  };
  made.compliance = compliance;
  return made;
}

/// A wall and what loads it.
struct LoadedPlate {
  wall::WallState state;
  wall::WallLoad load;
};

using Plate = std::shared_ptr<const wall::FopplVonKarman>;

WallAtRest plate_at_rest(const Plate& plate, wall::WallState state, wall::WallLoad load) {
  const auto held =
      std::make_shared<const LoadedPlate>(LoadedPlate{std::move(state), std::move(load)});
  WallAtRest made;
  made.shape = [held](double x, double z) { return held->state.deflection(x, z); };
  made.deflection = [held](const Array1& x) { return held->state.average_deflection(x); };
  made.influence = [plate, held](const Array1& x) { return plate->influence(held->state, x); };
  made.compliance = [plate, held](const Array1& x) {
    const auto rate = plate->rate(held->state, wall::WallLoad::uniform(1.0 * Pa));
    const wall::WallState further = plate->predicted(held->state, 1.0, rate);
    return Array1(further.average_deflection(x) - held->state.average_deflection(x));
  };
  made.memory = held;
  return made;
}

/// Where and how far the wall jumps at the end of a branch.
WallSnap snap_of(const wall::BranchEnd& end, Length length) {
  constexpr Index kStations = 400;
  const Array1 x = Array1::LinSpaced(kStations + 1, 0.0, length.si());
  const Array1 jump = end.after.average_deflection(x) - end.before.average_deflection(x);
  Index at = 0;
  jump.abs().maxCoeff(&at);
  return {x(at), jump(at)};
}

}  // namespace

WallShape parabolic_shape(Length width, std::function<double(double)> deflection) {
  return [half_width = 0.5 * width.si(), zeta = std::move(deflection)](double x, double z) {
    const double across = z / half_width;
    return std::abs(across) < 1.0 ? 1.5 * zeta(x) * (1.0 - across * across) : 0.0;
  };
}

flow::WallShape section_shape(const WallAtRest& wall, Length length, Length width) {
  constexpr Index kAlong = 64, kAcross = 24;
  constexpr int kTerms = 4;
  // The middles of even cells, along the flow and from the centre line to a side.
  const auto middles = [](Index n) {
    return Array1((Array1::LinSpaced(n, 0.0, static_cast<double>(n - 1)) + 0.5) /
                  static_cast<double>(n));
  };
  const Array1 x = length.si() * middles(kAlong), s = middles(kAcross);
  const Array1 mean = wall.deflection(x);
  if (!(mean.square().sum() > 0.0)) return flow::WallShape::parabola();
  Array1 sum = Array1::Zero(kAcross);
  for (Index k = 0; k < kAcross; ++k) {
    const double z = 0.5 * width.si() * s(k);
    for (Index i = 0; i < kAlong; ++i) {
      sum(k) += 0.5 * (wall.shape(x(i), z) + wall.shape(x(i), -z)) * mean(i);
    }
  }
  return flow::WallShape::fit(s, sum / mean.square().sum(), kTerms);
}

WallModel membrane_model(const wall::TaperedMembrane& wall) {
  WallModel model;
  model.length = wall.length();
  const wall::LongMembrane& section = wall.cross_section();
  model.largest_pressure = section.pressure(0.5 * wall::kLargestRise * section.membrane().width) +
                           largest_preload(wall.preload());
  model.rest = [wall] { return membrane_at_rest(wall, wall::WallLoad::uniform(Pressure{})); };
  model.load = [wall](const WallAtRest&, const Array1& x, const Array1& p) {
    return membrane_at_rest(wall, wall::WallLoad::along(x, p));
  };
  return model;
}

WallModel plate_model(const wall::ClampedWall& wall, const wall::FopplVonKarmanOptions& options,
                      const Monitor& monitor) {
  const auto plate = std::make_shared<const wall::FopplVonKarman>(wall, options, monitor);
  WallModel model;
  model.length = wall.length;
  model.largest_pressure = wall.largest_pressure() + largest_preload(wall.preload);
  model.rest = [plate] {
    const auto load = wall::WallLoad::uniform(Pressure{});
    return plate_at_rest(plate, plate->equilibrium(load), load);
  };
  model.load = [plate](const WallAtRest& from, const Array1& x, const Array1& p) {
    const auto& before = *std::any_cast<const std::shared_ptr<const LoadedPlate>&>(from.memory);
    auto load = wall::WallLoad::along(x, p);
    auto reached = wall::follow_load(*plate, before.state, before.load, load);
    WallAtRest made = plate_at_rest(plate, std::move(reached.state), std::move(load));
    made.snaps = from.snaps;
    for (const wall::BranchEnd& end : reached.ends) {
      made.snaps.push_back(snap_of(end, plate->wall().length));
    }
    return made;
  };
  return model;
}

}  // namespace manoscope::twin

#include "manoscope/design/what_matters.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>

#include "manoscope/design/run_forecast.hpp"

namespace manoscope::design {

std::vector<Lever> levers(const Apparatus& apparatus) {
  std::vector<Lever> found;
  if (apparatus.gauge.noise > Pressure{}) found.push_back(Lever::gauge_noise);
  if (apparatus.maps.station_noise > 0.0) found.push_back(Lever::pixel_noise);
  if (apparatus.maps.flow_shift * apparatus.gradient > 0.0) found.push_back(Lever::map_position);
  found.push_back(Lever::flow_maps);
  if (apparatus.gauge.zero_uncertainty > Pressure{}) found.push_back(Lever::gauge_zero);
  if (apparatus.gauge.gain_uncertainty > 0.0) found.push_back(Lever::gauge_gain);
  found.push_back(Lever::wall_stiffness);
  return found;
}

Apparatus improved(const Apparatus& apparatus, Lever lever, double share) {
  Apparatus better = apparatus;
  switch (lever) {
    case Lever::gauge_noise:
      better.gauge.noise = share * apparatus.gauge.noise;
      break;
    case Lever::pixel_noise:
      better.maps.station_noise *= share;
      better.maps.leveling *= share;
      break;
    case Lever::map_position:
      better.maps.flow_shift *= share;
      break;
    case Lever::flow_maps:
      better.flow_maps = static_cast<int>(std::lround(apparatus.flow_maps / share));
      break;
    case Lever::gauge_zero:
      better.gauge.zero_uncertainty = share * apparatus.gauge.zero_uncertainty;
      break;
    case Lever::gauge_gain:
      better.gauge.gain_uncertainty *= share;
      break;
    case Lever::wall_stiffness: {
      const double half = 0.5 * apparatus.curve.highest();
      const double less =
          apparatus.curve.compliance(half) / apparatus.curve.scaled(share).compliance(half);
      better.maps.station_noise *= less;
      better.maps.leveling *= less;
      break;
    }
  }
  return better;
}

std::string lever_name(Lever lever) {
  switch (lever) {
    case Lever::gauge_noise:
      return "gauge noise";
    case Lever::pixel_noise:
      return "pixel noise";
    case Lever::map_position:
      return "place of flow maps";
    case Lever::flow_maps:
      return "maps of a flow rate";
    case Lever::gauge_zero:
      return "gauge zero";
    case Lever::gauge_gain:
      return "gauge gain";
    case Lever::wall_stiffness:
      return "wall stiffness";
  }
  return {};
}

std::string lever_value(const Apparatus& apparatus, Lever lever) {
  switch (lever) {
    case Lever::gauge_noise:
      return fmt::format("{:.3g} Pa", apparatus.gauge.noise.si());
    case Lever::pixel_noise:
      return fmt::format("{:.3g} nm a station", apparatus.maps.station_noise * 1e9);
    case Lever::map_position:
      return fmt::format("{:.2g} um", apparatus.maps.flow_shift * 1e6);
    case Lever::flow_maps:
      return fmt::format("{}", apparatus.flow_maps);
    case Lever::gauge_zero:
      return fmt::format("{:.3g} Pa", apparatus.gauge.zero_uncertainty.si());
    case Lever::gauge_gain:
      return fmt::format("{:.3g}", apparatus.gauge.gain_uncertainty);
    case Lever::wall_stiffness:
      return fmt::format("{:.3g} um at {:.3g} kPa", apparatus.curve.nodes().back().deflection * 1e6,
                         apparatus.curve.highest() * 1e-3);
  }
  return {};
}

std::optional<double> needed_share(const Apparatus& apparatus, Lever lever,
                                   const std::function<bool(const Apparatus&)>& enough) {
  double good = 0.02, bad = 1.0;
  if (!enough(improved(apparatus, lever, good))) return std::nullopt;
  constexpr double kClose = 1.03;
  while (bad > kClose * good) {
    const double middle = std::sqrt(good * bad);
    (enough(improved(apparatus, lever, middle)) ? good : bad) = middle;
  }
  return good;
}

bool still_bears(const PlacementTask& task, const wall::ClampedWall& wall, double share) {
  const double half_width = 0.5 * std::min(wall.width, wall.length).si();
  constexpr double kCrest = 1.5;  // over the width average, of a membrane
  const WallCurve softer = task.apparatus.curve.scaled(share);
  return kCrest * softer.deflection(task.target.range.high) <= wall::kLargestRise * half_width;
}

std::vector<Improvement> find_improvements(const PlacementTask& task,
                                           const std::vector<double>& levels,
                                           const wall::ClampedWall& wall) {
  std::vector<Improvement> found;
  const auto add = [&](const std::string& name, const Apparatus& apparatus,
                       const std::vector<double>& with) {
    found.push_back({name, uncertainty_over(apparatus, with, task.target),
                     range_drop_uncertainty(apparatus, with, task.target.range)});
  };
  constexpr double kHalf = 0.5, kQuarter = 0.25;
  for (const Lever lever : levers(task.apparatus)) {
    if (lever == Lever::wall_stiffness && !still_bears(task, wall, kHalf)) continue;
    const bool maps = lever == Lever::flow_maps;
    add(lever_name(lever) + (maps ? " fourfold" : " halved"),
        improved(task.apparatus, lever, maps ? kQuarter : kHalf), levels);
  }
  std::vector<double> twice;
  for (const double level : levels) twice.insert(twice.end(), 2, level);
  add("every level twice", task.apparatus, twice);
  return found;
}

}  // namespace manoscope::design

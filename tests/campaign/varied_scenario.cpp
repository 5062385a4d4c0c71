#include "tests/campaign/varied_scenario.hpp"

#include <algorithm>
#include <array>
#include <cmath>
#include <vector>

#include "manoscope/core/random.hpp"
#include "manoscope/twin/scenario_file.hpp"

namespace manoscope::campaign {
namespace {

/// Around 1, always above 0.
double factor(RandomStream& random, double spread) { return std::exp(spread * random.normal()); }

/// As many levels as wanted, as dense along the range as those of the scenario.
std::vector<Pressure> other_levels(const std::vector<Pressure>& levels, Index n,
                                   RandomStream& random) {
  const double top = random.uniform(0.95, 1.1);
  const double last = static_cast<double>(levels.size() - 1);
  std::vector<Pressure> others;
  for (Index k = 0; k < n; ++k) {
    const bool end = k == 0 || k == n - 1;
    const double jitter = end ? 0.0 : random.uniform(-0.3, 0.3);
    const double at = (static_cast<double>(k) + jitter) * last / static_cast<double>(n - 1);
    const auto below = static_cast<std::size_t>(std::min(std::floor(at), last - 1.0));
    const double share = at - static_cast<double>(below);
    const double p = (1.0 - share) * levels[below].si() + share * levels[below + 1].si();
    others.push_back(Pressure::from_si(top * p));
  }
  others.front() = Pressure{};
  return others;
}

std::vector<FlowRate> other_flow_rates(const std::vector<FlowRate>& flow_rates, int n,
                                       RandomStream& random) {
  const double low = std::log(flow_rates.front().si()), high = std::log(flow_rates.back().si());
  std::vector<FlowRate> others;
  for (int i = 0; i < n; ++i) {
    const double at = (static_cast<double>(i) + random.uniform(0.1, 0.9)) / static_cast<double>(n);
    others.push_back(FlowRate::from_si(std::exp(low + at * (high - low))));
  }
  return others;
}

void vary_wall(wall::ClampedWall& wall, RandomStream& random) {
  wall.youngs_modulus = factor(random, 0.08) * wall.youngs_modulus;
  wall.thickness = factor(random, 0.03) * wall.thickness;
  const double prestress = factor(random, 0.15);
  if (wall.prestress > Pressure{}) {
    wall.prestress = prestress * wall.prestress;
  } else {
    // A slack elastomer is stretched a little as it is bonded; compression keeps its share.
    const bool compressed = wall.prestress < Pressure{};
    wall.prestress = compressed ? factor(random, 0.03) * wall.prestress
                                : (0.01 * random.uniform()) * wall.youngs_modulus;
  }
  wall.preload.load = factor(random, 0.15) * wall.preload.load;
  wall.preload.lopsidedness *= random.uniform(0.5, 1.5);
  wall.initial_shape.crest = factor(random, 0.1) * wall.initial_shape.crest;
}

void vary_camera(twin::InterferometerOptions& camera, RandomStream& random) {
  constexpr std::array<const char*, 3> kSizes{"512x96", "768x144", "1024x192"};
  camera = twin::resized(camera, kSizes[static_cast<std::size_t>(random.below(3))]);
  camera.noise = random.uniform(10.0, 40.0) * nm;
  camera.blur = random.uniform(4.0, 12.0) * um;
  if (random.uniform() < 0.5) {
    camera.correlated_noise = random.uniform(1.0, 5.0) * nm;
    camera.correlation_length = random.uniform(30.0, 100.0) * um;
  }
}

}  // namespace

twin::Scenario varied_scenario(const std::string& base, std::uint64_t number) {
  twin::Scenario scenario = twin::find_scenario(base);
  if (number == 0) return scenario;
  RandomStream random(number, "varied " + base);
  vary_wall(scenario.wall, random);
  scenario.levels = other_levels(scenario.levels, 14 + random.below(17), random);
  scenario.flow_rates = other_flow_rates(scenario.flow_rates, 6, random);
  constexpr std::array<double, 5> kGauges{1.0, 3.0, 10.0, 10.0, 20.0};
  scenario.gauge.noise = kGauges[static_cast<std::size_t>(random.below(5))] * Pa;
  vary_camera(scenario.camera, random);
  return scenario;
}

}  // namespace manoscope::campaign

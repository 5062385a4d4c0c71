#include "manoscope/maps/combine_shifts.hpp"

#include <cmath>
#include <cstddef>

#include "manoscope/core/error.hpp"

namespace manoscope::maps {
namespace {

/// Texture minus edge of one map.
struct Difference {
  std::size_t map;
  double value, variance;
};

OneShift mean_of(const std::vector<Difference>& differences) {
  double weight = 0.0, sum = 0.0;
  for (const Difference& one : differences) {
    weight += 1.0 / one.variance;
    sum += one.value / one.variance;
  }
  return {sum / weight, std::sqrt(1.0 / weight)};
}

}  // namespace

CombinedShifts combine_shifts(const std::vector<std::optional<OneShift>>& edges,
                              const std::vector<std::optional<OneShift>>& texture) {
  MANO_ASSERT(edges.size() == texture.size());
  constexpr double kSigmas = 4.0, kMostApart = 0.25;
  constexpr std::size_t kFewest = 3;
  CombinedShifts combined{edges, true};
  std::vector<Difference> differences;
  for (std::size_t i = 0; i < edges.size(); ++i) {
    if (!edges[i] || !texture[i]) continue;
    const double e = edges[i]->uncertainty, t = texture[i]->uncertainty;
    differences.push_back({i, texture[i]->value - edges[i]->value, e * e + t * t});
  }
  const std::size_t compared = differences.size();
  if (compared < kFewest) return combined;
  std::vector<bool> apart(edges.size(), false);
  OneShift common = mean_of(differences);
  while (true) {
    std::size_t worst = 0;
    double pull = 0.0;
    for (std::size_t k = 0; k < differences.size(); ++k) {
      const Difference& one = differences[k];
      const double its = std::abs(one.value - common.value) / std::sqrt(one.variance);
      if (its > pull) {
        pull = its;
        worst = k;
      }
    }
    if (pull <= kSigmas) break;
    apart[differences[worst].map] = true;
    differences.erase(differences.begin() + static_cast<std::ptrdiff_t>(worst));
    const auto left_out = static_cast<double>(compared - differences.size());
    if (differences.size() < kFewest || left_out > kMostApart * static_cast<double>(compared)) {
      combined.agree = false;
      return combined;
    }
    common = mean_of(differences);
  }
  const double common_variance = common.uncertainty * common.uncertainty;
  for (std::size_t i = 0; i < edges.size(); ++i) {
    if (!texture[i] || apart[i]) continue;
    const double t = std::pow(texture[i]->uncertainty, 2), moved = texture[i]->value - common.value;
    if (!edges[i]) {
      combined.shifts[i] = OneShift{moved, std::sqrt(t + common_variance)};
      continue;
    }
    const double e = std::pow(edges[i]->uncertainty, 2), share = e / (e + t);  // of the texture
    combined.shifts[i] = OneShift{(1.0 - share) * edges[i]->value + share * moved,
                                  std::sqrt(share * t + share * share * common_variance)};
  }
  return combined;
}

}  // namespace manoscope::maps

#include "manoscope/maps/centre_line.hpp"

#include <algorithm>
#include <array>
#include <cmath>
#include <vector>

namespace manoscope::maps {
namespace {

constexpr std::array<double, 4> kFractions{0.15, 0.3, 0.45, 0.6};
constexpr int kStretches = 12;

/// Mean over columns [first, last] of every row, NaN where fewer than half are good.
Array1 mean_across(const DeflectionMap& map, Index first, Index last) {
  Array1 mean(map.grid().nz);
  for (Index iz = 0; iz < map.grid().nz; ++iz) {
    double sum = 0.0;
    Index n = 0;
    for (Index ix = first; ix <= last; ++ix) {
      if (map.flags()(iz, ix) != 0) continue;
      sum += map.zeta()(iz, ix);
      ++n;
    }
    mean[iz] = 2 * n > last - first ? sum / static_cast<double>(n) : std::nan("");
  }
  return mean;
}

/// z at which the profile first passes `level` on the way from row `from` by steps of `by`.
std::optional<double> passes(const ChannelGrid& grid, const Array1& profile, double level,
                             Index from, Index by) {
  for (Index iz = from; iz + by >= 0 && iz + by < grid.nz; iz += by) {
    const double here = profile[iz], next = profile[iz + by];
    if (std::isnan(here) || std::isnan(next)) continue;
    if (here <= level && next > level) {
      return grid.z(iz) +
             (level - here) / (next - here) * static_cast<double>(by) * grid.pitch_z.si();
    }
  }
  return std::nullopt;
}

/// Middle between the two sides in a stretch of columns.
std::optional<double> middle_of(const DeflectionMap& map, Index first, Index last, double width) {
  const ChannelGrid& grid = map.grid();
  Array1 profile = mean_across(map, first, last);
  double top = 0.0;
  for (Index iz = 0; iz < grid.nz; ++iz) {
    if (std::abs(grid.z(iz)) > 0.3 * width || std::isnan(profile[iz])) continue;
    if (std::abs(profile[iz]) > std::abs(top)) top = profile[iz];
  }
  const double noise = map.noise().si() / std::sqrt(static_cast<double>(last - first + 1));
  constexpr double kLeast = 10.0;
  if (!(std::abs(top) > kLeast * noise) || top == 0.0) return std::nullopt;
  profile /= top;
  std::array<double, kFractions.size()> middle{};
  double sf = 0.0, sm = 0.0, sff = 0.0, sfm = 0.0;
  for (std::size_t k = 0; k < kFractions.size(); ++k) {
    const double f = kFractions[k];
    const auto low = passes(grid, profile, f, 0, 1);
    const auto high = passes(grid, profile, f, grid.nz - 1, -1);
    if (!low || !high) return std::nullopt;
    middle[k] = 0.5 * (*low + *high);
    sf += f;
    sm += middle[k];
    sff += f * f;
    sfm += f * middle[k];
  }
  const auto n = static_cast<double>(kFractions.size());
  const double slope = (n * sfm - sf * sm) / (n * sff - sf * sf);
  return (sm - slope * sf) / n;
}

}  // namespace

std::optional<CentreLine> find_centre_line(const DeflectionMap& map, Length length, Length width) {
  constexpr std::size_t kFewest = 4;
  const ChannelGrid& grid = map.grid();
  std::vector<std::array<double, 2>> middles;
  const double start = std::min(0.5 * width.si(), 0.2 * length.si());
  const double stretch = (length.si() - 2.0 * start) / kStretches;
  for (int k = 0; k < kStretches; ++k) {
    const double low = start + stretch * k;
    const auto column = [&](double x) {
      return std::clamp<Index>(static_cast<Index>(std::ceil((x - grid.x(0)) / grid.pitch_x.si())),
                               0, grid.nx);
    };
    const Index first = column(low), last = column(low + stretch) - 1;
    if (last < first) continue;
    if (const auto z = middle_of(map, first, last, width.si())) {
      middles.push_back({0.5 * (grid.x(first) + grid.x(last)) - 0.5 * length.si(), *z});
    }
  }
  if (middles.size() < kFewest) return std::nullopt;
  double sx = 0.0, sz = 0.0, sxx = 0.0, sxz = 0.0;
  for (const auto& [x, z] : middles) {
    sx += x;
    sz += z;
    sxx += x * x;
    sxz += x * z;
  }
  const auto n = static_cast<double>(middles.size());
  const double spread = sxx - sx * sx / n;
  CentreLine line;
  line.slope = (sxz - sx * sz / n) / spread;
  const double mean = sz / n;
  double rest = 0.0;
  for (const auto& [x, z] : middles) {
    rest += std::pow(z - mean - line.slope * (x - sx / n), 2);
  }
  const double variance = rest / (n - 2.0);
  line.offset = Length::from_si(mean - line.slope * sx / n);
  line.slope_uncertainty = std::sqrt(variance / spread);
  line.offset_uncertainty =
      Length::from_si(std::sqrt(variance * (1.0 / n + sx * sx / (n * n * spread))));
  return line;
}

}  // namespace manoscope::maps

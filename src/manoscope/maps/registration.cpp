#include "manoscope/maps/registration.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <array>
#include <cmath>

#include "manoscope/core/error.hpp"
#include "manoscope/core/flags.hpp"

namespace manoscope::maps {
namespace {

constexpr std::array<double, 6> kFractions{0.1, 0.15, 0.2, 0.3, 0.4, 0.5};
constexpr int kLeastFractions = 4, kPasses = 4;
constexpr double kLineStart = 0.7, kLineEnd = 1.3;  // widths from the end
/// A wall that moves less than this share of the largest movement shows no end.
constexpr double kLeastMovement = 0.1;
constexpr double kModelShare = 8.0;  // of the rest of the straight line in f
constexpr double kFloor = 0.1e-6;    // m

using Fractions = Eigen::Array<double, static_cast<int>(kFractions.size()), 1>;

/// One end of a wall: where it passes the fractions of its own height.
struct End {
  double height = 0.0;  ///< A, m
  Fractions distance;   ///< e(f), m from the frame's end
  Fractions variance;   ///< of e(f) by the profile's noise, m^2
  int first = 0;        ///< fractions before this one lie beyond the profile
};

/// A profile seen from one end of the channel: distances ascending, good stations alone.
struct Seen {
  std::vector<double> distance, zeta, sigma;
};

/// @param shift  taken off the stations, m.
Seen from_inlet(const Profile& profile, double shift) {
  Seen seen;
  for (Index i = 0; i < profile.x.size(); ++i) {
    if (profile.flags[i] != 0) continue;
    seen.distance.push_back(profile.x[i] - shift);
    seen.zeta.push_back(profile.zeta[i]);
    seen.sigma.push_back(profile.uncertainty.independent[i]);
  }
  return seen;
}

Seen from_outlet(const Profile& profile, double shift, double length) {
  Seen seen = from_inlet(profile, shift);
  std::reverse(seen.distance.begin(), seen.distance.end());
  std::reverse(seen.zeta.begin(), seen.zeta.end());
  std::reverse(seen.sigma.begin(), seen.sigma.end());
  for (double& distance : seen.distance) distance = length - distance;
  return seen;
}

/// Where the cubic through four values meets a level; it does so once between low and high.
double crossing(const double* at, const double* value, double level, double low, double high) {
  const auto cubic = [&](double x) {
    double sum = 0.0;
    for (int i = 0; i < 4; ++i) {
      double weight = 1.0;
      for (int j = 0; j < 4; ++j) {
        if (j != i) weight *= (x - at[j]) / (at[i] - at[j]);
      }
      sum += weight * value[i];
    }
    return sum;
  };
  for (int n = 0; n < 40; ++n) {
    const double middle = 0.5 * (low + high);
    (cubic(middle) < level ? low : high) = middle;
  }
  return 0.5 * (low + high);
}

/// None where the line cannot be drawn or the wall does not rise through kLeastFractions.
std::optional<End> find_end(const Seen& seen, double width) {
  double n = 0.0, sx = 0.0, sy = 0.0, sxx = 0.0, sxy = 0.0;
  for (std::size_t i = 0; i < seen.distance.size(); ++i) {
    const double x = seen.distance[i] / width;
    if (x < kLineStart || x > kLineEnd) continue;
    n += 1.0;
    sx += x;
    sy += seen.zeta[i];
    sxx += x * x;
    sxy += x * seen.zeta[i];
  }
  const double determinant = n * sxx - sx * sx;
  if (n < 5.0 || !(determinant > 0.0)) return std::nullopt;
  const double slope = (n * sxy - sx * sy) / determinant;
  End end;
  end.distance.setZero();
  end.variance.setZero();
  end.height = (sy - slope * sx) / n;
  if (end.height == 0.0) return std::nullopt;
  std::vector<double> y;
  for (std::size_t i = 0; i < seen.distance.size() && seen.distance[i] < kLineStart * width; ++i) {
    y.push_back((seen.zeta[i] - slope * seen.distance[i] / width) / end.height);
  }
  const int n_fractions = static_cast<int>(kFractions.size());
  std::size_t i = 2;
  for (int k = 0; k < n_fractions; ++k) {
    const double fraction = kFractions[static_cast<std::size_t>(k)];
    // From station to station: the first step across the fraction from below, two stations off the
    // profile's end.
    while (i + 1 < y.size() && !(y[i - 1] < fraction && y[i] >= fraction)) ++i;
    if (i + 1 >= y.size()) {
      end.first = k + 1;
      i = 2;
      continue;
    }
    const double* at = &seen.distance[i - 2];
    end.distance[k] = crossing(at, &y[i - 2], fraction, at[1], at[2]);
    const double sigma = 0.5 * (seen.sigma[i - 1] + seen.sigma[i]) / std::abs(end.height);
    end.variance[k] = std::pow(sigma * (at[2] - at[1]) / (y[i] - y[i - 1]), 2);
  }
  if (end.first > n_fractions - kLeastFractions) return std::nullopt;
  return end;
}

/// Value at f = 0 of the straight line through values at the fractions from `first` on, with its
/// uncertainty.
MapShift at_edge(const Fractions& values, const Fractions& variances, int first) {
  const Eigen::Index count = values.size() - first;
  const Array1 f = Eigen::Map<const Fractions>(kFractions.data()).tail(count);
  const Array1 value = values.tail(count), variance = variances.tail(count);
  const double n = static_cast<double>(count), mean = f.mean();
  const double spread = (f - mean).square().sum();
  const Array1 weight = 1.0 / n - mean * (f - mean) / spread;
  const double slope = ((f - mean) * value).sum() / spread;
  const double edge = (weight * value).sum();
  const double noise = (weight.square() * variance).sum();
  const double rest = (value - edge - slope * f).square().sum() / (n - 2.0);
  const double expected = variance.mean();  // of the rest, from noise alone
  const double model = kModelShare * kModelShare * std::max(0.0, rest - expected);
  return {Length::from_si(edge), Length::from_si(std::sqrt(noise + model + kFloor * kFloor))};
}

/// The wall's inset at one height, from the hydrostatic maps that show both ends of it.
struct Inset {
  double height;
  Fractions distance, variance;
  int first = 0;  ///< fractions before this one are not known
};

/// One fraction's distance at a height, with its variance; none where no map is near.
struct Crossing {
  double distance, variance;
};

/// Between the heights of the maps that know fraction k by straight lines; up to one step beyond
/// the outermost of them its value, with what it changes over that step as doubt.
///
/// @param known  ascending in height.
std::optional<Crossing> crossing_at(const std::vector<const Inset*>& known, int k, double height) {
  if (known.empty()) return std::nullopt;
  const auto above = std::upper_bound(known.begin(), known.end(), height,
                                      [](double h, const Inset* one) { return h < one->height; });
  if (above != known.begin() && above != known.end()) {
    const Inset &low = **(above - 1), &high = **above;
    const double share = (height - low.height) / (high.height - low.height);
    return Crossing{(1.0 - share) * low.distance[k] + share * high.distance[k],
                    (1.0 - share) * low.variance[k] + share * high.variance[k]};
  }
  if (known.size() < 2) return std::nullopt;
  const bool below = above == known.begin();
  const Inset& nearest = below ? *known[0] : **(known.end() - 1);
  const Inset& next = below ? *known[1] : **(known.end() - 2);
  const double steps = std::abs((height - nearest.height) / (next.height - nearest.height));
  if (!(steps <= 1.0)) return std::nullopt;
  const double change = steps * (next.distance[k] - nearest.distance[k]);
  return Crossing{nearest.distance[k], nearest.variance[k] + change * change};
}

/// The inset at a height, each fraction from the maps that know it.
/// @param insets  ascending in height.
Inset inset_at(const std::vector<Inset>& insets, double height) {
  Inset found{height, Fractions::Zero(), Fractions::Zero(), 0};
  for (int k = 0; k < static_cast<int>(kFractions.size()); ++k) {
    std::vector<const Inset*> known;
    for (const Inset& inset : insets) {
      if (inset.first <= k) known.push_back(&inset);
    }
    if (const auto crossing = crossing_at(known, k, height)) {
      found.distance[k] = crossing->distance;
      found.variance[k] = crossing->variance;
    } else {
      found.first = k + 1;
    }
  }
  return found;
}

/// Mean weighted by the inverse square of the uncertainties; none of none.
std::optional<MapShift> weighted_mean(const std::vector<std::optional<MapShift>>& shifts) {
  std::vector<std::pair<double, double>> terms;  // weight, weighted shift
  for (const auto& shift : shifts) {
    if (!shift) continue;
    const double w = 1.0 / std::pow(shift->uncertainty.si(), 2);
    terms.emplace_back(w, w * shift->shift.si());
  }
  std::sort(terms.begin(), terms.end());  // the sum does not depend on the order of the maps
  double weight = 0.0, sum = 0.0;
  for (const auto& [w, weighted] : terms) {
    weight += w;
    sum += weighted;
  }
  if (!(weight > 0.0)) return std::nullopt;
  return MapShift{Length::from_si(sum / weight), Length::from_si(std::sqrt(1.0 / weight))};
}

}  // namespace

Registration register_profiles(const std::vector<const Profile*>& hydrostatic,
                               const std::vector<const Profile*>& flow, Length length,
                               Length width) {
  if (!(length > Length{} && width > Length{})) {
    throw InputError("registration", "length or width of the channel is not positive", "Give both");
  }
  const double l = length.si(), w = width.si();
  Registration found;
  found.hydrostatic.resize(hydrostatic.size());
  found.flow.resize(flow.size());

  // Windows and heights are those of the wall only once it is in place: each pass leaves less than
  // a tenth of the shift that the one before had missed.
  const auto inlet_of = [&](const Profile& profile, double shift) {
    return find_end(from_inlet(profile, shift), w);
  };
  const auto outlet_of = [&](const Profile& profile, double shift) {
    return find_end(from_outlet(profile, shift, l), w);
  };

  double largest = 0.0;
  for (const Profile* profile : hydrostatic) {
    for (const auto& end : {inlet_of(*profile, 0.0), outlet_of(*profile, 0.0)}) {
      if (end) largest = std::max(largest, std::abs(end->height));
    }
  }
  std::vector<Inset> insets;
  for (std::size_t i = 0; i < hydrostatic.size(); ++i) {
    double shift = 0.0;
    for (int pass = 1; pass <= kPasses; ++pass) {
      const auto inlet = inlet_of(*hydrostatic[i], shift);
      const auto outlet = outlet_of(*hydrostatic[i], shift);
      found.hydrostatic[i].reset();
      if (!inlet || !outlet) break;
      const double least = std::min(std::abs(inlet->height), std::abs(outlet->height));
      // Both ends on one side of the plane: a wall that is passing it has no common shape.
      if (least < kLeastMovement * largest || inlet->height * outlet->height < 0.0) break;
      const Fractions variance = 0.25 * (inlet->variance + outlet->variance);
      const int first = std::max(inlet->first, outlet->first);
      MapShift more = at_edge(0.5 * (inlet->distance - outlet->distance), variance, first);
      shift += more.shift.si();
      more.shift = Length::from_si(shift);
      found.hydrostatic[i] = more;
      if (pass == kPasses) {
        insets.push_back({0.5 * (inlet->height + outlet->height),
                          0.5 * (inlet->distance + outlet->distance), variance, first});
      }
    }
  }
  found.offset = weighted_mean(found.hydrostatic);
  if (!found.offset) return found;
  for (auto& shift : found.hydrostatic) {
    if (shift) shift->shift -= found.offset->shift;
  }
  if (insets.empty()) return found;
  std::sort(insets.begin(), insets.end(),
            [](const Inset& a, const Inset& b) { return a.height < b.height; });
  for (std::size_t i = 0; i < flow.size(); ++i) {
    double shift = 0.0;
    for (int pass = 1; pass <= kPasses; ++pass) {
      const auto inlet = inlet_of(*flow[i], shift), outlet = outlet_of(*flow[i], shift);
      const bool at_inlet =
          inlet && (!outlet || std::abs(inlet->height) >= std::abs(outlet->height));
      const auto& end = at_inlet ? inlet : outlet;
      found.flow[i].reset();
      if (!end || std::abs(end->height) < kLeastMovement * largest) break;
      const Inset inset = inset_at(insets, end->height);
      const int first = std::max(end->first, inset.first);
      if (first > static_cast<int>(kFractions.size()) - kLeastFractions) break;
      MapShift more =
          at_edge(end->distance - inset.distance, end->variance + inset.variance, first);
      shift += at_inlet ? more.shift.si() : -more.shift.si();
      more.shift = Length::from_si(shift) - found.offset->shift;
      found.flow[i] = more;
    }
  }
  return found;
}

void move_profile(Profile& profile, const MapShift& shift, const std::string& name,
                  Length assumed) {
  const Index n = profile.x.size();
  const Array1 zeta = profile.zeta;
  const Flags1 flags = profile.flags;
  const double pitch = n > 1 ? (profile.x[n - 1] - profile.x[0]) / static_cast<double>(n - 1) : 1.0;
  const auto good = [&](Index i) { return i >= 0 && i < n && flags[i] == 0; };
  for (Index i = 0; i < n; ++i) {
    const double at = static_cast<double>(i) + shift.shift.si() / pitch;
    const auto low = static_cast<Index>(std::floor(at));
    const double u = at - static_cast<double>(low);
    // Exactly on a station its neighbour does not count.
    if (!good(low) || (u > 0.0 && !good(low + 1))) {
      profile.flags[i] |= StationFlag::no_data;
      profile.zeta[i] = 0.0;
      continue;
    }
    profile.flags[i] = 0;
    if (u == 0.0) {
      profile.zeta[i] = zeta[low];
    } else if (good(low - 1) && good(low + 2)) {
      profile.zeta[i] = -u * (u - 1.0) * (u - 2.0) / 6.0 * zeta[low - 1] +
                        (u + 1.0) * (u - 1.0) * (u - 2.0) / 2.0 * zeta[low] -
                        (u + 1.0) * u * (u - 2.0) / 2.0 * zeta[low + 1] +
                        (u + 1.0) * u * (u - 1.0) / 6.0 * zeta[low + 2];
    } else {
      profile.zeta[i] = (1.0 - u) * zeta[low] + u * zeta[low + 1];
    }
  }
  const std::string variable = fmt::format("shift of {}", name);
  for (ErrorMode& mode : profile.uncertainty.modes) {
    if (mode.variable == variable && assumed > Length{}) {
      mode.effect *= shift.uncertainty / assumed;
    }
  }
}

}  // namespace manoscope::maps

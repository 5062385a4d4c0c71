#include "manoscope/validation/smooth_shape.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>

#include "manoscope/core/error.hpp"
#include "manoscope/validation/end_layers.hpp"
#include "manoscope/validation/error_table.hpp"

namespace manoscope::validation {
namespace {

constexpr Index kFewestStations = 8;

/// Positions from 0 to the length, one height apart and denser at the ends.
Array1 graded_positions(const flow::Channel& channel) {
  constexpr double kDenser = 4.0, kMost = 240.0;
  const double l = channel.length.si(), w = std::min(channel.width.si(), l);
  // Integral of 1 + kDenser (exp(-x/w) + exp(-(l - x)/w)).
  const auto place = [&](double x) {
    return x + kDenser * w * (1.0 - std::exp(-x / w) + std::exp((x - l) / w) - std::exp(-l / w));
  };
  const double whole = place(l);
  const auto n =
      static_cast<Index>(std::clamp(std::ceil(whole / channel.height.si()), 12.0, kMost));
  Array1 positions(n + 1);
  for (Index i = 0; i <= n; ++i) {
    const double wanted = whole * static_cast<double>(i) / static_cast<double>(n);
    double low = 0.0, high = l;
    for (int step = 0; step < 60; ++step) {
      const double middle = 0.5 * (low + high);
      (place(middle) < wanted ? low : high) = middle;
    }
    positions[i] = 0.5 * (low + high);
  }
  positions[0] = 0.0;
  positions[n] = l;
  return positions;
}

/// The line's values with their noise. A clamped end is known far better than any station.
numerics::NoisyValues values_of(const WallLine& line, const Profile& state) {
  constexpr double kFinest = 1e-12;  // m: noise of an ideal camera, which is none
  numerics::NoisyValues data{line.x, line.zeta, Array1(line.x.size())};
  double sum = 0.0, count = 0.0;
  for (Index i = 0; i < line.x.size(); ++i) {
    const Index ix = line.station[static_cast<std::size_t>(i)];
    data.sigma[i] = ix == kClampedEnd ? 0.0 : std::max(state.uncertainty.independent[ix], kFinest);
    if (ix == kClampedEnd) continue;
    sum += data.sigma[i];
    count += 1.0;
  }
  if (count < static_cast<double>(kFewestStations)) {
    throw InputError("measured shape",
                     fmt::format("only {:.0f} stations of the channel hold a deflection", count),
                     fmt::format("{} are the least; check the map of this run", kFewestStations));
  }
  constexpr double kClampedShare = 1e-3;
  for (double& sigma : data.sigma) {
    if (sigma == 0.0) sigma = kClampedShare * sum / count;
  }
  return data;
}

}  // namespace

SmoothShape::SmoothShape(const Profile& state, const flow::Channel& channel)
    : state_(state),
      line_(wall_line(state, channel.length)),
      positions_(graded_positions(channel)),
      // Ripples of two heights stand on two knots in mid-channel, the fewest that tell them.
      spline_(values_of(line_, state), knots_at(positions_), end_bends(positions_, channel.width),
              2.0 * channel.height.si()) {
  const Array1 difference = spline_.value(line_.x) - line_.zeta;
  double taken = 0.0, noise = 0.0, count = 0.0;
  for (Index i = 0; i < line_.x.size(); ++i) {
    const Index ix = line_.station[static_cast<std::size_t>(i)];
    if (ix == kClampedEnd) continue;
    taken += difference[i] * difference[i];
    noise += std::pow(state.uncertainty.independent[ix], 2);
    count += 1.0;
  }
  taken_ = std::sqrt(taken / count);
  noise_ = std::sqrt(noise / count);
}

Length SmoothShape::longest_silence() const {
  const Index n = line_.x.size();
  return Length::from_si((line_.x.tail(n - 1) - line_.x.head(n - 1)).maxCoeff());
}

Profile SmoothShape::at(const Array1& x) const {
  const Matrix weights = spline_.weights(x);
  Profile smooth;
  smooth.x = x;
  smooth.zeta = spline_.value(x);
  smooth.flags = Flags1::Zero(x.size());
  smooth.uncertainty.independent = Array1::Zero(x.size());
  const Index n = line_.x.size();
  for (const ErrorMode& mode : state_.uncertainty.modes) {
    Array1 effect = Array1::Zero(n);  // 0 at the clamped ends
    for (Index i = 0; i < n; ++i) {
      const Index ix = line_.station[static_cast<std::size_t>(i)];
      if (ix != kClampedEnd) effect[i] = mode.effect[ix];
    }
    smooth.uncertainty.modes.push_back(
        {mode.variable, mode.source, (weights * effect.matrix()).array()});
  }
  for (Index i = 0; i < n; ++i) {
    const Index ix = line_.station[static_cast<std::size_t>(i)];
    if (ix == kClampedEnd) continue;
    smooth.uncertainty.modes.push_back(
        {flow_noise(ix), "pixel noise",
         state_.uncertainty.independent[ix] * weights.col(i).array()});
  }
  return smooth;
}

}  // namespace manoscope::validation

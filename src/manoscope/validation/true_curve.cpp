#include "manoscope/validation/true_curve.hpp"

#include <algorithm>
#include <cmath>
#include <utility>

namespace manoscope::validation {
namespace {

/// p at `zeta` between two nodes; nullopt if the cubic that joins them does not rise throughout.
std::optional<double> between(const TrueCurve::Node& low, const TrueCurve::Node& high,
                              double zeta) {
  if (!std::isgreater(low.compliance, 0.0) || !std::isgreater(high.compliance, 0.0)) {
    return std::nullopt;
  }
  const double step = high.deflection - low.deflection, rise = high.pressure - low.pressure;
  // p = p_low + c1 t + c2 t^2 + c3 t^3 with t in [0, 1].
  const double c1 = step / low.compliance, end = step / high.compliance;
  const double c2 = 3.0 * rise - 2.0 * c1 - end, c3 = c1 + end - 2.0 * rise;
  // The slope c1 + 2 c2 t + 3 c3 t^2 is positive at both ends; it may dip below 0 in between.
  if (c3 > 0.0) {
    const double lowest = -c2 / (3.0 * c3);
    if (lowest > 0.0 && lowest < 1.0 && c1 + c2 * lowest < 0.0) return std::nullopt;
  }
  const double t = (zeta - low.deflection) / step;
  return low.pressure + t * (c1 + t * (c2 + t * c3));
}

}  // namespace

TrueCurve::TrueCurve(std::vector<Node> nodes) : nodes_(std::move(nodes)) {
  std::stable_sort(nodes_.begin(), nodes_.end(),
                   [](const Node& a, const Node& b) { return a.pressure < b.pressure; });
  const auto same = [](const Node& a, const Node& b) { return a.pressure == b.pressure; };
  nodes_.erase(std::unique(nodes_.begin(), nodes_.end(), same), nodes_.end());
}

std::optional<double> TrueCurve::pressure(double deflection) const {
  std::optional<std::size_t> found;
  for (std::size_t k = 1; k < nodes_.size(); ++k) {
    const double low = nodes_[k - 1].deflection, high = nodes_[k].deflection;
    if (high <= low) {
      if (deflection >= high && deflection <= low) return std::nullopt;
      continue;
    }
    const bool last = k + 1 == nodes_.size();
    // A node belongs to the stretch above it.
    if (deflection < low || deflection > high || (deflection == high && !last)) continue;
    if (found) return std::nullopt;
    found = k;
  }
  if (!found) return std::nullopt;
  return between(nodes_[*found - 1], nodes_[*found], deflection);
}

}  // namespace manoscope::validation

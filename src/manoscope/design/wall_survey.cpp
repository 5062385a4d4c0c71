#include "manoscope/design/wall_survey.hpp"

#include <algorithm>
#include <cmath>
#include <utility>

#include "manoscope/core/error.hpp"
#include "manoscope/inversion/wall_response.hpp"
#include "manoscope/twin/coupled.hpp"

namespace manoscope::design {
namespace {

using State = WallSurvey::State;

constexpr int kFirstSteps = 8;
constexpr int kMostHalvings = 7, kMostAtSnap = 14;
/// A halved step of a curve of fourth order has a sixteenth of the error.
constexpr double kGain = 16.0;

/// p over the share of the rise from one node to the next: a cubic, rising or not.
struct Cubic {
  double c0, c1, c2, c3;

  Cubic(const WallCurve::Node& low, const WallCurve::Node& high) : c0(low.pressure) {
    const double step = high.deflection - low.deflection, rise = high.pressure - low.pressure;
    const double m0 = step / low.compliance, m1 = step / high.compliance;
    c1 = m0;
    c2 = 3.0 * rise - 2.0 * m0 - m1;
    c3 = m0 + m1 - 2.0 * rise;
    if (rises()) return;
    c1 = rise;
    c2 = c3 = 0.0;
  }
  double value(double t) const { return c0 + t * (c1 + t * (c2 + t * c3)); }
  double slope(double t) const { return c1 + t * (2.0 * c2 + t * 3.0 * c3); }

 private:
  bool rises() const {
    if (!(slope(0.0) > 0.0) || !(slope(1.0) > 0.0) || !std::isfinite(c2)) return false;
    const double turn = c3 != 0.0 ? -c2 / (3.0 * c3) : -1.0;
    return turn <= 0.0 || turn >= 1.0 || slope(turn) > 0.0;
  }
};

/// The wall under a pressure that changes linearly from inlet to outlet, Pa.
twin::WallAtRest load(const twin::WallModel& model, const twin::WallAtRest& from, double inlet,
                      double outlet) {
  Array1 x(2), p(2);
  x << 0.0, model.length.si();
  p << inlet, outlet;
  return model.load(from, x, p);
}

/// Loads a wall step by step.
class Surveyor {
 public:
  Surveyor(const twin::Scenario& scenario, Pressure highest, Pressure tolerance,
           const Monitor& monitor)
      : scenario_(scenario),
        model_(scenario.wall_model(monitor)),
        highest_(highest.si()),
        tolerance_(tolerance.si()),
        monitor_(monitor) {}

  WallSurvey run() {
    const twin::WallAtRest rest = model_.rest();
    // Refuses a wall that touches the floor.
    twin::fill_channel(scenario_.channel, model_, rest, Pressure{}, scenario_.solver);
    State low = at(0.0, rest);
    states_.push_back(low);
    for (int k = 1; k <= kFirstSteps; ++k) {
      // Closer where a wall is softest.
      const double share = static_cast<double>(k) / kFirstSteps;
      State high = at(highest_ * share * share, low.wall);
      refine(low, high, 0);
      low = std::move(high);
      monitor_.report("solving the wall", share);
    }
    auto two_states = snaps_.empty() ? std::nullopt : follow_down();
    return {model_, std::move(states_), std::move(snaps_), two_states};
  }

 private:
  State at(double pressure, const twin::WallAtRest& from) const {
    monitor_.checkpoint();
    State state{pressure, load(model_, from, pressure, pressure), {}};
    const Array1 middle = Array1::Constant(1, 0.5 * model_.length.si());
    state.node = {pressure, state.wall.deflection(middle)[0], state.wall.compliance(middle)[0]};
    return state;
  }

  /// Adds the states above `low` up to `high`.
  void refine(const State& low, const State& high, int depth) {
    const bool snaps = high.wall.snaps.size() > low.wall.snaps.size();
    const double width = high.pressure - low.pressure;
    const bool located = width < std::max(0.01 * high.pressure, 10.0 * tolerance_);
    if (snaps && (located || depth >= kMostAtSnap)) {
      snaps_.push_back({{low.pressure, high.pressure}, high.node.deflection - low.node.deflection});
      states_.push_back(high);
      return;
    }
    const double root = 0.5 * (std::sqrt(low.pressure) + std::sqrt(high.pressure));
    const State middle = at(root * root, low.wall);
    const double rise = high.node.deflection - low.node.deflection;
    const double share = (middle.node.deflection - low.node.deflection) / rise;
    const double miss = std::abs(Cubic(low.node, high.node).value(share) - middle.pressure);
    if (!snaps && (miss < kGain * tolerance_ || depth >= kMostHalvings)) {
      states_.push_back(middle);
      states_.push_back(high);
      return;
    }
    refine(low, middle, depth + 1);
    refine(middle, high, depth + 1);
  }

  std::optional<PressureSpan> follow_down() const {
    std::optional<PressureSpan> span;
    twin::WallAtRest wall = states_.back().wall;
    const double size = std::abs(states_.back().node.deflection);
    for (std::size_t k = states_.size(); k-- > 0;) {
      if (states_[k].pressure > snaps_.back().between.high) continue;
      const State down = at(states_[k].pressure, wall);
      wall = down.wall;
      if (std::abs(down.node.deflection - states_[k].node.deflection) < 1e-4 * size) continue;
      if (!span) span = PressureSpan{down.pressure, down.pressure};
      span->low = down.pressure;
    }
    return span;
  }

  const twin::Scenario& scenario_;
  twin::WallModel model_;
  double highest_, tolerance_;
  const Monitor& monitor_;
  std::vector<State> states_;
  std::vector<SurveyedSnap> snaps_;
};

std::vector<WallCurve::Node> nodes_of(const std::vector<State>& states) {
  std::vector<WallCurve::Node> nodes;
  for (const State& state : states) nodes.push_back(state.node);
  return nodes;
}

}  // namespace

WallCurve::WallCurve(std::vector<Node> nodes) : nodes_(std::move(nodes)) {
  MANO_ASSERT(nodes_.size() >= 2);
}

WallCurve::Place WallCurve::find(double pressure) const {
  const auto above = std::upper_bound(nodes_.begin() + 1, nodes_.end() - 1, pressure,
                                      [](double p, const Node& node) { return p < node.pressure; });
  const auto k = static_cast<std::size_t>(above - nodes_.begin()) - 1;
  const Cubic cubic(nodes_[k], nodes_[k + 1]);
  constexpr double kBeyond = 10.0;
  double low = 0.0, high = k + 2 == nodes_.size() ? kBeyond : 1.0;
  double t = (pressure - nodes_[k].pressure) / (nodes_[k + 1].pressure - nodes_[k].pressure);
  for (int n = 0; n < 60; ++n) {
    t = std::clamp(t, low, high);
    const double miss = cubic.value(t) - pressure;
    (miss < 0.0 ? low : high) = t;
    double next = t - miss / cubic.slope(t);
    if (!(next >= low && next <= high)) next = 0.5 * (low + high);
    if (std::abs(next - t) < 1e-15) break;
    t = next;
  }
  return {k, t, cubic.slope(t)};
}

double WallCurve::deflection(double pressure) const {
  const Place at = find(pressure);
  const Node &low = nodes_[at.low], &high = nodes_[at.low + 1];
  return low.deflection + at.share * (high.deflection - low.deflection);
}

double WallCurve::compliance(double pressure) const {
  const Place at = find(pressure);
  return (nodes_[at.low + 1].deflection - nodes_[at.low].deflection) / at.slope;
}

WallCurve WallCurve::scaled(double factor) const {
  std::vector<Node> nodes = nodes_;
  for (Node& node : nodes) {
    node.pressure *= factor;
    node.compliance /= factor;
  }
  return WallCurve(std::move(nodes));
}

WallSurvey::WallSurvey(twin::WallModel model, std::vector<State> states,
                       std::vector<SurveyedSnap> snaps, std::optional<PressureSpan> two_states)
    : model_(std::move(model)),
      states_(std::move(states)),
      curve_(nodes_of(states_)),
      snaps_(std::move(snaps)),
      two_states_(two_states) {}

twin::WallAtRest WallSurvey::loaded(Pressure inlet, Pressure outlet) const {
  const State* from = &states_.front();
  for (const State& state : states_) {
    if (state.pressure <= std::min(inlet, outlet).si()) from = &state;
  }
  return load(model_, from->wall, inlet.si(), outlet.si());
}

double WallSurvey::half_wavelength(Pressure pressure, Length width) const {
  const Array1 nodes = inversion::response_nodes(model_.length, width);
  const Index middle = nodes.size() / 2;
  const Matrix influence = loaded(pressure, pressure).influence(nodes);
  return inversion::half_response_wavelength(nodes, influence.row(middle), middle);
}

WallSurvey survey_wall(const twin::Scenario& scenario, Pressure highest, Pressure tolerance,
                       const Monitor& monitor) {
  MANO_ASSERT(highest > Pressure{} && tolerance > Pressure{});
  twin::Scenario loaded = scenario;
  loaded.levels = {Pressure{}, highest};
  loaded.validate();
  return Surveyor(loaded, highest, tolerance, monitor).run();
}

}  // namespace manoscope::design

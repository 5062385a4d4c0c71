#pragma once

#include <optional>
#include <vector>

#include "manoscope/core/arrays.hpp"
#include "manoscope/core/monitor.hpp"
#include "manoscope/core/units.hpp"
#include "manoscope/twin/scenario.hpp"

namespace manoscope::design {

/// zeta(p) at mid-channel of a model wall whose uniform pressure rises slowly from rest.
///
/// Between nodes p is the cubic in zeta with both pressures and both slopes: exact for a long
/// membrane, of fourth order for other walls; beyond the last node the last cubic goes on. Between
/// nodes that no rising cubic joins (a snap) it is a straight line.
class WallCurve {
 public:
  struct Node {
    double pressure;    ///< Pa
    double deflection;  ///< m, width-averaged
    double compliance;  ///< d zeta / d p, m/Pa
  };
  /// @param nodes  at least two, ascending in pressure.
  explicit WallCurve(std::vector<Node> nodes);

  double lowest() const { return nodes_.front().pressure; }
  double highest() const { return nodes_.back().pressure; }
  double deflection(double pressure) const;
  double compliance(double pressure) const;
  /// The same curve with all pressures times a factor: of a stiffer wall.
  WallCurve scaled(double factor) const;
  const std::vector<Node>& nodes() const { return nodes_; }

 private:
  struct Place {
    std::size_t low;  ///< node below
    double share;     ///< of the rise to the next node
    double slope;     ///< dp / d share
  };
  Place find(double pressure) const;

  std::vector<Node> nodes_;
};

/// A stretch of pressure, Pa.
struct PressureSpan {
  double low = 0.0, high = 0.0;
};

/// A jump of the wall on the way up.
struct SurveyedSnap {
  PressureSpan between;  ///< where it happens
  double jump = 0.0;     ///< m, of the deflection at mid-channel
};

/// A model wall, solved under uniform pressure from rest up to a highest one.
class WallSurvey {
 public:
  struct State {
    double pressure = 0.0;
    twin::WallAtRest wall;
    WallCurve::Node node{};
  };
  WallSurvey(twin::WallModel model, std::vector<State> states, std::vector<SurveyedSnap> snaps,
             std::optional<PressureSpan> two_states);

  const WallCurve& curve() const { return curve_; }
  const std::vector<SurveyedSnap>& snaps() const { return snaps_; }
  /// Pressures under which the wall stands elsewhere when it comes from above: a reading there may
  /// be of either state.
  const std::optional<PressureSpan>& two_states() const { return two_states_; }
  const std::vector<State>& states() const { return states_; }
  /// The wall under a pressure that changes linearly from inlet to outlet, reached from its state
  /// under the lower of the two.
  twin::WallAtRest loaded(Pressure inlet, Pressure outlet) const;
  /// Of a ripple of p(x) of this wavelength, m, the wall at mid-channel under a uniform pressure
  /// shows half; 0 for a wall that answers to the pressure at x alone.
  double half_wavelength(Pressure pressure, Length width) const;

 private:
  twin::WallModel model_;
  std::vector<State> states_;
  WallCurve curve_;
  std::vector<SurveyedSnap> snaps_;
  std::optional<PressureSpan> two_states_;
};

/// Solves the wall of a scenario at as many pressures as its curve needs.
///
/// Steps are halved until the cubic between neighbours is right to the tolerance, and about a snap
/// until it is known to a hundredth of its pressure or to ten times the tolerance. If it snaps on
/// the way up, it is followed down again as well.
///
/// @param highest    above 0 Pa.
/// @param tolerance  of the pressure of a deflection, above 0 Pa.
/// @throws InputError if the wall touches the floor at rest or rises beyond its theory;
/// Interrupted.
WallSurvey survey_wall(const twin::Scenario& scenario, Pressure highest, Pressure tolerance,
                       const Monitor& monitor = {});

}  // namespace manoscope::design

#pragma once

#include <any>
#include <functional>
#include <limits>
#include <vector>

#include "manoscope/core/arrays.hpp"
#include "manoscope/core/monitor.hpp"
#include "manoscope/core/units.hpp"
#include "manoscope/flow/roof.hpp"
#include "manoscope/twin/channel_curve.hpp"
#include "manoscope/wall/foppl_von_karman.hpp"
#include "manoscope/wall/tapered_membrane.hpp"

namespace manoscope::twin {

/// Deflection zeta(x, z) of a wall, m, outward; z from the centre line; 0 outside the channel.
using WallShape = std::function<double(double x, double z)>;

/// A jump of a wall from the end of one branch of states to another.
struct WallSnap {
  double at = 0.0;    ///< where the width-averaged zeta jumps furthest, m
  double jump = 0.0;  ///< by how much, m; outward positive
};

/// A wall at rest under some pressure, and what it answers when asked.
struct WallAtRest {
  WallShape shape;
  /// Width-averaged zeta at stations: (n) m -> (n) m.
  std::function<Array1(const Array1& x)> deflection;
  /// d zeta(x_i)/d p(x_j): (n) m -> (n, n) m/Pa; the pressure linear between the stations and
  /// constant beyond the first and the last.
  std::function<Matrix(const Array1& x)> influence;
  /// d zeta/dp under a pressure that rises everywhere alike: (n) m -> (n) m/Pa; infinite where a
  /// membrane without prestress is flat.
  std::function<Array1(const Array1& x)> compliance;
  /// Every jump on the way here from WallModel::rest, in the order met.
  std::vector<WallSnap> snaps;
  std::any memory;  ///< for the model that made it
};

/// What a virtual experiment asks of a wall: any wall law fits behind it. Calls may come from
/// several threads at once.
struct WallModel {
  Length length;  ///< from x = 0 to x = length
  /// Beyond this pressure, either way, the wall rises further than its law holds (kLargestRise).
  Pressure largest_pressure = Pressure::from_si(std::numeric_limits<double>::infinity());
  /// The wall before any fluid pressure.
  std::function<WallAtRest()> rest;
  /// The wall after its pressure has slowly changed, in proportion, from that of an earlier state
  /// to p(x): (n) m ascending, (n) Pa; linear between the stations, constant beyond, uniform over
  /// z. A wall with several states stays on its branch until that ends, snaps through, and says so
  /// in WallAtRest::snaps.
  std::function<WallAtRest(const WallAtRest& from, const Array1& x, const Array1& p)> load;
};

/// The parabola over the width with a given width average:
///
///   zeta(x, z) = (3/2) zeta(x) (1 - (2 z/w)^2)
///
/// Source: Ozsun, Yakhot & Ekinci 2013, eq. (3), read backwards.
WallShape parabolic_shape(Length width, std::function<double(double)> deflection);

/// The shape across that the sections of a wall have on the whole: the least squares of
///
///   zeta(x, z) = zeta(x) g(2 z/w),  g(s) = int zeta(x, s) zeta(x) dx / int zeta(x)^2 dx
///
/// as an even polynomial that vanishes at the sides. Every section counts by how far it stands out,
/// so that one where a wall passes through flat does not matter. A parabola for a flat wall.
/// Accuracy: in the test section of a long wall; near the ends a clamped plate is pointed instead.
flow::WallShape section_shape(const WallAtRest& wall, Length length, Length width);

/// A tapered membrane with a parabolic section: it answers to the pressure at x alone.
WallModel membrane_model(const wall::TaperedMembrane& wall);

/// A clamped Foeppl-von Karman wall; loads step through wall::follow_load().
/// @param monitor  asked before every factorisation.
WallModel plate_model(const wall::ClampedWall& wall, const wall::FopplVonKarmanOptions& options,
                      const Monitor& monitor = {});

}  // namespace manoscope::twin

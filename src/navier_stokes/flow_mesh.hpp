#pragma once

#include <vector>

#include "manoscope/core/units.hpp"

namespace manoscope::navier_stokes {

/// Ends of the cells along the flow: finer towards both ends of the channel, where its roof bends,
/// and growing away from them in the ducts before and behind.
///
/// Both ends of the channel are ends of cells.
/// @param length    of the channel, from x = 0; > 0.
/// @param lead_in   of the duct before, >= 0.
/// @param lead_out  of the duct behind, >= 0.
/// @param n         cells in the channel, >= 2.
std::vector<double> edges_along(double length, double lead_in, double lead_out, int n);

/// Ends of n cells from floor, 0, to roof, 1, finer at both.
std::vector<double> edges_up(int n);

/// Ends of n cells from the middle, 0, to the side wall, finer there.
std::vector<double> edges_across(double half_width, int n);

}  // namespace manoscope::navier_stokes

#pragma once

#include "manoscope/core/units.hpp"
#include "manoscope/inversion/read_pressure.hpp"
#include "manoscope/inversion/test_section.hpp"

namespace manoscope::inversion {

/// Puts the wall's own stiffness along x into the error bars of a reading.
///
/// A wall under tension answers to pressure smoothed over L = w/pi, and near a clamped end to what
/// lies on one side only: a station-by-station reading is then off by about
///
///   g L exp(-d / L),
///
/// d the distance from the end, g the pressure gradient (here the mean over the test section). The
/// true size depends on wall and load, so it enters as a standard uncertainty, one shared variable
/// for each end ("wall stiffness at the inlet", "... outlet", source "end effect"), and the
/// interval is formed again.
///
/// @param coverage  probability content of the interval, as in ReadPressureOptions.
void add_end_doubt(PressureReading& reading, const TestSection& section, Length channel_length,
                   Length channel_width, double coverage);

}  // namespace manoscope::inversion

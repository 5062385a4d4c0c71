#pragma once

#include <optional>
#include <string>
#include <string_view>

#include "manoscope/core/units.hpp"

namespace manoscope::experiment {

/// What the name of a map file says about how it was taken.
struct FileNameGuess {
  enum class List { unknown, hydrostatic, flow };

  List list = List::unknown;
  std::optional<Pressure> pressure;
  std::optional<FlowRate> flow_rate;
  std::string pressure_text;   ///< the part of the name it was read from, "2.3kPa"
  std::string flow_rate_text;  ///< "70mlmin"
  bool ambiguous = false;      ///< two different pressures, or two different flow rates
};

/// Guesses pressure, flow rate and list from a file's name (its extension is ignored).
///
/// A quantity is a number and a unit with at most one of ' ', '_', '-' between them:
///  - number: digits with '.', ',' or 'p' as decimal mark (2.3, 2,3, 2p3) and an optional exponent.
///    A '-' right before it counts as a sign only at the start of the name or after '_', '=' or ' '
///    ("h_-50Pa"; not "S1-50Pa").
///  - pressure: Pa, hPa, kPa, MPa, ubar, mbar, bar, Torr, psi, atm, mmHg, mmH2O, cmH2O. Capitals do
///    not matter, but for M in MPa: "mPa" is taken for nothing.
///  - flow rate: uL, µL, nL, mL or L per min, s or h, written together or with "/", "_", "-", " ",
///    "p" or "per" between: mlmin, ml_min, mL-min, uLmin, "µL per h", mlpm. A volume alone ("70uL")
///    counts as per minute, and so do ccm and ccmin for mL.
/// After the unit the name ends or goes on with neither letter nor digit.
///
/// A flow rate puts the map into the flow list, a pressure alone into the hydrostatic one. Without
/// either, the letters the name starts with decide: h, hydro, hydrostatic, static, p, pressure,
/// cal, calib, calibration; f, flow, q, run.
FileNameGuess guess_from_file_name(std::string_view file_name);

}  // namespace manoscope::experiment

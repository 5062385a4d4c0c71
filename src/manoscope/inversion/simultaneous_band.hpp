#pragma once

#include "manoscope/inversion/read_pressure.hpp"

namespace manoscope::inversion {

/// Factor k of the simultaneous band p(x) +- k u(x): it holds the whole of p(x), over all stations
/// with an answer, with the given probability; each of the intervals `lower` to `upper` holds it at
/// its own station.
///
/// The chance that a curve of normal errors leaves a band somewhere is at most
///
///   (kappa/pi) exp(-k^2/2) + 2 (1 - Phi(k)),
///
/// kappa the length of the curve that the errors' unit vectors run through along x (Hotelling's
/// tube formula: Knowles & Siegmund, Int. Stat. Rev. 57, 205, 1989). Errors independent from
/// station to station have no such curve; Sidak's bound for as many independent errors as there are
/// stations always holds, and the smaller of both is taken.
///
/// @param coverage  in (0, 1).
/// @return 0 where no station has an answer.
double simultaneous_factor(const PressureReading& reading, double coverage);

}  // namespace manoscope::inversion

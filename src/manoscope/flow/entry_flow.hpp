#pragma once

#include "manoscope/core/arrays.hpp"
#include "manoscope/flow/channel.hpp"
#include "manoscope/flow/section_family.hpp"

namespace manoscope::flow {

/// Constants of developing flow in a rectangular duct.
struct EntryConstants {
  double friction_reynolds = 24.0;  ///< f Re of the developed flow
  double incremental_drop = 0.674;  ///< K(infinity)
  double curvature = 0.000029;      ///< C
};

/// Constants for a gap over width, between the four tabulated ones by a cubic polynomial.
///
///   gap/width   0         0.2       0.5      1
///   f Re       24.000    19.071    15.548   14.227
///   K           0.674     0.931     1.28     1.43
///   C           2.9e-5    7.6e-5    2.1e-4   2.9e-4
///
/// Source: R. K. Shah, J. Fluids Eng. 100 (1978) 177, the table of constants, as reproduced in the
/// handbooks that follow Shah & London, Laminar Flow Forced Convection in Ducts (1978). Checked
/// here against our own march from a uniform inlet: K of parallel plates and of gap/width 0.1
/// within 3 %.
/// @param gap_over_width  in (0, 1]; above 1 the duct is turned over.
EntryConstants entry_constants(double gap_over_width);

/// Drop of developing flow in excess of developed friction, in units of rho U^2/2:
///
///   K(x+) = 4 x+ (f_app Re - f Re),
///   f_app Re = 3.44/sqrt(x+) + (K/(4 x+) + f Re - 3.44/sqrt(x+)) / (1 + C/x+^2)
///
/// from a uniform profile at x+ = 0; K(infinity) for long ducts. x+ = x/(Dh Re), Re = U Dh/nu.
/// Source: R. K. Shah (1978), eq. (1), which gives f_app Re within 2.4 %.
/// @param x_plus  >= 0.
double entry_excess(const EntryConstants& constants, double x_plus);

/// Running drop of developing flow in excess of developed friction, along a channel whose section
/// varies slowly.
///
///   sum of rho U^2/2 dK(x+),  dx+ = dx/(Dh Re)
///
/// K counts the gain of momentum from the uniform to the developed profile; that of a section that
/// varies comes on top (momentum_drop()). The constants are those of the rectangle of the mean gap.
/// @param upstream  length of duct, with the first section, between the uniform profile and the
///                  first station, m; 0 if the flow starts to develop there.
/// @return (n) Pa, 0 at the first station.
/// @throws InputError if the flow rate is not positive or the length is negative.
Array1 entry_drop(const SectionsAlong& sections, const Fluid& fluid, FlowRate flow_rate,
                  Length width, Length upstream);

}  // namespace manoscope::flow

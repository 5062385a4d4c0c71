#pragma once

#include <optional>

#include "manoscope/core/profile.hpp"
#include "manoscope/core/uncertainty.hpp"
#include "manoscope/flow/channel.hpp"
#include "manoscope/inversion/read_pressure.hpp"
#include "manoscope/inversion/test_section.hpp"
#include "manoscope/validation/flow_setup.hpp"

namespace manoscope::validation {

/// Pressure drop read off the wall against the drop that the measured gap resists with.
struct DropAgreement {
  Estimate extracted;   ///< Pa, dp_e = p(x_start) - p(x_end) off the wall
  Estimate resistance;  ///< Pa, Q R over the same stretch
  /// |dp_e - QR| over its expanded uncertainty (k = 2), the errors both share accounted for: the
  /// E_n number of ISO/IEC 17043; agreement where it is at most 1. NaN where no uncertainty at all
  /// is stated, for then there is no verdict.
  double en_number = 0.0;
};

/// Compares dp_e with Q R over the test section of one run.
///
/// Source: Ozsun et al. 2013, eq. (4) and fig. 4. zeta(x) is in both: noise, plane and position of
/// the flow map move them together, which the difference accounts for. The gap 2 h0, the viscosity
/// and the flow rate are in QR alone, as the error variables "channel height", "viscosity" and
/// "flow rate", which all runs of an experiment share. QR is proportional to eta and to Q, so that
///
///   u(QR)^2 = (maps)^2 + (dQR/d(2 h0) u(2 h0))^2 + QR^2 ((u(eta)/eta)^2 + (u(Q)/Q)^2)
///
/// The formula leaves out inertia, entry and the bulged section: E_n above 1 at high flow rate may
/// be the formula's.
DropAgreement compare_drops(const flow::Channel& channel, const flow::Fluid& fluid,
                            FlowRate flow_rate, const FlowUncertainty& uncertainty,
                            const Profile& state, const inversion::PressureReading& reading,
                            const inversion::TestSection& section);

/// Channel-averaged Reynolds number Re_x = 2 Q / (nu (w + h)) (Ozsun et al. 2013, table I), the
/// wall taken as clamped (zeta = 0) at both ends.
double mean_reynolds(const flow::Channel& channel, const flow::Fluid& fluid, FlowRate flow_rate,
                     const Profile& state);

/// Q R over the whole channel by eq. (4), the wall taken as clamped at both ends.
Pressure channel_resistance_drop(const flow::Channel& channel, const flow::Fluid& fluid,
                                 FlowRate flow_rate, const Profile& state);

/// p(x) that the measured gap gives by eq. (4), shifted to meet the reading at the end of the test
/// section: p(x_end) + Q int_x^{x_end} r dx'.
/// @return (n_x) Pa.
Array1 resistance_pressure(const flow::Channel& channel, const flow::Fluid& fluid,
                           FlowRate flow_rate, const Profile& state,
                           const inversion::PressureReading& reading,
                           const inversion::TestSection& section);

}  // namespace manoscope::validation

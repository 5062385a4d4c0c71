#pragma once

#include <functional>
#include <optional>

#include "manoscope/calibration/constitutive_curves.hpp"
#include "manoscope/core/profile.hpp"
#include "manoscope/core/uncertainty.hpp"
#include "manoscope/inversion/read_pressure.hpp"
#include "manoscope/validation/flow_setup.hpp"

namespace manoscope::validation {

struct PredictFlowOptions {
  /// How far p may leave the calibrated range of a station on the straight continuation of its
  /// curve: until p or zeta has gone on by this share of its range.
  double largest_extrapolation = 0.1;
  /// Over which the wall forgets a disturbance, sqrt(-b/a) of its tube law; nullopt: width/(2 pi),
  /// half of that of a taut strip; 0: every station on its own.
  std::optional<Length> healing_length;
  double tolerance = 1e-7;  ///< of p, as a share of the largest
  int most_steps = 60;      ///< of Newton's method

  template <class Visitor>
  void describe(Visitor&& visit) {
    visit("largest-extrapolation", largest_extrapolation,
          "how far pressure and deflection may leave their calibrated range, as a share of it");
    visit("healing-length", healing_length,
          "length over which the wall forgets a disturbance; auto: of the fitted wall, else "
          "width/(2 pi)");
    visit("tolerance", tolerance, "change of p at which a prediction has settled, relative");
    visit("most-steps", most_steps, "most steps of Newton's method");
  }
  /// @throws InputError naming the first option out of range.
  void validate() const;
};

/// What to know of a predicted pressure. Bits per station; 0 = good.
struct PredictionFlag {
  /// The curve of this station ends before this pressure: a straight continuation.
  static constexpr FlagBits out_of_calibration = 1;
  /// A station downstream is out of calibration, or its curve falls: p here hangs on it.
  static constexpr FlagBits downstream_doubt = 2;
  /// The curve falls with pressure here: the wall may jump, and more than one state is possible.
  static constexpr FlagBits falling_curve = 4;
  /// A march met backflow here or upstream.
  static constexpr FlagBits separated = 8;
  /// S^2 >= 1 here, but not over a stretch as long as the wall's own response.
  static constexpr FlagBits nearly_choked = 16;
};

/// Pressure at the outlet, x = length.
struct Outlet {
  Pressure pressure{};
  Pressure uncertainty{};  ///< standard
};

/// The pressure at the outlet where it depends on the flow rate.
using OutletAt = std::function<Outlet(FlowRate)>;

/// State of wall and fluid at a flow rate that was not run. Arrays have shape (n).
struct FlowPrediction {
  flow::FlowModel model = flow::FlowModel::paper;
  FlowRate flow_rate{};
  Array1 x;                      ///< m, stations with a curve and the clamped ends
  std::vector<Index> station;    ///< of the curves; kClampedEnd for an end
  Array1 pressure;               ///< Pa
  Uncertainty uncertainty;       ///< Pa, of pressure
  Array1 zeta;                   ///< m
  Uncertainty zeta_uncertainty;  ///< m, same error variables
  Flags1 flags;                  ///< bits of PredictionFlag
  Estimate drop;                 ///< Pa, p(0) - p(length)
  Array1 speed_index;            ///< S^2, flow::speed_index(); 0 for models without inertia
  flow::ModelError error;        ///< stated error of the model at this flow
  int steps = 0;
};

/// Predicts p(x) and zeta(x) at a flow rate from the measured constitutive curves and a flow model.
///
///   p = m(zeta; Q),  zeta(x) = curve of the station at P(x),  P - L^2 P'' = p
///
/// with m of flow::pressure_along(), L the wall's healing length, P' = 0 at the ends, where the
/// curves themselves hold what the clamped edge does; no other model of the wall. P = p wherever p
/// is nearly straight over L; where a wall snaps through, L holds its neighbourhood together.
/// Newton's method with dm/dzeta of the model, from the flow past the undeflected wall. For a march
/// it is that of `momentum`, and what the march adds to it is brought up to date until p meets the
/// march itself within 2e-5.
///
/// Uncertainty, to first order: (1 - m' s G) dp = m' dzeta + dm, s = d zeta/dp of the curves, G
/// from p to P,
///   dzeta  errors of the curves at fixed p: maps, labels, gauge and interpolation, by the same
///          names as in a reading of the same curves
///   dm     "channel height", "viscosity", "flow rate", "outlet pressure", "flow model <name>" and
///          its bend, "inlet profile"
///
/// Validity: that of the model. Within a width of the clamped ends the wall's answer is more than
/// one length tells: zeta there is off by some p'' L^2 d zeta/dp, the drop hardly. Between stations
/// zeta is straight.
///
/// A flow rate has no answer where the flow chokes (models with inertia: the mean of S^2 over w/pi,
/// which the wall's tension holds together, is 1 or more), where p leaves the calibrated range by
/// more than largest_extrapolation, or where no steady state is found. The error then names, to two
/// digits and rounded down, the largest flow rate that has one, with the outlet pressure of that
/// flow rate, and what ends the answers there.
///
/// @throws InputError for such a flow rate; if no station has a curve.
FlowPrediction predict_flow(const calibration::ConstitutiveCurves& curves, const FlowSetup& setup,
                            flow::FlowModel model, FlowRate flow_rate, const OutletAt& outlet,
                            const inversion::GaugeErrors& gauge = {},
                            const PredictFlowOptions& options = {});
FlowPrediction predict_flow(const calibration::ConstitutiveCurves& curves, const FlowSetup& setup,
                            flow::FlowModel model, FlowRate flow_rate, const Outlet& outlet = {},
                            const inversion::GaugeErrors& gauge = {},
                            const PredictFlowOptions& options = {});

}  // namespace manoscope::validation

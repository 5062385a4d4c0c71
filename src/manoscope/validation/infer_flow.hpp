#pragma once

#include "manoscope/core/profile.hpp"
#include "manoscope/core/uncertainty.hpp"
#include "manoscope/inversion/read_pressure.hpp"
#include "manoscope/inversion/test_section.hpp"
#include "manoscope/validation/flow_setup.hpp"
#include "manoscope/validation/pieces.hpp"

namespace manoscope::validation {

struct InferFlowOptions {
  int pieces = 12;      ///< of the test section, whose mean pressures are fitted
  int most_steps = 30;  ///< of Gauss-Newton

  template <class Visitor>
  void describe(Visitor&& visit) {
    visit("pieces", pieces, "pieces of the test section whose mean pressures are fitted");
    visit("most-steps", most_steps, "most steps of the fit");
  }
  /// @throws InputError naming the first option out of range.
  void validate() const;
};

/// What the wall alone says of the flow.
struct InferredFlow {
  Estimate value;  ///< flow rate, m3/s, or viscosity, Pa s
  Array1 weights;  ///< (n_x) 1/Pa: relative change of the value per pascal of each reading
  ChiSquare fit;   ///< of what the fit leaves; dof = pieces - 2, none with two pieces
  int steps = 0;
  double relative_uncertainty() const { return value.standard_uncertainty() / value.value; }
};

/// Flow rate from the deflection alone: the Q whose pressure, by a flow model through the measured
/// gap, falls along the test section as the pressure that was read off the wall.
///
///   d_k(Q) = mean over piece k of (p_read - p_model(Q)), less that of the last piece
///   ln Q by generalised least squares of d = 0, weights from the covariance of d
///
/// zeta is in p_read and in p_model; its noise, plane and position have one effect on d, the
/// difference of both. The weights take noise, maps, labels and gauge; gap, viscosity, model and
/// inlet profile stay out of them, since they move all pieces nearly as Q does and a fit would
/// trade them for small differences of shape. All are in the uncertainty.
///
/// Source: generalised least squares, JCGM 102:2011 and Aitken (1935); Gauss-Newton. Validity: that
/// of the flow model; the gap's uncertainty counts threefold (Q goes as h^3). Accuracy on virtual
/// experiments whose flow model is true, gap known to 0.3 %: within 2 %, bars cover 95 % (tests).
///
/// @param setup  the flow rate's own uncertainty in it is not used.
/// @throws InputError as flow::pressure_along(), if the pressure does not fall along the section,
///         or if the fit does not settle.
InferredFlow infer_flow_rate(const FlowSetup& setup, flow::FlowModel model, const Profile& state,
                             const inversion::PressureReading& reading,
                             const inversion::TestSection& section,
                             const InferFlowOptions& options = {});

/// Viscosity from the deflection and a known flow rate, in the same way.
///
/// @param setup  its viscosity is where the search starts; its own uncertainty is not used.
InferredFlow infer_viscosity(const FlowSetup& setup, flow::FlowModel model, FlowRate flow_rate,
                             const Profile& state, const inversion::PressureReading& reading,
                             const inversion::TestSection& section,
                             const InferFlowOptions& options = {});

}  // namespace manoscope::validation

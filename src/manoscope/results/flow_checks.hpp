#pragma once

#include <string>
#include <vector>

#include "manoscope/core/arrays.hpp"
#include "manoscope/results/no_number.hpp"

namespace manoscope::results {

/// What the flow says of the reading: flow models against dp_e, what each physical effect adds to
/// the drop, the flow rate that the wall alone tells, the drop that the calibration predicts. Part
/// of Measurement: plain SI arrays whose names are those of the file.
///
/// Dimensions beside those of Measurement: flow_model (n_f) models that were run; correction (n_k)
/// physical effects, in the order in which they are added; passage_term (n_t) parts of the
/// parasitic drop. NaN where there is no number.
struct FlowChecks {
  // The paper's comparison: dp_e against Q R by eq. (4).
  Array1 extracted_drop, extracted_drop_uncertainty;    ///< (n_r) Pa
  Array1 resistance_drop, resistance_drop_uncertainty;  ///< (n_r) Pa, over the test section
  Array1 channel_resistance_drop;                       ///< (n_r) Pa, Q R over the whole channel
  Array2 resistance_pressure;  ///< (n_r, n_x) Pa: p(x_end) + Q int_x^x_end r
  Array1 reynolds;             ///< (n_r)
  Array1 en_number;            ///< (n_r) |dp_e - QR| / U of the difference, eq. (4) as exact

  // Every flow model against the reading, over the test section.
  std::string flow_setup;               ///< section and inlet that the models take, in words
  std::vector<std::string> flow_model;  ///< (n_f) flow::FlowModelInfo::name
  std::vector<std::string> verdict;     ///< (n_r) of the model that verdict_model names, in words
  std::string verdict_model;
  Array2 model_drop, model_drop_uncertainty;  ///< (n_f, n_r) Pa
  Array2 model_difference_uncertainty;        ///< (n_f, n_r) Pa, of model less reading
  Array2 model_en_number;                     ///< (n_f, n_r)
  Array2 model_chi_square, model_dof;         ///< (n_f, n_r) of p along x
  Array2 model_p_value;                       ///< (n_f, n_r) of that chi-square
  Array2 model_stated_error;                  ///< (n_f, n_r) half width, share of the drop
  std::vector<Array2> model_pressure;  ///< n_f of (n_r, n_x) Pa, tied to the reading at x_end

  // What each effect adds to the drop.
  std::vector<std::string> correction;  ///< (n_k)
  Array2 correction_drop;               ///< (n_k, n_r) Pa, over the test section
  Array2 correction_channel_drop;       ///< (n_k, n_r) Pa, over the whole channel
  Array2 correction_uncertainty;  ///< (n_k, n_r) Pa, standard, that the inlet profile leaves: entry
                                  ///< alone

  // The flow along the channel.
  Array1 reduced_reynolds;                   ///< (n_r) Re h/l
  Array2 local_reynolds;                     ///< (n_r, n_x)
  Array2 wall_shear_roof, wall_shear_floor;  ///< (n_r, n_x) Pa
  Array1 friction_drag;                      ///< (n_r) N, on all walls of the channel
  Array1 relative_friction_drag;             ///< (n_r) over that of the undeflected channel

  // The wall as a flow meter and as a viscometer.
  Array1 inferred_flow_rate, inferred_flow_rate_uncertainty;  ///< (n_r) m3 s-1
  Array1 inferred_flow_rate_p_value;                          ///< (n_r) of what the fit leaves
  Array1 inferred_viscosity, inferred_viscosity_uncertainty;  ///< (n_r) Pa s

  // Reading and flow model together; empty unless asked for.
  Array2 joint_pressure, joint_pressure_uncertainty;  ///< (n_r, n_x) Pa

  // The drop between the ends of the channel: transducer less passages, and as predicted.
  Array1 transducer_drop, transducer_drop_uncertainty;  ///< (n_r) Pa
  Array1 parasitic_drop, parasitic_drop_uncertainty;    ///< (n_r) Pa
  std::vector<std::string> passage_term;                ///< (n_t)
  Array2 passage_drop, passage_drop_uncertainty;        ///< (n_t, n_r) Pa
  Array1 compliant_drop, compliant_drop_uncertainty;    ///< (n_r) Pa, transducer less parasitic
  Array1 predicted_drop, predicted_drop_uncertainty;    ///< (n_r) Pa, from calibration and Q
  Array1 predicted_en_number;                           ///< (n_r) against compliant_drop
  Array2 predicted_pressure, predicted_pressure_uncertainty;  ///< (n_r, n_x) Pa

  // dp = a Q + b Q^2 and dp = C Q^n through the drops of the channel.
  double drop_fit_linear = kNoNumber, drop_fit_linear_uncertainty = kNoNumber;        ///< Pa s m-3
  double drop_fit_quadratic = kNoNumber, drop_fit_quadratic_uncertainty = kNoNumber;  ///< Pa s2 m-6
  double drop_fit_p_value = kNoNumber;
  double drop_fit_exponent = kNoNumber, drop_fit_exponent_uncertainty = kNoNumber;
  double drop_fit_power = kNoNumber;  ///< C, Pa at 1 m3 s-1
};

}  // namespace manoscope::results

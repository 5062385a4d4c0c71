#pragma once

#include <array>
#include <cmath>

#include "manoscope/results/measurement.hpp"

namespace manoscope::test_support {

/// Flow models against every run: eq. (4) gets the drop by errors that cancel, the march agrees.
inline void add_example_flow(results::Measurement& m) {
  m.flow_setup = "section of the wall between lowest and highest level: crest 1.5 times the mean";
  m.verdict_model = "section-march";
  m.flow_model = {"paper", "creeping", "momentum", "section-march"};
  m.correction = {"mean-gap rectangle", "true section", "inertia", "entry", "section march"};
  m.passage_term = {"inlet, duct", "inlet, contraction"};
  const Index n_r = m.flow_rate.size(), n_x = m.x.size();
  const std::array<double, 4> bias{1.01, 0.98, 1.03, 1.002};
  const std::array<double, 5> share{1.01, -0.03, 0.05, 0.0, -0.028};
  const Array2 per_model = Array2::Constant(4, n_r, results::kNoNumber),
               per_correction = Array2::Constant(5, n_r, results::kNoNumber),
               per_term = Array2::Constant(2, n_r, results::kNoNumber);
  m.model_drop = m.model_drop_uncertainty = m.model_difference_uncertainty = per_model;
  m.model_en_number = m.model_chi_square = m.model_dof = m.model_p_value = per_model;
  m.model_stated_error = per_model;
  m.correction_drop = m.correction_channel_drop = m.correction_uncertainty = per_correction;
  m.passage_drop = m.passage_drop_uncertainty = per_term;
  m.model_pressure.assign(4, Array2::Constant(n_r, n_x, results::kNoNumber));
  m.joint_pressure = m.joint_pressure_uncertainty = Array2::Constant(n_r, n_x, results::kNoNumber);
  m.local_reynolds = m.wall_shear_roof = m.wall_shear_floor =
      Array2::Constant(n_r, n_x, results::kNoNumber);
  m.predicted_pressure = m.predicted_pressure_uncertainty =
      Array2::Constant(n_r, n_x, results::kNoNumber);
  m.inferred_flow_rate = 1.004 * m.flow_rate;
  m.inferred_flow_rate_uncertainty = 0.006 * m.flow_rate;
  m.inferred_flow_rate_p_value = Array1::Constant(n_r, 0.4);
  m.inferred_viscosity = Array1::Constant(n_r, 0.998 * m.viscosity);
  m.inferred_viscosity_uncertainty = Array1::Constant(n_r, 0.008 * m.viscosity);
  m.reduced_reynolds = m.flow_rate * 6.9e6;
  m.friction_drag = m.extracted_drop * 2.6e-7;
  m.relative_friction_drag = 1.0 - 2e-5 * m.extracted_drop;
  m.transducer_drop_uncertainty = 0.0 * m.transducer_drop + 25.0;
  m.parasitic_drop_uncertainty = 0.05 * m.parasitic_drop;
  m.compliant_drop = m.transducer_drop - m.parasitic_drop;
  m.compliant_drop_uncertainty = (m.parasitic_drop_uncertainty.square() + 625.0).sqrt();
  m.predicted_drop = 1.01 * (m.channel_resistance_drop);
  m.predicted_drop_uncertainty = 0.012 * m.predicted_drop;
  m.predicted_en_number = Array1::Constant(n_r, results::kNoNumber);
  m.drop_fit_linear = 9e9;
  m.drop_fit_linear_uncertainty = 1e8;
  m.drop_fit_quadratic = -1e15;
  m.drop_fit_quadratic_uncertainty = 1e14;
  m.drop_fit_p_value = 0.3;
  m.drop_fit_exponent = 0.89;
  m.drop_fit_exponent_uncertainty = 0.01;
  m.drop_fit_power = 2.9e9;
  for (Index r = 0; r < n_r; ++r) {
    for (Index f = 0; f < 4; ++f) {
      const double b = bias[static_cast<std::size_t>(f)];
      m.model_drop(f, r) = b * m.extracted_drop(r);
      m.model_drop_uncertainty(f, r) = 0.009 * m.extracted_drop(r);
      m.model_difference_uncertainty(f, r) = 0.01 * m.extracted_drop(r);
      m.model_en_number(f, r) = std::abs(b - 1.0) / 0.02;
      m.model_chi_square(f, r) = f == 3 ? 6.0 : 60.0;
      m.model_dof(f, r) = 7.0;
      m.model_p_value(f, r) = f == 3 ? 0.54 : 1e-10;
      m.model_stated_error(f, r) = f == 3 ? 0.002 : 0.02 + 0.01 * static_cast<double>(r);
      const double bulge = (b - 1.0) * m.extracted_drop(r);
      m.model_pressure[static_cast<std::size_t>(f)].row(r) =
          m.resistance_pressure.row(r) +
          bulge * (1.0 - m.x.transpose() / m.channel_length) * (m.x.transpose() / m.channel_length);
    }
    for (Index k = 0; k < 5; ++k) {
      const double part = share[static_cast<std::size_t>(k)] * m.extracted_drop(r);
      m.correction_drop(k, r) = part;
      m.correction_channel_drop(k, r) = 1.2 * part;
      m.correction_uncertainty(k, r) = k == 3 ? 0.01 * m.extracted_drop(r) : std::nan("");
    }
    m.local_reynolds.row(r) = m.reynolds(r) * (1.0 + 0.01 * m.x.transpose() / m.channel_length);
    m.wall_shear_roof.row(r) =
        0.004 * m.extracted_drop(r) * (1.0 + m.x.transpose() / m.channel_length);
    m.wall_shear_floor.row(r) = 1.01 * m.wall_shear_roof.row(r);
    m.predicted_pressure.row(r) = m.resistance_pressure.row(r) + 12.0;
    m.predicted_pressure_uncertainty.row(r).setConstant(40.0);
    m.passage_drop(0, r) = 0.8 * m.parasitic_drop(r);
    m.passage_drop(1, r) = 0.2 * m.parasitic_drop(r);
    m.passage_drop_uncertainty(0, r) = 0.0;
    m.passage_drop_uncertainty(1, r) = m.parasitic_drop_uncertainty(r);
    m.predicted_en_number(r) = 0.6;
    m.verdict.push_back("agree within 2 %: the model gives 0.2 % more than the wall (E_n 0.10)");
  }
}

}  // namespace manoscope::test_support

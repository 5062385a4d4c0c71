// A made-up simulation of a run of example_measurement().
#pragma once

#include <string>

#include "manoscope/results/measurement.hpp"

namespace manoscope::test_support {

/// Two per cent below the reading in the plane, what side walls add beside it; one per cent below
/// in three dimensions.
inline results::Simulation example_simulation(const results::Measurement& m, Index run, int dim) {
  constexpr Index kStations = 41;
  const Index n_variants = dim == 2 ? 2 : 1;
  results::Simulation s;
  s.run = m.run[static_cast<std::size_t>(run)];
  s.source = m.source;
  s.experiment = m.experiment;
  s.inputs = m.inputs;
  s.inlet = "developed where it enters";
  s.roof = "zeta(x)";
  s.cells = "order = 2\n";
  s.dim = dim;
  s.flow_rate = m.flow_rate[run];
  s.converged = 1.0;
  s.n_unknowns = 8300.0;
  s.seconds = 1.5;
  s.peak_memory = 2e8;
  s.x = Array1::LinSpaced(kStations, 0.0, m.channel_length);
  const double drop = m.extracted_drop[run], u = 0.02 * drop;
  const Array1 share = 1.0 - s.x / m.channel_length;
  s.zeta = 20e-6 * share;
  s.zeta_uncertainty = Array1::Constant(kStations, 2e-9);
  s.gap = m.channel_height + s.zeta;
  s.outlet_pressure = 100.0;
  s.outlet_uncertainty = 5.0;
  s.pressure = s.pressure_uncertainty = Array2(n_variants, kStations);
  s.error_source = {"numerical", "channel height"};
  s.pressure_variance.assign(2, Array2(n_variants, kStations));
  s.drop = s.drop_uncertainty = s.difference_uncertainty = s.en_number = s.chi_square = s.dof =
      s.p_value = Array1(n_variants);
  s.drop_variance = Array2(2, n_variants);
  for (Index v = 0; v < n_variants; ++v) {
    const double part = dim == 3 ? 0.99 : v == 0 ? 0.90 : 0.98;
    s.variant.emplace_back(v == 0 ? "as solved" : "side walls added");
    s.verdict.emplace_back("in words");
    s.pressure.row(v) = 100.0 + part * drop * share;
    s.pressure_uncertainty.row(v) = u * share;
    s.pressure_variance[0].row(v) = 0.1 * (u * share).square();
    s.pressure_variance[1].row(v) = 0.9 * (u * share).square();
    s.drop[v] = part * drop;
    s.drop_uncertainty[v] = s.difference_uncertainty[v] = u;
    s.en_number[v] = (1.0 - part) * drop / (2.0 * u);
    s.chi_square[v] = 7.0;
    s.dof[v] = 7.0;
    s.p_value[v] = 0.4;
    s.drop_variance.col(v) << 0.1 * u * u, 0.9 * u * u;
  }
  s.wall_pressure = s.floor_pressure = s.pressure.row(0).transpose();
  s.wall_shear = s.floor_shear = Array1::Constant(kStations, 3.0);
  s.inlet_effect = 0.05 * drop * share;
  s.read_pressure = s.read_uncertainty = Array1::Constant(kStations, results::kNoNumber);
  s.channel_drop = 1.2 * drop;
  s.channel_drop_numerical_uncertainty = 1e-3 * drop;
  s.coarse_channel_drop = 1.2005 * drop;
  s.section_start = m.test_section(run, 0);
  s.section_end = m.test_section(run, 1);
  s.extracted_drop = drop;
  s.extracted_drop_uncertainty = m.extracted_drop_uncertainty[run];
  return s;
}

}  // namespace manoscope::test_support

#include "manoscope/pipeline/store_simulation.hpp"

#include <algorithm>
#include <iterator>

#include "manoscope/pipeline/at_stations.hpp"

namespace manoscope::pipeline {
namespace {

using results::Simulation;

/// Place of a part of the uncertainty in kSimulationErrors.
Index source_of(const std::string& name) {
  const auto* const first = std::begin(validation::kSimulationErrors);
  return std::find(first, std::end(validation::kSimulationErrors), name) - first;
}

}  // namespace

void store_solution(const SolvedFlow& solved, double outlet, Simulation& s) {
  s.x = solved.x;
  s.gap = solved.gap;
  s.wall_pressure = solved.wall_pressure + outlet;
  s.floor_pressure = solved.floor_pressure + outlet;
  s.wall_shear = solved.wall_shear;
  s.floor_shear = solved.floor_shear;
  s.channel_drop = solved.drop;
  s.channel_drop_numerical_uncertainty = solved.drop_uncertainty;
  s.coarse_channel_drop = solved.coarse_drop;
  s.converged = solved.converged ? 1.0 : 0.0;
  s.n_unknowns = solved.n_unknowns;
  s.seconds = solved.seconds;
  s.peak_memory = solved.peak_memory;
}

void store_comparison(const validation::SimulationComparison& found, Simulation& s) {
  const auto n_v = static_cast<Index>(found.variants.size());
  const Index n = s.x.size();
  s.error_source.assign(std::begin(validation::kSimulationErrors),
                        std::end(validation::kSimulationErrors));
  const auto n_s = static_cast<Index>(s.error_source.size());
  s.pressure = s.pressure_uncertainty = Array2(n_v, n);
  s.pressure_variance.assign(s.error_source.size(), Array2::Zero(n_v, n));
  for (Array1* list : {&s.drop, &s.drop_uncertainty, &s.difference_uncertainty, &s.en_number,
                       &s.chi_square, &s.dof, &s.p_value}) {
    *list = Array1::Constant(n_v, results::kNoNumber);
  }
  s.drop_variance = Array2::Constant(n_s, n_v, results::kNoNumber);
  for (Index v = 0; v < n_v; ++v) {
    const auto& variant = found.variants[static_cast<std::size_t>(v)];
    s.variant.push_back(variant.name);
    s.pressure.row(v) = variant.pressure;
    s.pressure_uncertainty.row(v) = variant.uncertainty.standard();
    for (const ErrorMode& mode : variant.uncertainty.modes) {
      s.pressure_variance[static_cast<std::size_t>(source_of(mode.source))].row(v) +=
          mode.effect.square().transpose();
    }
    s.verdict.push_back(variant.agreement ? variant.agreement->words
                                          : "no verdict: there is no test section");
    if (!variant.agreement) continue;
    const validation::ModelAgreement& one = *variant.agreement;
    s.drop[v] = one.drop.value;
    s.drop_uncertainty[v] = one.drop.standard_uncertainty();
    s.difference_uncertainty[v] = one.uncertainty;
    s.en_number[v] = one.en_number;
    if (one.agreement != validation::Agreement::no_verdict) {
      s.chi_square[v] = one.along.value;
      s.dof[v] = one.along.dof;
      s.p_value[v] = one.along.tail;
    }
    s.drop_variance.col(v).setZero();
    for (const Estimate::Term& term : one.drop.terms) {
      s.drop_variance(source_of(term.source), v) += term.effect * term.effect;
    }
  }
}

void store_reading(const RunFindings& found, Simulation& s) {
  s.read_pressure = answers_between(found.reading, found.reading.pressure, s.x);
  s.read_uncertainty = answers_between(found.reading, found.reading.uncertainty.standard(), s.x);
  if (found.section) {
    s.section_start = found.reading.x[found.section->first];
    s.section_end = found.reading.x[found.section->last];
  }
}

}  // namespace manoscope::pipeline

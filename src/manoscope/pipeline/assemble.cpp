#include "manoscope/pipeline/assemble.hpp"

#include <algorithm>
#include <cmath>
#include <limits>
#include <map>

#include "manoscope/core/flags.hpp"

namespace manoscope::pipeline {
namespace {

constexpr double kNan = std::numeric_limits<double>::quiet_NaN();

/// `values` where `keep`, NaN elsewhere.
template <class Keep>
Array1 masked(const Array1& values, Keep keep) {
  Array1 result(values.size());
  for (Index i = 0; i < values.size(); ++i) result[i] = keep(i) ? values[i] : kNan;
  return result;
}

/// Mean crest deflection of the maps taken at one pressure.
void store_crest(Index k, Pressure pressure, const experiment::Experiment& experiment,
                 const std::vector<maps::ReducedMap>& reduced, results::Measurement& m) {
  double sum = 0.0, variance = 0.0, count = 0.0;
  for (std::size_t i = 0; i < reduced.size(); ++i) {
    if (experiment.hydrostatic[i].pressure != pressure || std::isnan(reduced[i].crest)) continue;
    sum += reduced[i].crest;
    variance += reduced[i].crest_uncertainty * reduced[i].crest_uncertainty;
    count += 1.0;
  }
  m.crest_deflection[k] = count > 0.0 ? sum / count : kNan;
  m.crest_deflection_uncertainty[k] = count > 0.0 ? std::sqrt(variance) / count : kNan;
}

/// Variance by budget line, (n_x) each.
std::map<std::string, Array1> variance_by_source(const Uncertainty& uncertainty) {
  std::map<std::string, Array1> lines;
  lines["pixel noise"] = uncertainty.independent.square();
  for (const ErrorMode& mode : uncertainty.modes) {
    auto [place, is_new] = lines.try_emplace(mode.source, Array1::Zero(mode.effect.size()));
    place->second += mode.effect.square();
  }
  return lines;
}

/// Variance of a drop by budget line.
std::map<std::string, double> variance_by_source(const Estimate& drop) {
  std::map<std::string, std::map<std::string, double>> effects;  // by source, by variable
  for (const Estimate::Term& term : drop.terms) effects[term.source][term.variable] += term.effect;
  std::map<std::string, double> lines;
  for (const auto& [source, by_variable] : effects) {
    for (const auto& [variable, effect] : by_variable) lines[source] += effect * effect;
  }
  return lines;
}

/// Budget of the extracted drops, over the sources of the pressures.
void store_drop_budget(const std::vector<RunFindings>& findings, results::Measurement& m) {
  const auto n_runs = static_cast<Index>(findings.size());
  m.extracted_drop_variance =
      Array2::Constant(static_cast<Index>(m.budget_source.size()), n_runs, kNan);
  for (Index r = 0; r < n_runs; ++r) {
    const auto& agreement = findings[static_cast<std::size_t>(r)].agreement;
    if (!agreement) continue;
    auto lines = variance_by_source(agreement->extracted);
    for (std::size_t s = 0; s < m.budget_source.size(); ++s) {
      m.extracted_drop_variance(static_cast<Index>(s), r) = lines[m.budget_source[s]];
    }
  }
}

void store_budget(const std::vector<RunFindings>& findings, results::Measurement& m) {
  const auto n_runs = static_cast<Index>(findings.size());
  // A source that a run does not have adds 0 where there is an answer.
  Array2 nothing(n_runs, m.x.size());
  for (Index r = 0; r < n_runs; ++r) {
    const auto& reading = findings[static_cast<std::size_t>(r)].reading;
    nothing.row(r) = masked(Array1::Zero(m.x.size()), [&](Index i) { return reading.answered(i); });
  }
  std::map<std::string, std::size_t> place;
  for (Index r = 0; r < n_runs; ++r) {
    const auto& reading = findings[static_cast<std::size_t>(r)].reading;
    for (const auto& [source, variance] : variance_by_source(reading.uncertainty)) {
      const auto [found, is_new] = place.try_emplace(source, m.budget_source.size());
      if (is_new) {
        m.budget_source.push_back(source);
        m.pressure_variance.push_back(nothing);
      }
      m.pressure_variance[found->second].row(r) =
          masked(variance, [&](Index i) { return reading.answered(i); });
    }
  }
  store_drop_budget(findings, m);
}

}  // namespace

void store_calibration(const calibration::ConstitutiveCurves& curves,
                       const experiment::Experiment& experiment,
                       const std::vector<maps::ReducedMap>& reduced, results::Measurement& m) {
  const auto n = static_cast<Index>(curves.levels.size());
  m.x = curves.x;
  m.level_pressure = m.level_pressure_uncertainty = Array1(n);
  m.level_estimate = curves.level_pressure;
  m.level_estimate_uncertainty = curves.level_uncertainty();
  m.crest_deflection = m.crest_deflection_uncertainty = Array1(n);
  m.static_deflection = m.static_deflection_uncertainty = Array2(n, curves.x.size());
  for (Index k = 0; k < n; ++k) {
    const calibration::Level& level = curves.levels[static_cast<std::size_t>(k)];
    const auto counts = [&](Index i) { return level.profile.flags[i] == 0; };
    m.level_pressure[k] = level.pressure.si();
    m.level_pressure_uncertainty[k] = level.uncertainty.si();
    m.static_deflection.row(k) = masked(level.profile.zeta, counts);
    m.static_deflection_uncertainty.row(k) = masked(level.profile.uncertainty.standard(), counts);
    store_crest(k, level.pressure, experiment, reduced, m);
  }
}

void store_runs(const std::vector<FlowRun>& runs, const std::vector<RunFindings>& findings,
                results::Measurement& m) {
  const auto n = static_cast<Index>(runs.size());
  const Index n_x = m.x.size();
  for (Array1* scalar :
       {&m.flow_rate, &m.extracted_drop, &m.extracted_drop_uncertainty, &m.resistance_drop,
        &m.resistance_drop_uncertainty, &m.channel_resistance_drop, &m.reynolds, &m.en_number,
        &m.half_response_wavelength, &m.pressure_band_factor}) {
    *scalar = Array1::Constant(n, kNan);
  }
  for (Array2* field : {&m.deflection, &m.deflection_uncertainty, &m.pressure,
                        &m.pressure_uncertainty, &m.pressure_lower, &m.pressure_upper,
                        &m.pressure_local, &m.pressure_local_uncertainty, &m.resistance_pressure}) {
    *field = Array2::Constant(n, n_x, kNan);
  }
  m.pressure_flags = Flags2::Zero(n, n_x);
  m.test_section = Array2::Constant(n, 2, kNan);
  std::vector<double> x, x_uncertainty, pressure;
  for (Index r = 0; r < n; ++r) {
    const FlowRun& run = runs[static_cast<std::size_t>(r)];
    const RunFindings& found = findings[static_cast<std::size_t>(r)];
    const inversion::PressureReading& reading = found.reading;
    const auto measured = [&](Index i) { return run.profile.flags[i] == 0; };
    const auto answered = [&](Index i) { return reading.answered(i); };
    m.run.push_back(run.name);
    m.flow_rate[r] = run.flow_rate.si();
    m.deflection.row(r) = masked(run.profile.zeta, measured);
    m.deflection_uncertainty.row(r) = masked(run.profile.uncertainty.standard(), measured);
    m.pressure.row(r) = masked(reading.pressure, answered);
    m.pressure_uncertainty.row(r) = masked(reading.uncertainty.standard(), answered);
    m.pressure_lower.row(r) = masked(reading.lower, answered);
    m.pressure_upper.row(r) = masked(reading.upper, answered);
    m.pressure_local.row(r) = masked(found.local_pressure, answered);
    m.pressure_local_uncertainty.row(r) = masked(found.local_uncertainty, answered);
    m.half_response_wavelength[r] = found.half_wavelength;
    if (found.band_factor > 0.0) m.pressure_band_factor[r] = found.band_factor;
    m.pressure_flags.row(r) = reading.flags;
    Matrix covariance = reading.uncertainty.covariance();
    for (Index i = 0; i < n_x; ++i) {
      if (answered(i)) continue;
      covariance.row(i).setConstant(kNan);
      covariance.col(i).setConstant(kNan);
    }
    m.pressure_covariance.push_back(std::move(covariance));
    m.resistance_pressure.row(r) = found.resistance_pressure;
    m.channel_resistance_drop[r] = found.channel_resistance_drop;
    m.reynolds[r] = found.reynolds;
    if (found.section) {
      m.test_section(r, 0) = reading.x[found.section->first];
      m.test_section(r, 1) = reading.x[found.section->last];
    }
    if (found.agreement) {
      m.extracted_drop[r] = found.agreement->extracted.value;
      m.extracted_drop_uncertainty[r] = found.agreement->extracted.standard_uncertainty();
      m.resistance_drop[r] = found.agreement->resistance.value;
      m.resistance_drop_uncertainty[r] = found.agreement->resistance.standard_uncertainty();
      // Without a stated uncertainty of the gap there is no verdict: 1 % of it is 3 % of QR.
      if (m.channel_height_uncertainty > 0.0) m.en_number[r] = found.agreement->en_number;
    }
    for (const inversion::Intersection& crossing : found.intersections) {
      m.crossing_run.push_back(static_cast<int>(r));
      x.push_back(crossing.x.si());
      x_uncertainty.push_back(crossing.x_uncertainty.si());
      pressure.push_back(crossing.pressure.si());
    }
  }
  const auto to_array = [](const std::vector<double>& values) -> Array1 {
    return Eigen::Map<const Array1>(values.data(), static_cast<Index>(values.size()));
  };
  m.crossing_x = to_array(x);
  m.crossing_x_uncertainty = to_array(x_uncertainty);
  m.crossing_pressure = to_array(pressure);
  store_budget(findings, m);
}

namespace {

void store_pictures(const experiment::Experiment& experiment, const ReducedExperiment& reduced,
                    results::Measurement& m) {
  m.map_pressure = Array1::Constant(static_cast<Index>(m.map.size()), kNan);
  for (std::size_t i = 0; i < experiment.hydrostatic.size(); ++i) {
    m.map_pressure[static_cast<Index>(i)] = experiment.hydrostatic[i].pressure.si();
  }
  for (const auto* maps : {&reduced.hydrostatic, &reduced.flow}) {
    for (const maps::ReducedMap& map : *maps) m.map_picture.push_back(map.picture);
  }
}

}  // namespace

void store_map_conditions(const experiment::Experiment& experiment,
                          const ReducedExperiment& reduced, results::Measurement& m) {
  m.response_x = reduced.response.x;
  m.response_z = reduced.response.z;
  m.wall_response = reduced.response.height;
  std::vector<const maps::MapCondition*> conditions;
  for (const auto& map : reduced.hydrostatic) conditions.push_back(&map.condition);
  for (const auto& map : reduced.flow) conditions.push_back(&map.condition);
  const auto n = static_cast<Index>(conditions.size());
  m.map_tilt_x = m.map_tilt_z = m.map_noise = m.map_missing = m.map_spikes = Array1(n);
  m.map_shift = m.map_shift_uncertainty = m.map_shift_across = m.map_rotation = Array1(n);
  m.map_shift_across_uncertainty = m.map_rotation_uncertainty = m.map_unmended = Array1(n);
  m.map_mended = m.map_rim_bend = m.map_rim_bend_uncertainty = Array1(n);
  for (Index i = 0; i < n; ++i) {
    const maps::MapCondition& condition = *conditions[static_cast<std::size_t>(i)];
    m.map.push_back(condition.name);
    m.map_tilt_x[i] = condition.tilt_x;
    m.map_tilt_z[i] = condition.tilt_z;
    m.map_noise[i] = condition.noise.sigma.si();
    m.map_missing[i] = condition.missing;
    m.map_spikes[i] = condition.spikes;
    m.map_shift[i] = condition.shift.shift.si();
    m.map_shift_uncertainty[i] = condition.shift.uncertainty.si();
    m.map_shift_across[i] = condition.placement.offset.si();
    m.map_rotation[i] = condition.placement.slope;
    const auto& centre = condition.centre;
    m.map_shift_across_uncertainty[i] = centre ? centre->offset_uncertainty.si() : kNan;
    m.map_rotation_uncertainty[i] = centre ? centre->slope_uncertainty : kNan;
    const auto n_pixels = static_cast<double>(reduced.grid.nx * reduced.grid.ny);
    m.map_mended[i] = static_cast<double>(condition.fringe.mended_pixels) / n_pixels;
    m.map_unmended[i] = static_cast<double>(condition.fringe.flagged_pixels) / n_pixels;
    m.map_rim_bend[i] = condition.bend.at_middle.si();
    m.map_rim_bend_uncertainty[i] = condition.bend.at_middle_uncertainty.si();
  }
  store_pictures(experiment, reduced, m);
}

}  // namespace manoscope::pipeline

#include "manoscope/pipeline/tube_law_findings.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <numbers>

#include "manoscope/core/uncertainty.hpp"

namespace manoscope::pipeline {
namespace {

using results::Measurement;

/// "-5.8 ± 1.2": an expanded uncertainty of two digits.
std::string with_uncertainty(double value, double standard) {
  const double expanded = kExpansion * standard;
  if (!(expanded > 0.0)) return fmt::format("{:.4g}", value);
  const int digits = std::max(0, 1 - static_cast<int>(std::floor(std::log10(expanded))));
  return fmt::format("{:.{}f} ± {:.{}f}", value, digits, expanded, digits);
}

std::string sigmas(double value, double standard) {
  return fmt::format("{:.1f} sigma", std::abs(value) / standard);
}

/// Index of the smallest or largest magnitude among entries that exist; -1 if none does.
Index extreme(const Array1& values, bool largest) {
  Index best = -1;
  for (Index i = 0; i < values.size(); ++i) {
    if (!std::isfinite(values[i])) continue;
    if (best < 0 || (std::abs(values[i]) > std::abs(values[best])) == largest) best = i;
  }
  return best;
}

std::string of_run(const Measurement& m, Index run, bool first) {
  return fmt::format("{}{} N/m at {:.1f} um ({}), {}{}", first ? "b = " : "",
                     with_uncertainty(m.tube_law_b[run], m.tube_law_b_uncertainty[run]),
                     m.tube_law_deflection[run] * 1e6, m.run[static_cast<std::size_t>(run)],
                     first ? "differs from 0 by " : "",
                     sigmas(m.tube_law_b[run], m.tube_law_b_uncertainty[run]));
}

std::string lengths_text(const Measurement& m, Index run) {
  std::string text;
  if (std::isfinite(m.healing_length[run])) {
    text += fmt::format("healing length {:.2f} mm", m.healing_length[run] * 1e3);
    if (std::isfinite(m.half_response_wavelength[run])) {
      text += fmt::format(", of the fitted wall {:.2f} mm",
                          m.half_response_wavelength[run] * 1e3 / (2.0 * std::numbers::pi));
    }
    text += fmt::format(", width/pi {:.2f} mm; ", m.channel_width * 1e3 / std::numbers::pi);
  }
  return text;
}

std::string under_flow_text(const Measurement& m, const std::string& why) {
  const Index small = extreme(m.tube_law_deflection, false);
  const Index large = extreme(m.tube_law_deflection, true);
  if (small < 0) {
    return m.run.empty() ? std::string() : "not determined under flow: " + why + "; ";
  }
  std::string text = of_run(m, small, true) + "; ";
  if (large != small) text += of_run(m, large, false) + "; ";
  return text + lengths_text(m, large);
}

std::string at_rest_text(const Measurement& m, const std::string& why) {
  const Index large = extreme(m.tube_law_at_rest_deflection, true);
  if (large < 0) return "at rest not determined: " + why;
  std::string text = "at rest, from the wall's ends, ";
  if (std::isfinite(m.tube_law_at_rest_b_small)) {
    text += fmt::format(
        "{} N/m for small deflections, ",
        with_uncertainty(m.tube_law_at_rest_b_small, m.tube_law_at_rest_b_small_uncertainty));
  }
  return text + fmt::format("{} N/m at {:.1f} um",
                            with_uncertainty(m.tube_law_at_rest_b[large],
                                             m.tube_law_at_rest_b_uncertainty[large]),
                            m.tube_law_at_rest_deflection[large] * 1e6);
}

}  // namespace

void store_tube_law(const inversion::TubeLawAtRest& at_rest,
                    const inversion::StationStiffness& stiffness,
                    const std::vector<RunFindings>& findings, Measurement& m) {
  m.stiffness = stiffness.value;
  m.stiffness_uncertainty = stiffness.uncertainty;
  const auto n_levels = static_cast<Index>(at_rest.levels.size());
  for (Array1* of : {&m.tube_law_at_rest_deflection, &m.tube_law_at_rest_a, &m.tube_law_at_rest_b,
                     &m.tube_law_at_rest_b_uncertainty, &m.tube_law_at_rest_misfit}) {
    *of = Array1::Constant(n_levels, kMissing);
  }
  for (Index k = 0; k < n_levels; ++k) {
    const auto& law = at_rest.levels[static_cast<std::size_t>(k)];
    if (!law) continue;
    m.tube_law_at_rest_deflection[k] = law->deflection;
    m.tube_law_at_rest_a[k] = law->stiffness;
    m.tube_law_at_rest_b[k] = law->b;
    m.tube_law_at_rest_b_uncertainty[k] = law->uncertainty;
    m.tube_law_at_rest_misfit[k] = law->misfit;
  }
  m.tube_law_at_rest_b_small = at_rest.small ? at_rest.small->value : kMissing;
  m.tube_law_at_rest_b_small_uncertainty = at_rest.small ? at_rest.small->uncertainty : kMissing;
  const auto n_runs = static_cast<Index>(findings.size());
  for (Array1* of : {&m.tube_law_deflection, &m.tube_law_a, &m.tube_law_b,
                     &m.tube_law_b_uncertainty, &m.tube_law_misfit, &m.healing_length}) {
    *of = Array1::Constant(n_runs, kMissing);
  }
  NoTubeLaw why{{}, at_rest.reason};
  for (Index r = 0; r < n_runs; ++r) {
    const auto& found = findings[static_cast<std::size_t>(r)].tube_law;
    if (!found.law) {
      why.under_flow = found.reason;
      continue;
    }
    m.tube_law_deflection[r] = found.law->deflection;
    m.tube_law_a[r] = found.law->stiffness;
    m.tube_law_b[r] = found.law->b;
    m.tube_law_b_uncertainty[r] = found.law->uncertainty;
    m.tube_law_misfit[r] = found.law->misfit;
    m.healing_length[r] = found.law->healing_length();
  }
  m.tube_law = tube_law_text(m, why);
}

std::string tube_law_text(const Measurement& m, const NoTubeLaw& why) {
  return under_flow_text(m, why.under_flow) + at_rest_text(m, why.at_rest);
}

}  // namespace manoscope::pipeline

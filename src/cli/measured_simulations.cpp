#include "measured_simulations.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <nlohmann/json.hpp>

#include "json_number.hpp"
#include "manoscope/core/options.hpp"
#include "manoscope/core/uncertainty.hpp"
#include "manoscope/report/flow_verdict.hpp"
#include "text_table.hpp"

namespace manoscope::cli {
namespace {

using nlohmann::json;
using results::Simulation;

Array1 row(const Array2& values, Index v) { return values.row(v).transpose(); }

std::string percent(double part, double whole) {
  return std::isfinite(part / whole) ? fmt::format("{:+.1f} %", 100.0 * part / whole)
                                     : std::string("-");
}

/// The words of a solution and of what is added to it.
std::string variant_words(const Simulation& s, Index v) {
  const std::string name = fmt::format("Navier-Stokes {:.0f}-D", s.dim);
  return v == 0 ? name : name + ", side walls added";
}

std::string drops_text(const std::vector<Simulation>& simulations) {
  std::vector<std::vector<std::string>> rows{
      {"run", "Q [mL/min]", "", "dp ± U [Pa]", "less the reading", "E_n", "verdict"}};
  for (const Simulation& s : simulations) {
    const std::string flow = flow_rate_text(FlowRate::from_si(s.flow_rate));
    rows.push_back({s.run, flow, "read off the wall",
                    value_text(s.extracted_drop, s.extracted_drop_uncertainty), "", "", ""});
    for (Index v = 0; v < s.drop.size(); ++v) {
      rows.push_back({"", "", variant_words(s, v), value_text(s.drop[v], s.drop_uncertainty[v]),
                      percent(s.drop[v] - s.extracted_drop, s.extracted_drop),
                      fixed(s.en_number[v], 2),
                      report::verdict_word(report::flow_verdict(s.en_number[v], s.p_value[v]))});
    }
  }
  return text_table(rows);
}

/// "numerical 1.2, deflection 3.4, .." of the last variant, which holds every part.
std::string parts_text(const Simulation& s) {
  const Index v = s.drop.size() - 1;
  std::string text;
  for (std::size_t k = 0; k < s.error_source.size(); ++k) {
    const double part = kExpansion * std::sqrt(s.drop_variance(static_cast<Index>(k), v));
    if (!(part > 0.0)) continue;
    const double share = part / std::abs(s.drop[v]);
    constexpr double kNothing = 5e-6;
    if (share < kNothing) continue;
    text +=
        fmt::format("{}{} {:.2g} %", text.empty() ? "" : ", ", s.error_source[k], 100.0 * share);
  }
  return text.empty() ? "no test section" : text;
}

std::string stations_text(const Simulation& s) {
  constexpr Index kRows = 13;
  const bool sides = s.variant.size() > 1;
  std::vector<std::string> head{"x [mm]", "gap [um]", "p simulated ± U [Pa]"};
  if (sides) head.emplace_back("with side walls ± U");
  head.insert(head.end(), {"p read ± U [Pa]", "wall shear [Pa]"});
  std::vector<std::vector<std::string>> rows{head};
  for (Index i = 0; i < kRows; ++i) {
    const Index k = (s.x.size() - 1) * i / (kRows - 1);
    std::vector<std::string> cells{fixed(s.x[k] * 1e3, 2), fixed(s.gap[k] * 1e6, 1)};
    for (Index v = 0; v < s.pressure.rows(); ++v) {
      cells.push_back(value_text(s.pressure(v, k), s.pressure_uncertainty(v, k)));
    }
    cells.push_back(value_text(s.read_pressure[k], s.read_uncertainty[k]));
    cells.push_back(fmt::format("{:.3g}", s.wall_shear[k]));
    rows.push_back(cells);
  }
  return text_table(rows);
}

std::string run_text(const Simulation& s) {
  std::string text = fmt::format("\n{}, Navier-Stokes {:.0f}-D\n", s.run, s.dim);
  for (std::size_t v = 0; v < s.verdict.size(); ++v) {
    text += fmt::format("{}: {}.\n", s.variant[v], s.verdict[v]);
  }
  text += fmt::format("Shape: {}.\n", s.roof);
  text += fmt::format("Flow: {}", s.inlet);
  if ((s.inlet_effect != 0.0).any()) {
    text +=
        fmt::format(", {} on the drop of the channel", percent(s.inlet_effect[0], s.channel_drop));
  }
  text += fmt::format(". Outlet: {} Pa.\n", value_text(s.outlet_pressure, s.outlet_uncertainty));
  text += fmt::format("U of the drop by part: {}.\n", parts_text(s));
  text += fmt::format(
      "Channel, end to end: {} Pa (± numerical); {:.0f} unknowns, {:.3g} s, {:.0f} MB.\n",
      value_text(s.channel_drop, s.channel_drop_numerical_uncertainty), s.n_unknowns, s.seconds,
      s.peak_memory / 1e6);
  return text + stations_text(s);
}

json variant_json(const Simulation& s, Index v) {
  json parts = json::object();
  for (std::size_t k = 0; k < s.error_source.size(); ++k) {
    parts[s.error_source[k]] = number(std::sqrt(s.drop_variance(static_cast<Index>(k), v)));
  }
  const auto at = static_cast<std::size_t>(v);
  return {{"name", s.variant[at]},
          {"drop_Pa", number(s.drop[v])},
          {"drop_uncertainty_Pa", number(s.drop_uncertainty[v])},
          {"drop_uncertainty_parts_Pa", parts},
          {"difference_uncertainty_Pa", number(s.difference_uncertainty[v])},
          {"en_number", number(s.en_number[v])},
          {"chi_square", number(s.chi_square[v])},
          {"dof", number(s.dof[v])},
          {"p_value", number(s.p_value[v])},
          {"verdict", s.verdict[at]},
          {"mean_pressure_Pa", numbers(row(s.pressure, v))},
          {"mean_pressure_uncertainty_Pa", numbers(row(s.pressure_uncertainty, v))}};
}

json run_json(const Simulation& s) {
  json variants = json::array();
  for (Index v = 0; v < s.pressure.rows(); ++v) variants.push_back(variant_json(s, v));
  return {{"run", s.run},
          {"flow_rate_m3_s", s.flow_rate},
          {"dim", static_cast<int>(s.dim)},
          {"drop_Pa", s.channel_drop},
          {"drop_numerical_uncertainty_Pa", s.channel_drop_numerical_uncertainty},
          {"coarse_drop_Pa", s.coarse_channel_drop},
          {"converged", s.converged != 0.0},
          {"x_m", numbers(s.x)},
          {"gap_m", numbers(s.gap)},
          {"deflection_m", numbers(s.zeta)},
          {"deflection_uncertainty_m", numbers(s.zeta_uncertainty)},
          {"mean_pressure_Pa", numbers(row(s.pressure, 0))},
          {"mean_pressure_uncertainty_Pa", numbers(row(s.pressure_uncertainty, 0))},
          {"wall_pressure_Pa", numbers(s.wall_pressure)},
          {"floor_pressure_Pa", numbers(s.floor_pressure)},
          {"wall_shear_Pa", numbers(s.wall_shear)},
          {"floor_shear_Pa", numbers(s.floor_shear)},
          {"read_pressure_Pa", numbers(s.read_pressure)},
          {"read_pressure_uncertainty_Pa", numbers(s.read_uncertainty)},
          {"inlet", s.inlet},
          {"inlet_effect_Pa", numbers(s.inlet_effect)},
          {"outlet_pressure_Pa", number(s.outlet_pressure)},
          {"outlet_pressure_uncertainty_Pa", number(s.outlet_uncertainty)},
          {"shape", s.roof},
          {"smoothing_half_wavelength_m", number(s.smoothing_half_wavelength)},
          {"smoothing_taken_m", number(s.smoothing_taken)},
          {"smoothing_noise_m", number(s.smoothing_noise)},
          {"roof_map", s.roof_map != 0.0},
          {"roof_taken_m", number(s.roof_taken)},
          {"roof_noise_m", number(s.roof_noise)},
          {"roof_end_taken_m", number(s.roof_end_taken)},
          {"roof_misfit", number(s.roof_misfit)},
          {"roof_departure_m", number(s.roof_departure)},
          {"roof_effect", number(s.roof_effect)},
          {"roof_odd_m", number(s.roof_odd)},
          {"roof_odd_uncertainty_m", number(s.roof_odd_uncertainty)},
          {"roof_odd_effect", number(s.roof_odd_effect)},
          {"test_section_m", json::array({number(s.section_start), number(s.section_end)})},
          {"extracted_drop_Pa", number(s.extracted_drop)},
          {"extracted_drop_uncertainty_Pa", number(s.extracted_drop_uncertainty)},
          {"test_section", variants},
          {"unknowns", static_cast<long long>(s.n_unknowns)},
          {"seconds", s.seconds},
          {"peak_MB", s.peak_memory / 1e6}};
}

}  // namespace

std::string simulations_text(const std::vector<Simulation>& simulations, bool in_short) {
  std::string text = "Drop over the test section\n" + drops_text(simulations);
  if (in_short) return text;
  text += fmt::format("U: expanded uncertainty, k = {:.0f}.", kExpansion);
  const bool plane = std::any_of(simulations.begin(), simulations.end(),
                                 [](const Simulation& s) { return s.variant.size() > 1; });
  if (plane) {
    text +=
        " Between plates there are no side walls: what they and the curved roof add by the "
        "resistance of the section is given beside.";
  }
  text += '\n';
  for (const Simulation& s : simulations) text += run_text(s);
  return text;
}

std::string simulations_json(const std::vector<Simulation>& simulations, bool one) {
  json all = json::array();
  for (const Simulation& s : simulations) all.push_back(run_json(s));
  return (one && all.size() == 1 ? all.front() : all).dump() + '\n';
}

std::string solver_settings(const navier_stokes::SimulationOptions& options) {
  constexpr const char* kOwn[] = {"lead-in",      "lead-out",    "lead-in-slips",
                                  "order",        "cells-along", "cells-up",
                                  "cells-across", "tolerance",   "stations"};
  std::string text;
  for (const OptionInfo& option : list_options(options)) {
    if (std::find(std::begin(kOwn), std::end(kOwn), option.name) == std::end(kOwn)) continue;
    text += fmt::format("{} = {}\n", option.name, option.value);
  }
  return text;
}

}  // namespace manoscope::cli

#include "manoscope/results/simulation_table.hpp"

#include <algorithm>
#include <cmath>

#include "manoscope/results/tables.hpp"

namespace manoscope::results {
namespace {

std::string head(const Simulation& first) {
  std::string text =
      "run,dim,flow_rate_m3_s,x_m,deflection_m,deflection_uncertainty_m,gap_m,mean_pressure_Pa,"
      "mean_pressure_uncertainty_Pa,mean_pressure_with_side_walls_Pa,"
      "mean_pressure_with_side_walls_uncertainty_Pa,read_pressure_Pa,read_pressure_uncertainty_Pa,"
      "inlet_effect_Pa,wall_pressure_Pa,floor_pressure_Pa,wall_shear_Pa,floor_shear_Pa";
  for (std::string source : first.error_source) {
    std::replace(source.begin(), source.end(), ' ', '_');
    text += ",uncertainty_by_" + source + "_Pa";
  }
  return text + '\n';
}

std::string row(const Simulation& s, Index i) {
  const Index last = s.pressure.rows() - 1;  // holds every part
  const auto with_sides = [&](const Array2& values) {
    return last > 0 ? values(last, i) : kNoNumber;
  };
  std::string text = csv_cell(s.run);
  for (const double value :
       {s.dim, s.flow_rate, s.x[i], s.zeta[i], s.zeta_uncertainty[i], s.gap[i], s.pressure(0, i),
        s.pressure_uncertainty(0, i), with_sides(s.pressure), with_sides(s.pressure_uncertainty),
        s.read_pressure[i], s.read_uncertainty[i], s.inlet_effect[i], s.wall_pressure[i],
        s.floor_pressure[i], s.wall_shear[i], s.floor_shear[i]}) {
    text += ',' + csv_cell(value);
  }
  for (const Array2& part : s.pressure_variance) text += ',' + csv_cell(std::sqrt(part(last, i)));
  return text + '\n';
}

}  // namespace

std::string simulations_table(const std::vector<Simulation>& simulations) {
  if (simulations.empty()) return {};
  std::string text = head(simulations.front());
  for (const Simulation& s : simulations) {
    for (Index i = 0; i < s.x.size(); ++i) text += row(s, i);
  }
  return text;
}

}  // namespace manoscope::results

#include "flow_json.hpp"

#include <cstdint>
#include <nlohmann/json.hpp>
#include <vector>

namespace manoscope::navier_stokes {
namespace {

nlohmann::ordered_json list(const Array1& values) {
  return std::vector<double>(values.data(), values.data() + values.size());
}

/// Of a flow in a channel or in a passage: what its drop is.
template <class Flow>
nlohmann::ordered_json drop_of(const Flow& flow) {
  nlohmann::ordered_json object;
  object["dim"] = flow.dim;
  object["drop_Pa"] = flow.drop;
  object["drop_numerical_uncertainty_Pa"] = flow.drop_uncertainty;
  object["coarse_drop_Pa"] = flow.coarse_drop;
  object["converged"] = flow.converged;
  return object;
}

void add_costs(const FlowCosts& costs, const Effort& effort, nlohmann::ordered_json& object) {
  object["unknowns"] = static_cast<std::int64_t>(costs.n_unknowns);
  object["newton_steps"] = costs.n_newton_steps;
  object["krylov_steps"] = costs.n_iterations;
  object["grad_div"] = costs.grad_div;
  object["largest_linear_residual"] = costs.largest_residual;
  object["processes"] = effort.n_processes;
  object["seconds"] = effort.seconds;
  object["peak_MB"] = effort.peak_megabytes;
}

/// Whatever bytes its texts hold.
std::string line_of(const nlohmann::ordered_json& object) {
  return object.dump(-1, ' ', false, nlohmann::ordered_json::error_handler_t::replace) + '\n';
}

}  // namespace

std::string flow_json(const SimulatedFlow& flow, const Effort& effort, const RoofNote& roof) {
  nlohmann::ordered_json object = drop_of(flow);
  object["reynolds"] = flow.reynolds;
  object["x_m"] = list(flow.x);
  object["gap_m"] = list(flow.gap);
  object["wall_pressure_Pa"] = list(flow.wall_pressure);
  object["wall_pressure_numerical_uncertainty_Pa"] = list(flow.wall_pressure_uncertainty);
  object["mean_pressure_Pa"] = list(flow.mean_pressure);
  object["mean_pressure_numerical_uncertainty_Pa"] = list(flow.mean_pressure_uncertainty);
  object["coarse_mean_pressure_Pa"] = list(flow.coarse_mean_pressure);
  object["floor_pressure_Pa"] = list(flow.floor_pressure);
  object["wall_shear_Pa"] = list(flow.wall_shear);
  object["floor_shear_Pa"] = list(flow.floor_shear);
  object["roof_across"] = roof.across;
  object["roof_odd_m"] = roof.odd_part;
  object["roof_misfit"] = flow.roof_misfit;
  add_costs(flow.costs, effort, object);
  return object.dump() + '\n';
}

std::string passage_json(const PassageFlow& flow, const Effort& effort) {
  nlohmann::ordered_json object = drop_of(flow);
  add_costs(flow.costs, effort, object);
  return object.dump() + '\n';
}

std::string error_json(const InputError& error) {
  nlohmann::ordered_json object;
  object["error"] = {{"where", error.where()}, {"found", error.found()}, {"mend", error.mend()}};
  return line_of(object);
}

std::string fault_json(const std::string& text) {
  nlohmann::ordered_json object;
  object["fault"] = text;
  return line_of(object);
}

}  // namespace manoscope::navier_stokes

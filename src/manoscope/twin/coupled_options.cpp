#include "manoscope/twin/coupled_options.hpp"

#include <fmt/format.h>
#include <fmt/ranges.h>

#include <vector>

#include "manoscope/core/error.hpp"
#include "manoscope/core/suggest.hpp"

namespace manoscope::twin {
namespace {

constexpr const char* kWhere = "coupled flow";
constexpr const char* kRectangle = "rectangle";

[[noreturn]] void refuse_name(const char* option, const std::string& name,
                              const std::vector<std::string>& names) {
  throw InputError(kWhere, fmt::format("{} is \"{}\"{}", option, name, did_you_mean(name, names)),
                   fmt::format("Give one of {}", fmt::join(names, ", ")));
}

}  // namespace

std::optional<flow::FlowModel> CoupledOptions::model() const {
  if (flow_model == kRectangle) return std::nullopt;
  std::vector<std::string> names{kRectangle};
  for (const flow::FlowModelInfo& info : flow::kFlowModels) {
    if (info.name == flow_model) return info.model;
    names.emplace_back(info.name);
  }
  refuse_name("flow_model", flow_model, names);
}

flow::InletProfile CoupledOptions::inlet() const {
  if (inlet_profile == "developed") return flow::InletProfile::developed;
  if (inlet_profile == "uniform") return flow::InletProfile::uniform;
  refuse_name("inlet_profile", inlet_profile, {"developed", "uniform"});
}

void CoupledOptions::validate() const {
  if (steps < 10 || steps > 2000 || steps % 2 != 0) {
    throw InputError(kWhere, fmt::format("steps is {}", steps),
                     "Choose an even number from 10 to 2000");
  }
  if (!(momentum_factor >= 0.0 && momentum_factor <= 2.0)) {
    throw InputError(kWhere, fmt::format("momentum_factor is {:g}", momentum_factor),
                     "Choose 0 (creeping flow) or 1 (flat profile) to 2; a parabola has 1.2");
  }
  const std::optional<flow::FlowModel> chosen = model();
  if (inlet() != flow::InletProfile::developed && !(chosen && marches(*chosen))) {
    throw InputError(
        kWhere,
        fmt::format("inlet_profile is \"{}\" for flow_model = \"{}\"", inlet_profile, flow_model),
        "Leave it out, or choose a flow model that marches: plane-march, section-march");
  }
  if (!chosen) return;
  const CoupledOptions usual;
  const char* other = exact_duct != usual.exact_duct             ? "exact_duct"
                      : momentum_factor != usual.momentum_factor ? "momentum_factor"
                                                                 : nullptr;
  if (other == nullptr) return;
  throw InputError(kWhere, fmt::format("{} stands beside flow_model = \"{}\"", other, flow_model),
                   "Leave it out: it is an option of flow_model = \"rectangle\" alone");
}

}  // namespace manoscope::twin

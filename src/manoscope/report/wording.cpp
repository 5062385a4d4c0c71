#include "manoscope/report/wording.hpp"

#include <cmath>

namespace manoscope::report {

std::string resistance_uncertainty_text(const results::Measurement& m) {
  const bool viscosity = std::isgreater(m.viscosity_uncertainty, 0.0);
  bool flow_rate = false;
  for (const double uncertainty : m.flow_rate_uncertainty) {
    flow_rate = flow_rate || std::isgreater(uncertainty, 0.0);
  }
  if (viscosity && flow_rate) return "U(QR) holds gap, deflection, flow rate and viscosity.";
  if (viscosity) {
    return "U(QR) holds gap, deflection and viscosity; the flow rate counts as exact.";
  }
  if (flow_rate) {
    return "U(QR) holds gap, deflection and flow rate; the viscosity counts as exact.";
  }
  return "U(QR) holds gap and deflection; flow rate and viscosity count as exact.";
}

}  // namespace manoscope::report

#include "manoscope/flow/pressure_term.hpp"

#include <limits>

namespace manoscope::flow {

Estimate parasitic_estimate(const std::vector<PressureTerm>& terms,
                            const PassageUncertainty& uncertainty) {
  Estimate sum;
  double by_flow_rate = 0.0, by_viscosity = 0.0, by_height = 0.0;
  for (const PressureTerm& term : terms) {
    sum.value += term.drop.si();
    sum.terms.push_back(
        {"parasitic drop, " + term.formula, "parasitic drop", term.uncertainty.si()});
    by_flow_rate += term.by_flow_rate.si();
    by_viscosity += term.by_viscosity.si();
    by_height += term.height_effect.si();
  }
  sum.terms.push_back({"passage height", "parasitic drop", by_height});
  sum.terms.push_back({"flow rate", "flow rate", by_flow_rate * uncertainty.flow_rate});
  sum.terms.push_back({"viscosity", "viscosity", by_viscosity * uncertainty.viscosity});
  return sum;
}

Estimate compliant_drop(Pressure transducer, std::optional<Pressure> uncertainty,
                        const Estimate& parasitic) {
  constexpr double kUnknown = std::numeric_limits<double>::quiet_NaN();
  Estimate drop;
  drop.value = transducer.si() - parasitic.value;
  drop.terms.push_back({"transducer", "transducer", uncertainty ? uncertainty->si() : kUnknown});
  for (const Estimate::Term& term : parasitic.terms) {
    drop.terms.push_back({term.variable, term.source, -term.effect});
  }
  return drop;
}

}  // namespace manoscope::flow

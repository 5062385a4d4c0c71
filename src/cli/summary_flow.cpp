#include "summary_flow.hpp"

#include <fmt/format.h>

#include <utility>
#include <vector>

#include "text_table.hpp"

namespace manoscope::cli {
using results::Measurement;

std::string flow_findings_text(const Measurement& m, const Screen& screen) {
  if (!m.inferred_flow_rate.isFinite().any() && !m.predicted_drop.isFinite().any()) return {};
  std::vector<Column> columns{{{"run"}, Align::left},
                              {{"Q off the wall ± U [mL/min]"}, Align::point},
                              {{"dp end to end ± U [Pa]"}, Align::point, 1}};
  for (Index r = 0; r < m.flow_rate.size(); ++r) {
    const auto in_ml = [](double si) { return FlowRate::from_si(si).in(mL_per_min); };
    add_row(columns,
            {m.run[static_cast<std::size_t>(r)],
             value_text(in_ml(m.inferred_flow_rate[r]), in_ml(m.inferred_flow_rate_uncertainty[r])),
             value_text(m.predicted_drop[r], m.predicted_drop_uncertainty[r])});
  }
  return fmt::format("By the flow model {}\n{}", m.verdict_model,
                     text_table(std::move(columns), screen)) +
         wrapped(
             "Q off the wall: from the deflection alone. dp end to end: between the ends of the "
             "channel, predicted from the calibration and the set Q.",
             screen.columns);
}

}  // namespace manoscope::cli

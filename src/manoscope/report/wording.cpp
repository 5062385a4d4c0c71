#include "manoscope/report/wording.hpp"

#include <fmt/format.h>
#include <fmt/ranges.h>

#include <cmath>
#include <vector>

#include "manoscope/report/flow_verdict.hpp"

namespace manoscope::report {
namespace {

/// "a", "a and b", "a, b and c".
std::string listed(std::vector<std::string> names) {
  const std::string last = names.back();
  names.pop_back();
  return names.empty() ? last : fmt::format("{} and {}", fmt::join(names, ", "), last);
}

}  // namespace

std::string resistance_uncertainty_text(const results::Measurement& m) {
  bool flow_rate = false;
  for (const double uncertainty : m.flow_rate_uncertainty) {
    flow_rate = flow_rate || std::isgreater(uncertainty, 0.0);
  }
  std::vector<std::string> held, exact;
  const bool gap = std::isgreater(m.channel_height_uncertainty, 0.0);
  if (gap) held.emplace_back("gap");
  held.emplace_back("deflection");
  (flow_rate ? held : exact).emplace_back("flow rate");
  (std::isgreater(m.viscosity_uncertainty, 0.0) ? held : exact).emplace_back("viscosity");
  std::string text = fmt::format("U(QR) holds {}", listed(held));
  if (exact.size() == 1) text += fmt::format("; the {} counts as exact", exact.front());
  if (exact.size() > 1) text += fmt::format("; {} count as exact", listed(exact));
  if (!gap) {
    text +=
        "; it leaves out the gap, whose uncertainty is not stated: no verdict without "
        "channel.height_uncertainty";
  }
  return text + '.';
}

const char* resistance_word(double en_number) {
  if (!std::isfinite(en_number)) return "no verdict";
  return en_number <= 1.0 ? "within U" : "beyond U";
}

std::string broken_marches_text(const results::Measurement& m) {
  std::vector<std::string> names;
  for (std::size_t i = 0; i < m.run.size(); ++i) {
    if (march_broke_down(m, static_cast<Index>(i))) names.push_back(m.run[i]);
  }
  if (names.empty()) return {};
  return fmt::format(" The section march broke down in {}: no total of all effects there.",
                     listed(names));
}

}  // namespace manoscope::report

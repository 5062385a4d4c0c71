#include "manoscope/report/advice.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <array>
#include <cmath>
#include <string_view>
#include <utility>
#include <vector>

namespace manoscope::report {
namespace {

using results::Measurement;

double median(std::vector<double> values) {
  const auto middle = values.begin() + static_cast<Index>(values.size() / 2);
  std::nth_element(values.begin(), middle, values.end());
  return *middle;
}

double shrink_of(double share) { return 1.0 - std::sqrt(std::max(0.0, 1.0 - 0.75 * share)); }

/// Of sources with these shares (one list a source), the one with the largest median.
std::optional<Advice> largest(const std::vector<std::string>& sources,
                              const std::vector<std::vector<double>>& shares) {
  std::optional<Advice> advice;
  for (std::size_t s = 0; s < sources.size(); ++s) {
    if (shares[s].empty()) continue;
    const double share = median(shares[s]);
    if (advice && share <= advice->share) continue;
    advice = Advice{sources[s], share, shrink_of(share), hint_for(sources[s])};
  }
  return advice;
}

/// Share of a source in the variance of p at the median station of one run; NaN: no station.
double share_in_run(const Measurement& m, std::size_t source, Index run) {
  std::vector<double> shares;
  for (Index ix = 0; ix < m.x.size(); ++ix) {
    const double total = std::pow(m.pressure_uncertainty(run, ix), 2);
    const bool inside = std::isgreaterequal(m.x[ix], m.test_section(run, 0)) &&
                        std::islessequal(m.x[ix], m.test_section(run, 1));
    if (!inside || !std::isgreater(total, 0.0)) continue;
    shares.push_back(m.pressure_variance[source](run, ix) / total);
  }
  return shares.empty() ? std::nan("") : median(shares);
}

std::string percent(double fraction) { return fmt::format("{:.0f} %", 100.0 * fraction); }

std::string sentence(const Advice& advice, const char* of, const char* bars) {
  return fmt::format("{}, {} of the variance of {}; halved, {} shrink by {}: {}", advice.source,
                     percent(advice.share), of, bars, percent(advice.shrink), advice.hint);
}

}  // namespace

std::string hint_for(const std::string& source) {
  static constexpr std::array<std::pair<std::string_view, const char*>, 12> kHints{{
      {"pressure labels", "a better gauge, repeats or more levels"},
      {"gauge gain", "have the gauge calibrated against a better one"},
      {"gauge zero", "zero the gauge before every series, and vent one level to air"},
      {"pixel noise", "average several maps of each state, or take more pixels"},
      {"leveling", "show more of the rigid rim around the wall"},
      {"registration",
       "texture or marks on the rigid frame, more of it in view, or finer pixels along the flow"},
      {"interpolation", "more levels where the curves bend"},
      {"end effect", "state wall.thickness and leave --nonlocal on, or keep farther from the ends"},
      {"wall model", "measure the wall's thickness, length and width and state them"},
      {"smoothness",
       "less noise or more pixels; where the finest ripple is in force, a lower --finest-ripple"},
      {"quadrature", "more pixels across the width"},
      {"instability", "wait longer before each map, or average several"},
  }};
  for (const auto& [name, hint] : kHints) {
    if (name == source) return hint;
  }
  return "see docs/method.md on where it comes from";
}

std::optional<Advice> advice_on_pressure(const Measurement& m) {
  std::vector<std::vector<double>> shares(m.budget_source.size());
  for (std::size_t s = 0; s < m.budget_source.size(); ++s) {
    for (Index run = 0; run < m.flow_rate.size(); ++run) {
      const double share = share_in_run(m, s, run);
      if (std::isfinite(share)) shares[s].push_back(share);
    }
  }
  return largest(m.budget_source, shares);
}

std::optional<Advice> advice_on_drop(const Measurement& m) {
  std::vector<std::vector<double>> shares(m.budget_source.size());
  for (Index run = 0; run < m.extracted_drop_variance.cols(); ++run) {
    const double total = m.extracted_drop_variance.col(run).sum();
    if (!std::isgreater(total, 0.0)) continue;
    for (Index s = 0; s < m.extracted_drop_variance.rows(); ++s) {
      shares[static_cast<std::size_t>(s)].push_back(m.extracted_drop_variance(s, run) / total);
    }
  }
  return largest(m.budget_source, shares);
}

std::string advice_text(const Measurement& m) {
  const auto pressure = advice_on_pressure(m), drop = advice_on_drop(m);
  if (!pressure) return {};
  if (drop && drop->source == pressure->source) {
    return fmt::format(
        "Improve first: {}, {} of the variance of p(x) and {} of that of dp_e; halved, their bars "
        "shrink by {} and {}: {}.",
        pressure->source, percent(pressure->share), percent(drop->share), percent(pressure->shrink),
        percent(drop->shrink), pressure->hint);
  }
  std::string text = "Improve first: " + sentence(*pressure, "p(x)", "its bars") + ".";
  if (drop) text += "\nFor the drop: " + sentence(*drop, "dp_e", "its bars") + ".";
  return text;
}

}  // namespace manoscope::report

#include "manoscope/report/figure_data.hpp"

#include <algorithm>
#include <cmath>

namespace manoscope::report {

double largest_magnitude(const Array2& values) {
  double largest = 0.0;
  for (Index i = 0; i < values.size(); ++i) {
    const double value = values.data()[i];
    if (std::isfinite(value)) largest = std::max(largest, std::abs(value));
  }
  return largest;
}

double largest_magnitude(const Array1& values) {
  return largest_magnitude(Array2(values.transpose()));
}

double share_of(double part, double whole) { return whole == 0.0 ? std::nan("") : part / whole; }

std::vector<Index> runs_by_flow_rate(const results::Measurement& m) {
  std::vector<Index> runs;
  for (Index run = 0; run < m.flow_rate.size(); ++run) {
    if (std::isfinite(m.flow_rate(run))) runs.push_back(run);
  }
  std::stable_sort(runs.begin(), runs.end(),
                   [&](Index a, Index b) { return m.flow_rate(a) < m.flow_rate(b); });
  return runs;
}

std::vector<Index> spread(const std::vector<Index>& indices, std::size_t most) {
  if (indices.size() <= most) return indices;
  std::vector<Index> chosen;
  for (std::size_t i = 0; i < most; ++i) {
    chosen.push_back(indices[i * (indices.size() - 1) / (most - 1)]);
  }
  return chosen;
}

Array1 at(const Array1& values, const std::vector<Index>& indices) {
  return Array1::NullaryExpr(static_cast<Index>(indices.size()),
                             [&](Index i) { return values(indices[static_cast<std::size_t>(i)]); });
}

ReportUnits report_units(const results::Measurement& m) {
  const double drops =
      std::max({largest_magnitude(m.extracted_drop), largest_magnitude(m.resistance_drop),
                largest_magnitude(m.transducer_drop)});
  return {
      length_unit(m.channel_length), length_unit(largest_magnitude(m.static_deflection)),
      pressure_unit(std::max(largest_magnitude(m.level_pressure), largest_magnitude(m.pressure))),
      pressure_unit(drops), flow_rate_unit(largest_magnitude(m.flow_rate))};
}

std::string flow_rate_label(const results::Measurement& m, Index run, const ReportUnits& units) {
  return short_number_text(m.flow_rate(run) / units.flow_rate.si) + " " + units.flow_rate.name;
}

std::string common_settings() {
  return "set encoding utf8\n"
         "set border lw 1.2\n"
         "set xtics in mirror scale 0.8\nset ytics in mirror scale 0.8\nunset x2tics\nunset "
         "y2tics\nset minussign\n"
         "set style textbox opaque noborder fillcolor '#ffffff' margins 0.3,0.1\n"
         "set key outside above center horizontal Left reverse samplen 2.5 width 1\n"
         "set bars 0.6\n";
}

}  // namespace manoscope::report

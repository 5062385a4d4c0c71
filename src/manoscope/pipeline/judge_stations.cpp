#include "manoscope/pipeline/judge_stations.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <iterator>
#include <limits>
#include <utility>

#include "manoscope/core/error.hpp"
#include "manoscope/pipeline/judged_stretch.hpp"

namespace manoscope::pipeline {
namespace {

constexpr double kNan = std::numeric_limits<double>::quiet_NaN();

/// Values where `counts`, NaN elsewhere; all NaN if there are no values.
Array1 masked(const Array1& values, const Flags1& counts) {
  Array1 result = Array1::Constant(counts.size(), kNan);
  if (values.size() == 0) return result;
  for (Index i = 0; i < counts.size(); ++i) {
    if (counts[i] != 0) result[i] = values[i];
  }
  return result;
}

void add_split(const validation::ErrorSplit* split, Index n, RunStations& stations) {
  const validation::ErrorSplit none{Flags1::Zero(n), {}, {}, {}, {}, {}, {}};
  const validation::ErrorSplit& parts = split != nullptr ? *split : none;
  const auto add = [&](const char* name, const Array1& values) {
    stations.columns.push_back({name, masked(values, parts.split)});
  };
  add("neighbourhood_Pa", parts.neighbourhood);
  add("label_error_Pa", parts.labels);
  add("map_error_Pa", parts.maps);
  add("curve_shape_error_Pa", parts.curve_shape);
  add("locality_error_Pa", parts.locality);
  add("curve_shape_and_locality_error_Pa", parts.curve_shape_and_locality);
}

}  // namespace

const Array1& RunStations::column(std::string_view name) const {
  const auto found =
      std::find_if(columns.begin(), columns.end(),
                   [&](const StationColumn& candidate) { return candidate.name == name; });
  MANO_ASSERT(found != columns.end());
  return found->values;
}

std::vector<RunStations> judge_stations(const results::Measurement& m, const twin::Truth& truth,
                                        const SplitJudgement& split, std::optional<Length> start,
                                        std::optional<Length> end) {
  std::vector<RunStations> runs;
  const Index n = m.x.size();
  for (Index r = 0; r < m.flow_rate.size(); ++r) {
    const auto place = static_cast<std::size_t>(r);
    const twin::RunTruth& run = find_truth(truth, m.run[place]);
    const Array1 expected = interpolate(truth.x, run.pressure, m.x);
    const Array1 true_deflection = interpolate(truth.x, run.deflection, m.x);
    const Array1 error = m.pressure.row(r).transpose() - expected;
    const Array1 sigma = m.pressure_uncertainty.row(r);
    const auto [x_start, x_end] = judged_stretch(m, r, start, end);
    Array1 pull = Array1::Constant(n, kNan), covered = Array1::Constant(n, kNan);
    for (Index i = 0; i < n; ++i) {
      if (!std::isfinite(error[i])) continue;
      if (std::isgreater(sigma[i], 0.0)) pull[i] = error[i] / sigma[i];
      covered[i] = std::isgreaterequal(expected[i], m.pressure_lower(r, i)) &&
                           std::islessequal(expected[i], m.pressure_upper(r, i))
                       ? 1.0
                       : 0.0;
    }
    RunStations stations{run.run, {}};
    const auto add = [&](const char* name, const Array1& values) {
      stations.columns.push_back({name, values});
    };
    add("x_m", m.x);
    add("in_section", within(m.x, x_start, x_end).cast<double>());
    add("pressure_Pa", m.pressure.row(r));
    add("true_pressure_Pa", expected);
    add("error_Pa", error);
    add("uncertainty_Pa", sigma);
    add("pull", pull);
    add("covered", covered);
    add("deflection_m", m.deflection.row(r));
    add("true_deflection_m", true_deflection);
    add("deflection_error_m", m.deflection.row(r).transpose() - true_deflection);
    add("deflection_uncertainty_m", m.deflection_uncertainty.row(r));
    add_split(split.runs.empty() ? nullptr : &split.runs[place].stations, n, stations);
    runs.push_back(std::move(stations));
  }
  return runs;
}

std::string csv_text(const std::string& text) {
  if (text.find_first_of(",\"\r\n") == std::string::npos) return text;
  std::string quoted = "\"";
  for (const char letter : text) {
    if (letter == '"') quoted += '"';
    quoted += letter;
  }
  return quoted + '"';
}

std::string station_table(const std::vector<RunStations>& runs) {
  std::string text = "run";
  if (!runs.empty()) {
    for (const StationColumn& column : runs.front().columns) text += "," + column.name;
  }
  text += '\n';
  for (const RunStations& run : runs) {
    const std::string name = csv_text(run.run);
    for (Index i = 0; i < run.columns.front().values.size(); ++i) {
      text += name;
      for (const StationColumn& column : run.columns) {
        text += ',';
        const double value = column.values[i];
        if (std::isfinite(value)) fmt::format_to(std::back_inserter(text), "{:.9g}", value);
      }
      text += '\n';
    }
  }
  return text;
}

}  // namespace manoscope::pipeline

#pragma once

#include <optional>
#include <string>
#include <string_view>
#include <vector>

#include "manoscope/core/units.hpp"
#include "manoscope/pipeline/split_errors.hpp"
#include "manoscope/results/measurement.hpp"
#include "manoscope/twin/truth.hpp"

namespace manoscope::pipeline {

/// One quantity at every station of a run; its name ends in its unit. NaN: no number.
struct StationColumn {
  std::string name;
  Array1 values;
};

/// One run held against its truth, station by station.
///
/// Columns: x_m, in_section, pressure_Pa, true_pressure_Pa, error_Pa, uncertainty_Pa, pull,
/// covered, deflection_m, true_deflection_m, deflection_error_m, deflection_uncertainty_m; then the
/// error by its origin: neighbourhood_Pa, label_error_Pa, map_error_Pa, curve_shape_error_Pa,
/// locality_error_Pa, curve_shape_and_locality_error_Pa (ErrorSplit). All stations; in_section is 1
/// where judge() counts. The columns are always there.
struct RunStations {
  std::string run;
  std::vector<StationColumn> columns;

  /// Values of the column of that name, which must exist.
  const Array1& column(std::string_view name) const;
};

/// @param split  of split_errors() with the same arguments.
/// @throws InputError if the truth lacks a run of the result.
std::vector<RunStations> judge_stations(const results::Measurement& measurement,
                                        const twin::Truth& truth, const SplitJudgement& split,
                                        std::optional<Length> start = {},
                                        std::optional<Length> end = {});

/// A cell of a CSV table: in quotes where it holds a comma, quote or line end.
std::string csv_text(const std::string& text);

/// The same as CSV, the run in front. Cells without a number are empty; nine digits.
std::string station_table(const std::vector<RunStations>& runs);

}  // namespace manoscope::pipeline

#pragma once

#include <string>
#include <string_view>

#include "manoscope/results/measurement.hpp"

namespace manoscope::results {

/// pressure.csv: one row a run and station.
///
/// Columns: run, flow_rate_m3_s, x_m, pressure_Pa, pressure_uncertainty_Pa (standard, k = 1),
/// pressure_lower_Pa, pressure_upper_Pa, deflection_m, flags. SI, '.' as decimal mark, the shortest
/// digits that read back to the same float64. A number that does not exist is an empty cell (NaN to
/// pandas and MATLAB's readtable). `flags` holds the names of the reading flags joined by '|',
/// empty where the reading is good. Text is quoted as in RFC 4180 where it must be; lines end in
/// LF.
std::string pressure_table(const Measurement& measurement);

/// drops.csv: one row a run.
///
/// Columns: run, flow_rate_m3_s, reynolds, x_start_m, x_end_m, extracted_drop_Pa,
/// extracted_drop_uncertainty_Pa, resistance_drop_Pa, resistance_drop_uncertainty_Pa,
/// transducer_drop_Pa, parasitic_drop_Pa, en_number; behind them what the flow says of the run:
/// drops of the channel as measured and as predicted, the flow rate off the wall, friction, what
/// each effect adds to the drop, and drop, E_n and p value by each flow model; at last the verdict
/// in words. Conventions as in pressure_table().
std::string drops_table(const Measurement& measurement);

/// A cell as these tables have it.
std::string csv_cell(double value);
std::string csv_cell(std::string_view text);

/// Names of the bits, joined by '|'; "" for 0. A bit without a name reads "bit_7".
std::string flag_names(FlagBits bits);

}  // namespace manoscope::results

#pragma once

#include <string>
#include <string_view>
#include <variant>
#include <vector>

#include "manoscope/results/measurement.hpp"

namespace manoscope::results {

/// A dimension of the result file.
struct Dimension {
  std::string_view name;
  Index (*length)(const Measurement&);
  std::string_view meaning;
};

/// Where a variable lives in a Measurement.
using Member =
    std::variant<double Measurement::*, Array1 Measurement::*, Array2 Measurement::*,
                 Flags2 Measurement::*, std::vector<Matrix> Measurement::*,
                 std::vector<Array2> Measurement::*, std::vector<std::string> Measurement::*,
                 std::vector<int> Measurement::*>;

/// A variable of the result file: its name, shape, unit, meaning, and the member that holds it.
///
/// Numbers are float64, except bits (uint8) and indices (int32); names are strings.
struct Variable {
  std::string_view name;
  std::vector<std::string_view> dimensions;  ///< names, slowest first; empty = one number
  std::string_view units;                    ///< as udunits-2 writes them; "1" for pure numbers
  std::string_view long_name;
  Member member;
  std::string_view ancillary_variables = {};  ///< names, blank-separated
  std::string_view standard_name = {};        ///< where the CF table has one
};

/// A text of the result file as a whole.
struct GlobalText {
  std::string_view name;
  std::string Measurement::*member;
  std::string_view meaning;
};

/// The one list of dimensions, variables and texts of result.nc: writer, reader and manual use it.
const std::vector<Dimension>& dimensions();
const std::vector<Variable>& variables();
const std::vector<GlobalText>& global_texts();

/// The dimension of that name, which must exist.
const Dimension& dimension(std::string_view name);

/// Checks that every member has the shape its dimensions say.
/// @throws InternalError naming the first variable that has not: whoever filled it is at fault.
void check_shapes(const Measurement& measurement);

/// The schema as a Markdown table: one line a variable, for the manual.
std::string schema_as_markdown();

}  // namespace manoscope::results

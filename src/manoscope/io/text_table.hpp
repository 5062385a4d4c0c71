#pragma once

#include <string>

#include "manoscope/io/reader.hpp"
#include "manoscope/io/text_matrix.hpp"

namespace manoscope::io {

/// The map or profile that a table of two or three columns holds.
///
/// Three columns are x, y and value of points on an even grid, in any order; row 0 of the map has
/// the smallest y. Two columns are x and value of an evenly spaced profile, a map of one row. A
/// column that counts the rows (without a name, or "index") is passed over. Units come from the
/// columns' names
/// ("x in um", "X_(microns)", "Height [nm]", "Lateral um"), else from the header, else from
/// options.lateral_unit for the positions.
/// @throws InputError(where, ...) if there are more or fewer columns or the points are not even.
Channel channel_of_table(const TextMatrix& matrix, const ReadOptions& options,
                         const std::string& where);

/// The unit in the name of a column; "" if there is none.
std::string unit_of_label(std::string_view label);

}  // namespace manoscope::io

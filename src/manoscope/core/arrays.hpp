#pragma once

#include <Eigen/Core>
#include <cstdint>

#include "manoscope/core/index.hpp"

namespace manoscope {

/// One value per station; plain SI doubles, the unit is in the docs of whoever holds it.
using Array1 = Eigen::ArrayXd;

/// Row-major (n_rows, n_columns): a row is contiguous and runs along x.
using Array2 = Eigen::Array<double, Eigen::Dynamic, Eigen::Dynamic, Eigen::RowMajor>;

/// Bits per station or pixel; 0 = good. The bits are named in flags.hpp.
using FlagBits = std::uint8_t;
using Flags1 = Eigen::Array<FlagBits, Eigen::Dynamic, 1>;
using Flags2 = Eigen::Array<FlagBits, Eigen::Dynamic, Eigen::Dynamic, Eigen::RowMajor>;

using Matrix = Eigen::MatrixXd;

}  // namespace manoscope

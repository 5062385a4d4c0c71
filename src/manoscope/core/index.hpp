#pragma once

#include <cstddef>

namespace manoscope {

/// Signed index and count type of every array (equals Eigen::Index).
using Index = std::ptrdiff_t;

}  // namespace manoscope

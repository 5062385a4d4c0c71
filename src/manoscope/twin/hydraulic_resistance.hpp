#pragma once

#include "manoscope/core/units.hpp"

namespace manoscope {

using HydraulicResistance = Quantity<1, -4, -1>;  ///< pressure drop per flow rate

template <>
struct UnitOf<HydraulicResistance> {
  static constexpr const char* name = "Pa s m-3";
  static constexpr const char* kind = "hydraulic resistance";
  static constexpr const char* example = "3.1 Pa/(mL/min)";
};

}  // namespace manoscope

#pragma once

#include "manoscope/flow/passage_losses.hpp"

namespace manoscope {

template <>
struct UnitOf<flow::Area> {
  static constexpr const char* name = "m2";
  static constexpr const char* kind = "cross-section";
  static constexpr const char* example = "4 mm2";
};

}  // namespace manoscope

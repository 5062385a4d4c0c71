#pragma once

#include "manoscope/core/arrays.hpp"
#include "manoscope/inversion/nonlocal_wall.hpp"

namespace manoscope::inversion {

/// Pressures of the measured curves and those of the model at which the wall deflects alike
/// (NonlocalWall::offset): straight lines between the levels, shifted alike beyond them. Where the
/// offsets would turn the order of levels both are the same.
class ModelScale {
 public:
  explicit ModelScale(const NonlocalWall& wall);

  double to_model(double pressure) const;    ///< Pa
  double from_model(double pressure) const;  ///< Pa
  /// Half of what the offset changes over the step between levels around a pressure, Pa.
  double doubt(double pressure) const;

 private:
  Array1 own_, model_;
};

}  // namespace manoscope::inversion

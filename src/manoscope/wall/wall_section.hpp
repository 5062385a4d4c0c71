#pragma once

#include <string>

#include "manoscope/core/units.hpp"

namespace manoscope::wall {

/// A uniform elastic wall as its laws see it: one width between clamped edges, one thickness, one
/// material.
struct WallSection {
  Length width{};      ///< w, between the clamped edges; side of a square, diameter of a disc
  Length thickness{};  ///< t
  Pressure youngs_modulus{};      ///< E
  double poisson_ratio = 0.0;     ///< nu, in (-1, 0.5]
  Pressure prestress{};           ///< s0, in-plane, isotropic; tension positive, either sign
  double shear_correction = 0.0;  ///< kappa, e.g. 5/6; 0 = rigid in shear (thin wall)

  /// @throws InputError at `where` naming the first property out of range.
  void validate(const std::string& where) const;
  /// validate(), and prestress >= 0: for laws of walls without bending stiffness.
  /// @throws InputError likewise.
  void validate_tension(const std::string& where) const;

  /// Half the width a, m (the radius of a disc).
  double half_width() const { return 0.5 * width.si(); }
  /// E/(1 - nu^2), Pa: modulus of a strip that cannot contract along its length.
  double plane_strain_modulus() const;
  /// Bending stiffness D = E t^3/(12 (1 - nu^2)), N m.
  double bending_stiffness() const;
  /// Transverse shear stiffness kappa G t, N/m, G = E/(2 (1 + nu)); infinite for kappa = 0.
  double shear_stiffness() const;
};

}  // namespace manoscope::wall

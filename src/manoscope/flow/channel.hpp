#pragma once

#include <string>

#include "manoscope/core/units.hpp"

namespace manoscope::flow {

/// The compliant section of a micro-channel: x in [0, length] along the flow, z across.
///
/// The gap at x is height + zeta(x): `height` is the paper's 2 h0, the distance of the rigid floor
/// from the plane of the undeflected wall.
struct Channel {
  Length length{};
  Length width{};
  Length height{};

  /// @throws InputError at `where` naming the first size that is not positive and finite.
  void validate(const std::string& where) const;
  friend bool operator==(const Channel&, const Channel&) = default;
};

/// An incompressible Newtonian fluid.
struct Fluid {
  Viscosity viscosity{};  ///< dynamic, eta
  Density density{};      ///< rho

  KinematicViscosity kinematic_viscosity() const { return viscosity / density; }
  /// @throws InputError at `where` naming the first property that is not positive and finite.
  void validate(const std::string& where) const;
  friend bool operator==(const Fluid&, const Fluid&) = default;
};

}  // namespace manoscope::flow

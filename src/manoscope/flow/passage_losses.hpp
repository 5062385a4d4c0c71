#pragma once

#include <optional>
#include <vector>

#include "manoscope/core/units.hpp"
#include "manoscope/flow/channel.hpp"
#include "manoscope/flow/parasitic.hpp"
#include "manoscope/flow/pressure_term.hpp"

namespace manoscope::flow {

using Area = Quantity<0, 2, 0>;

/// What stands at the ends of a rigid passage and in it.
struct PassageFittings {
  /// Section that the flow comes from, through a sudden contraction; unset: no step, developed
  /// flow.
  std::optional<Area> from;
  bool from_reservoir = false;  ///< from a section without bound, instead of `from`
  std::optional<Area> into;     ///< section that it goes to, through a sudden expansion
  bool into_reservoir = false;
  int round_bends = 0;  ///< 90 degrees, centre radius about one hydraulic diameter
  int mitre_bends = 0;  ///< 90 degrees, sharp corner
};

/// Pressure drop of a rigid passage, part by part. U = Q/A, Re = U Dh/nu, sigma = small/large area.
///
///   duct         passage_drop(): exact
///   contraction  rho U^2/2 (1 - sigma^2): gain of kinetic energy without loss, to a flat profile
///   development  rho U^2/2 K(x+) (1 - sigma): entry_excess(), after a contraction or reservoir
///   expansion    -rho U^2 sigma (beta_1 - beta_2 sigma): the pressure that a sudden widening gives
///                back, beta of developed flow
///   steps        aperture_loss() (1 - sigma) for each: the creeping flow towards and from an end
///   bends        rho U^2/2 (K_1/Re + K_inf): 800, 0.25 (round); 1000, 1.15 (mitre)
///
/// Sources: development R. K. Shah, J. Fluids Eng. 100 (1978) 177. Contraction and expansion by the
/// balances of energy and momentum that W. M. Kays, Trans. ASME 72 (1950) 1067, tabulates; he adds
/// the loss behind the edge, up to 0.1 rho U^2/2 in laminar flow. Steps: Roscoe (1949) for a hole
/// in a thin plate; that the losses of such a hole and the friction of what lies behind it add up
/// is H. L. Weissberg, Phys. Fluids 5 (1962) 1033. The weight 1 - sigma is ours: full loss for
/// sigma = 0, none where there is no step, straight between. Bends: W. B. Hooper, Chem. Eng. 88
/// (1981) 96, elbows flanged with R/D = 1 and mitred with one weld, without his term in the pipe's
/// diameter in inches, which is not meant for these sizes.
///
/// Standard uncertainties (half widths, each / sqrt 3; independent ones in quadrature):
///   contraction  0.1 rho U^2/2 (1 - sigma), the loss behind the edge
///   development  10 % of it, and sigma of it for the weight: from (1 - sigma)^2 to 1 - sigma^2
///   expansion    30 % of it, for at low Re less is given back
///   steps        5.5 % of it for the shape; 30 %, for the end of a duct is no hole between two
///                half-spaces: its floor may go on, and inertia bends the flow; sigma of it for the
///                weight, as above
///   bends        all of it (from nothing to twice): measured on pipes above Re = 10, while a bend
///                in creeping flow costs less than its own length
/// Each is one error wherever its formula is used (PressureTerm::formula).
///
/// Flow rate and viscosity: every part is rho Q^2 g(nu/Q) at fixed sizes, so that Q d/dQ is twice
/// the drop less eta d/d(eta). RigidPassage::height_uncertainty acts on every part (-3 dh/h of the
/// duct, -2 dh/h of what goes with rho U^2/2), by a difference of the formulas.
/// Validity: laminar, one step or bend not felt by the next. A three-dimensional simulation is
/// better where one is there (simulated_drop()).
///
/// @throws InputError if a size, the fluid or the flow rate is not positive, an area is smaller
///         than the passage's, a number of bends is negative or the height's uncertainty is not in
///         [0, height).
std::vector<PressureTerm> passage_terms(const Fluid& fluid, FlowRate flow_rate,
                                        const RigidPassage& passage,
                                        const PassageFittings& fittings);

}  // namespace manoscope::flow

#pragma once

#include <optional>
#include <string>
#include <vector>

#include "manoscope/inversion/read_pressure.hpp"
#include "manoscope/inversion/test_section.hpp"
#include "manoscope/validation/compare_models.hpp"
#include "manoscope/validation/predict_flow.hpp"
#include "manoscope/validation/smooth_shape.hpp"

namespace manoscope::validation {

/// Pressure that a Navier-Stokes solver found below a measured wall, mean over the section, 0 at
/// the channel's end. Arrays are (n) on ascending stations from x = 0 to the end.
struct SolvedPressure {
  Array1 x;         ///< m
  Array1 pressure;  ///< Pa
  Array1 mesh;      ///< Pa, what one standard deviation of the numerical error does, signed
  /// Pa, what one standard deviation of the profile at the inlet does, signed; 0 where it counts as
  /// known.
  Array1 inlet;
  bool plane = true;  ///< solved between plates: no side walls, and a roof that is flat across
  /// Pa, what one standard deviation of the roof across does (RoofEffect); empty: nothing.
  Array1 roof_across = {};
};

/// Where the uncertainty of a simulated pressure comes from, in this order.
inline constexpr const char* kSimulationErrors[] = {
    "numerical",     "deflection",      "channel height", "viscosity",  "flow rate",
    "inlet profile", "outlet pressure", "side walls",     "roof across"};

/// A simulated pressure with its uncertainty, and the reading that it is held against.
struct SimulationComparison {
  struct Variant {
    std::string name;                         ///< "as solved", "side walls added"
    Array1 pressure;                          ///< (n) Pa, gauge
    Uncertainty uncertainty;                  ///< (n) modes; sources are those of kSimulationErrors
    std::optional<ModelAgreement> agreement;  ///< needs a test section with a reading
  };
  /// As solved; of a plane solution a second one, side walls and curved roof added.
  std::vector<Variant> variants;
  std::optional<Estimate> extracted;  ///< Pa, dp_e of the reading over the test section
};

/// Uncertainty of a simulated p(x), and its comparison with the reading of the same run.
///
/// Deflection, gap, viscosity and flow rate move the pressure as they move that of the plane march
/// with side walls along the same wall (flow_sensitivity()), scaled by the ratio of both drops: one
/// Navier-Stokes solution a parameter would cost minutes for a few percent of an error bar. Mesh
/// and inlet profile are the solver's own. Errors that the reading shares (noise, plane and
/// position of the map under flow) count once in the difference, and the inlet profile only where
/// it moves the drop towards the reading. The rule of the verdict is judge()'s.
///
/// Between plates there are no side walls, and the roof is flat across. What both add is given
/// beside the solution as it is:
///
///   p_sides(x) = Q int_x^l (r - 12 eta/(w h^3)) dx'
///
/// r the resistance of the true section (CrossSection), h the mean gap. Inertia is left as in the
/// plane, for which side_wall_error() stands.
///
/// @param setup    inlet and its spread are not used.
/// @param state    profile of the run, as it was read; shape was made of it.
/// @param section  of the reading; none: no comparison.
/// @throws InputError as flow_sensitivity().
SimulationComparison compare_simulation(const FlowSetup& setup, FlowRate flow_rate,
                                        const SmoothShape& shape, const Profile& state,
                                        const SolvedPressure& solved, const Outlet& outlet,
                                        const inversion::PressureReading& reading,
                                        const std::optional<inversion::TestSection>& section,
                                        const CompareModelsOptions& options = {});

/// (n) What side walls and curved roof add to a plane pressure at x: p_sides() of
/// compare_simulation(), Pa, 0 at the end.
Array1 side_wall_pressure(const FlowSetup& setup, FlowRate flow_rate, const Array1& x,
                          const Array1& zeta);

/// Standard uncertainty of side_wall_pressure(), as a share of it: 3 % times Re h/l, at least 0.5 %
/// and at most 15 %.
///
/// In creeping flow the sum is that of the section. With inertia, plane marches plus side walls
/// were off the march on sections along the same wall by up to 7 % of what was added in S1 (33 um
/// of mean bulge, Re h/l 0.6 to 8.7), 14 % in S4 (20 and 60 um, 1.9 to 8.8) and 14 % in S5 (20 and
/// 40 um, 1.2 to 5.7): 12 of 14 flows within one of these uncertainties, all within two (test).
/// Where a wall bulges by half the gap, its curvature takes off what side walls
/// add, and a share of the sum says too little.
double side_wall_error(const FlowSetup& setup, FlowRate flow_rate, const Array1& zeta);

}  // namespace manoscope::validation

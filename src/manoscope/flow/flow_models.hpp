#pragma once

#include <array>
#include <optional>
#include <string>
#include <string_view>

#include "manoscope/core/arrays.hpp"
#include "manoscope/core/units.hpp"
#include "manoscope/flow/channel.hpp"
#include "manoscope/flow/marching.hpp"
#include "manoscope/flow/roof.hpp"
#include "manoscope/flow/section_family.hpp"

namespace manoscope::flow {

/// Models of the pressure along a channel whose wall stands still in a measured shape.
enum class FlowModel {
  paper,          ///< creeping, rectangle of the mean gap, eq. (4)
  creeping,       ///< creeping, true section
  momentum,       ///< + momentum integral with beta of the true section
  energy,         ///< + kinetic energy with alpha of the true section
  developing,     ///< momentum + entry by Shah & London, from a uniform profile
  plane_march,    ///< boundary-layer march in the plane, side walls by viscosity / F
  section_march,  ///< parabolised march on the whole section
};

/// What a model is, in words for a person.
struct FlowModelInfo {
  FlowModel model;
  std::string_view name;      ///< as in files and on the command line
  std::string_view formula;   ///< what is solved
  std::string_view validity;  ///< where it holds, with errors found
  bool needs_forward_flow;    ///< flow rate > 0 only
};

/// Every model, in the order of FlowModel. Errors are of p along x, in % of the largest, on the 2-D
/// and 3-D Navier-Stokes reference flows of a bulged channel at 5 / 70 mL/min (Re h/l = 0.6 / 8).
inline constexpr std::array<FlowModelInfo, 7> kFlowModels{{
    {FlowModel::paper, "paper", "dp/dx = -12 eta Q / (w h^3 (1 - 0.63 h/w)), h the mean gap",
     "creeping flow, flat roof: Re h/l << 1; off by 1.7 / 10.5 % in 3-D, where errors cancel in "
     "the "
     "drop",
     false},
    {FlowModel::creeping, "creeping", "dp/dx = -r Q, r of the Poisson problem of each section",
     "creeping flow: Re h/l << 1; off by 1.2 / 12.4 % in 3-D", false},
    {FlowModel::momentum, "momentum", "A dp/dx = -A r Q - d(beta rho Q^2/A)/dx",
     "profiles as in developed flow: Re h/l < 1; off by 0.3 / 5.5 % in 3-D", false},
    {FlowModel::energy, "energy", "d(p + alpha rho Q^2/(2 A^2))/dx = -r Q",
     "profiles as in developed flow: Re h/l < 1; off by 0.06 / 8.6 % in 3-D", false},
    {FlowModel::developing, "developing",
     "momentum, and rho U^2/2 dK(x+) of Shah & London for a profile that starts uniform",
     "flow that begins to develop at a sharp inlet, section nearly constant; the correlation is "
     "within 2.4 %",
     true},
    {FlowModel::plane_march, "plane-march",
     "u u_x + v u_y = -p'/rho + nu/F u_yy, marched along x with the gap",
     "slender, attached flow; off by 0.015 / 0.3 % in 2-D, 0.07 / 0.6 % in 3-D", true},
    {FlowModel::section_march, "section-march",
     "u u_x + v u_y + w u_z = -(P' + p2_x)/rho + nu (u_yy + u_zz), marched along x on the section",
     "slender, attached flow, the same roof on both sides; off by 0.015 / 0.2 % in 3-D", true},
}};

/// Facts about a model.
const FlowModelInfo& flow_model_info(FlowModel model);
/// Model of a name in kFlowModels.
/// @throws InputError with a "did you mean".
FlowModel flow_model(std::string_view name);

/// A channel with fluid, flow and the shape of its wall.
struct FlowCase {
  Channel channel;
  Fluid fluid;
  FlowRate flow_rate{};
  Array1 x;                                      ///< (n) stations, m, ascending up to the outlet
  Array1 zeta;                                   ///< (n) width-averaged deflection, m
  WallShape shape = WallShape::parabola();       ///< across the channel, the same at every station
  InletProfile inlet = InletProfile::developed;  ///< of the marches at the first station
  Length
      developing_length{};  ///< developing: duct between the uniform profile and the first station
  Pressure outlet_pressure{};  ///< at x = length
};

/// What a model says.
struct ModelledPressure {
  FlowModel model = FlowModel::paper;
  Array1 pressure;  ///< (n) Pa, on the wall: the mean over the width where the model knows it
  Flags1 flags;     ///< (n) bits of MarchFlag; 0 of models that do not march
  std::optional<Index> first_separated;
};

/// Pressure along the channel by one of the models: the one interface of all.
///
/// Second order in the spacing of the stations. Between the last station and the outlet, at most
/// one spacing, the pressure falls by friction alone (as one_dimensional_pressure() has it).
/// Accuracy and validity: kFlowModels, held by tests.
///
/// @throws InputError if shapes differ, stations do not reach the outlet, a gap is not positive, or
///         the flow runs backward through a model that marches.
ModelledPressure pressure_along(FlowModel model, const FlowCase& flow);

/// The same with the sections at the stations solved already; `paper` and `section-march` do not
/// use them.
/// @param sections  one a station of flow.x, for the gap of the case.
ModelledPressure pressure_along(FlowModel model, const FlowCase& flow,
                                const SectionsAlong& sections);

/// Whether a model takes its sections from a table: all but `paper`.
constexpr bool needs_sections(FlowModel model) { return model != FlowModel::paper; }

}  // namespace manoscope::flow

#pragma once

#include <memory>
#include <vector>

#include "manoscope/core/profile.hpp"
#include "manoscope/core/units.hpp"
#include "manoscope/flow/flow_models.hpp"
#include "manoscope/flow/flow_sensitivity.hpp"
#include "manoscope/flow/model_error.hpp"

namespace manoscope::validation {

/// Standard uncertainties of what a flow model takes from outside the maps. 0 = taken as exact.
struct FlowUncertainty {
  Length height{};         ///< of the gap 2 h0
  Viscosity viscosity{};   ///< of eta
  double flow_rate = 0.0;  ///< of Q, relative: one error of the pump, common to all runs
};

/// The channel as the flow models see it, the same for all runs of an experiment.
struct FlowSetup {
  flow::Channel channel;
  flow::Fluid fluid;
  FlowUncertainty uncertainty;
  flow::WallShape shape = flow::WallShape::parabola();
  flow::InletProfile inlet = flow::InletProfile::developed;
  Length developing_length{};  ///< FlowCase::developing_length
  /// How far the profile at the inlet may lie from `inlet` towards the other one, 0 (known) to 1
  /// (anything between developed and uniform).
  double inlet_spread = 1.0;
  /// Sections made once for all runs by with_tables(); without them every call makes its own.
  std::shared_ptr<const flow::SectionTables> tables;
};

/// The setup with tables of its sections for deflections between two.
FlowSetup with_tables(FlowSetup setup, Length least, Length greatest);

/// Deflection along the whole channel: the stations of a profile that count, and the clamped ends
/// of the wall (zeta = 0 at x = 0 and x = length) where no station stands there or beyond.
struct WallLine {
  Array1 x, zeta;              ///< (n) m
  std::vector<Index> station;  ///< (n) of the profile; kClampedEnd for an end
};
inline constexpr Index kClampedEnd = -1;

WallLine wall_line(const Profile& state, Length length);

/// A profile that counts over short stretches without data as well: there zeta is a natural cubic
/// spline through up to eight stations on either side, or the clamped end.
///
/// Straight lines over such a stretch make kinks, off by 3 um where the wall rises from the rim of
/// a nitride channel and a patch of 0.16 mm is missing; a march takes them for the shape of the
/// roof, and at high flow rates separates there. The errors are those of the stations that the
/// spline goes through, its noise taken as the station's own.
///
/// @param longest  stretches between stations that are longer stay without data.
Profile bridged(const Profile& state, Length length, Length longest);

/// A model's pressure along a wall line, with what moves it.
struct ModelledRun {
  WallLine line;
  flow::FlowSensitivity sensitivity;
  flow::ModelError error;
  /// (n) Pa, what one standard deviation of the inlet profile does to p: that of a rectangular
  /// distribution from `inlet` to inlet_spread of the way to the other profile, by inlet_rise().
  /// Models that know developed flow alone may lack the whole rise where `inlet` is uniform;
  /// `developing` starts uniform. 0 for a known developed inlet, and unless the flow runs forward.
  Array1 inlet_effect;

  const Array1& pressure() const { return sensitivity.modelled.pressure; }
};

/// Runs a model along the measured wall, p = 0 at the outlet.
/// @throws InputError as flow::pressure_along().
ModelledRun modelled_run(flow::FlowModel model, const FlowSetup& setup, FlowRate flow_rate,
                         const WallLine& line);
/// The same with inlet_rise() known already.
ModelledRun modelled_run(flow::FlowModel model, const FlowSetup& setup, FlowRate flow_rate,
                         const WallLine& line, const Array1& inlet_rise);

/// The case that modelled_run() solves.
flow::FlowCase flow_case(const FlowSetup& setup, FlowRate flow_rate, const WallLine& line);

/// p from a uniform profile less p from a developed one, (n) Pa, by the march on sections, or by
/// the plane march where that breaks down; 0 for a known developed inlet, and unless the flow runs
/// forward. The plane march alone would tell half to two thirds of it.
/// @throws InputError if the spread is out of range or both marches break down.
Array1 inlet_rise(const FlowSetup& setup, const flow::FlowCase& flow);

/// Tables of a setup, or new ones for the deflections of a line.
std::shared_ptr<const flow::SectionTables> tables_for(const FlowSetup& setup, const Array1& zeta);

}  // namespace manoscope::validation

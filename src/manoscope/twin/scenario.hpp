#pragma once

#include <optional>
#include <string>
#include <vector>

#include "manoscope/core/monitor.hpp"
#include "manoscope/core/units.hpp"
#include "manoscope/flow/channel.hpp"
#include "manoscope/flow/parasitic.hpp"
#include "manoscope/twin/coupled.hpp"
#include "manoscope/twin/interferometer.hpp"
#include "manoscope/twin/wall_model.hpp"

namespace manoscope::twin {

/// Errors of the pressure gauges. Standard deviations; 0 turns one off.
struct GaugeOptions {
  Pressure noise = 10.0 * Pa;             ///< of one hydrostatic reading
  double gain_uncertainty = 0.0;          ///< relative, one draw common to all levels
  Pressure zero_uncertainty{};            ///< one draw common to all levels
  Pressure transducer_noise = 10.0 * Pa;  ///< of one drop reading under flow

  template <class Visitor>
  void describe(Visitor&& visit) {
    visit("noise", noise, "standard deviation of one hydrostatic reading");
    visit("gain_uncertainty", gain_uncertainty, "relative, common to all levels");
    visit("zero_uncertainty", zero_uncertainty, "common to all levels");
    visit("transducer_noise", transducer_noise, "standard deviation of one pressure drop reading");
  }
  /// @throws InputError naming the first option out of range.
  void validate() const;
};

/// The syringe pump.
///
/// The stated flow rate, and the truth, are the mean ones. While a flow map is taken the pump gives
/// Q (1 + pulsation n), n standard normal, one draw for each map; wall and pressure follow at once,
/// the slow transducer shows the mean.
struct PumpOptions {
  double pulsation = 0.0;  ///< relative standard deviation of the flow rate during one map

  template <class Visitor>
  void describe(Visitor&& visit) {
    visit("pulsation", pulsation,
          "relative standard deviation of the flow rate during one map; truth is the mean");
  }
  /// @throws InputError naming the option out of range.
  void validate() const;
};

/// Gauge pressure at the channel's outlet: a column of liquid and the tubing behind it.
struct OutletLaw {
  Pressure head{};                 ///< without flow
  double tubing_resistance = 0.0;  ///< Pa s / m^3, >= 0

  Pressure pressure(FlowRate flow_rate) const {
    return head + Pressure::from_si(tubing_resistance * flow_rate.si());
  }
};

/// What stands for the wall.
enum class WallLaw {
  foppl_von_karman,  ///< the clamped plate: bending, stretching, shear, any prestress
  /// A long membrane with tapered ends, which answers to the pressure at x alone: quick, and a
  /// wall without non-local errors. Needs tension; knows neither shear nor an initial shape, and
  /// without prestress it has no compliance where it is flat.
  tapered_membrane,
};

/// Cells of a foppl_von_karman wall.
struct WallGrid {
  int n_cells_x = 28;  ///< along the flow
  int n_cells_z = 10;  ///< over half the width

  template <class Visitor>
  void describe(Visitor&& visit) {
    visit("n_cells_x", n_cells_x, "cells of the wall along the flow, even");
    visit("n_cells_z", n_cells_z, "cells of the wall over half the width, even");
  }
};

/// Everything a virtual experiment is made of; the true values.
struct Scenario {
  std::string name;
  flow::Channel channel;
  Length height_uncertainty{};  ///< the stated height is the true one plus one draw of this
  flow::Fluid fluid;
  std::string fluid_name;
  WallLaw wall_law = WallLaw::foppl_von_karman;
  wall::ClampedWall wall;  ///< as long and as wide as the channel
  std::string wall_material;
  WallGrid wall_grid;

  /// Hydrostatic, not descending: a wall with several states takes the branch of rising pressure.
  /// 0 Pa is vented to air.
  std::vector<Pressure> levels;
  std::vector<FlowRate> flow_rates;  ///< each once
  OutletLaw outlet;
  std::optional<flow::RigidPassage> inlet_passage, outlet_passage;

  InterferometerOptions camera;
  GaugeOptions gauge;
  PumpOptions pump;
  CoupledOptions solver;

  /// @throws InputError naming the first value out of range, and the first level that would lift
  ///         the wall beyond its theory (ClampedWall::largest_pressure()).
  void validate() const;
  /// The wall as a tapered membrane.
  wall::TaperedMembrane tapered_membrane() const;
  /// The wall as the coupled flow and the camera ask it. The grid of a plate resolves its edge
  /// layer at the highest level.
  /// @param monitor  of the wall's solutions: stopped, they throw Interrupted.
  WallModel wall_model(const Monitor& monitor = {}) const;
  /// The same experiment without any error of camera, gauges, pump and stated height.
  Scenario without_errors() const;
};

/// A small experiment in the manner of the paper's sample S1 (table I): a 0.2 um nitride wall over
/// a 175 um gap, bowed towards the fluid by a preload of 700 Pa and stretching above it, calibrated
/// at 17 levels up to 50 kPa, measured at 5, 20, 40 and 70 mL/min by a camera of 512 x 96 pixels.
///
/// E = 250 GPa and nu = 0.23 are common for low-stress nitride; the prestress of 10 MPa and the
/// preload are chosen so that mid-channel deflection starts near -11 um and reaches 47.5 um at 50
/// kPa. The wall is a tapered membrane and the flow creeping: made in a second, for what does not
/// hang on the wall's mechanics. The shipped scenario S1 has both.
Scenario small_s1();

}  // namespace manoscope::twin

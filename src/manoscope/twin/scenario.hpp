#pragma once

#include <optional>
#include <string>
#include <vector>

#include "manoscope/core/units.hpp"
#include "manoscope/flow/channel.hpp"
#include "manoscope/flow/parasitic.hpp"
#include "manoscope/twin/coupled.hpp"
#include "manoscope/twin/interferometer.hpp"
#include "manoscope/wall/tapered_membrane.hpp"

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

/// Gauge pressure at the channel's outlet: a column of liquid and the tubing behind it.
struct OutletLaw {
  Pressure head{};                 ///< without flow
  double tubing_resistance = 0.0;  ///< Pa s / m^3, >= 0

  Pressure pressure(FlowRate flow_rate) const {
    return head + Pressure::from_si(tubing_resistance * flow_rate.si());
  }
};

/// Everything a virtual experiment is made of; the true values.
struct Scenario {
  std::string name;
  flow::Channel channel;
  Length height_uncertainty{};  ///< the stated height is the true one plus one draw of this
  flow::Fluid fluid;
  std::string fluid_name;
  wall::Membrane membrane;
  std::string wall_material;
  wall::Preload preload;
  std::optional<Length> influence_length;  ///< of the wall along x; w/pi if absent

  std::vector<Pressure> levels;      ///< hydrostatic; 0 Pa is vented to air
  std::vector<FlowRate> flow_rates;  ///< each once
  OutletLaw outlet;
  std::optional<flow::RigidPassage> inlet_passage, outlet_passage;

  InterferometerOptions camera;
  GaugeOptions gauge;
  CoupledOptions solver;

  /// @throws InputError naming the first value out of range.
  void validate() const;
  wall::TaperedMembrane make_wall() const {
    return {channel.length, membrane, preload, influence_length};
  }
};

/// A small experiment in the manner of the paper's sample S1 (table I): a 0.2 um nitride wall over
/// a 175 um gap, bowed towards the fluid by a preload of 700 Pa and stretching above it, calibrated
/// at 17 levels up to 50 kPa, measured at 5, 20, 40 and 70 mL/min by a camera of 512 x 96 pixels.
///
/// E = 250 GPa and nu = 0.23 are common for low-stress nitride; the prestress of 10 MPa and the
/// preload are chosen so that mid-channel deflection starts near -11 um and reaches 47.5 um at 50
/// kPa.
Scenario small_s1();

}  // namespace manoscope::twin

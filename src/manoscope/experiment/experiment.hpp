#pragma once

#include <array>
#include <filesystem>
#include <optional>
#include <string>
#include <vector>

#include "manoscope/core/error.hpp"
#include "manoscope/core/frame.hpp"
#include "manoscope/core/units.hpp"
#include "manoscope/experiment/file_texts.hpp"
#include "manoscope/flow/marching.hpp"
#include "manoscope/flow/passage_losses.hpp"
#include "manoscope/flow/simulated_drop.hpp"

namespace manoscope::experiment {

struct ChannelSection {
  Length length{};                           ///< l, along the flow
  Length width{};                            ///< w, across
  Length height{};                           ///< 2 h0, gap under the undeflected wall
  std::optional<Length> height_uncertainty;  ///< standard
  /// Inlet-side corner (x = 0, z = -w/2) in the map, [along columns, along rows], from the outer
  /// corner of the first pixel. Absent = to be found from the maps.
  std::optional<std::array<Length, 2>> origin;
  std::optional<FlowDirection> flow;
  std::optional<Angle> rotation;
  std::optional<Outward> outward;
};

/// How the flow enters the channel.
struct InletSection {
  flow::InletProfile profile = flow::InletProfile::developed;
  /// How far the true profile may lie from `profile` towards the other one, as a fraction of the
  /// way, in [0, 1]. Absent = not known.
  std::optional<double> spread;
  /// Duct of the channel's first section between the uniform profile and x = 0.
  Length developing_length{};
};

struct WallSection {
  std::string material;
  std::optional<Length> thickness;
  std::optional<Pressure> youngs_modulus;
  std::optional<double> poisson_ratio;
  std::optional<Pressure> prestress;
};

struct FluidSection {
  std::string name;
  Viscosity viscosity{};
  std::optional<Viscosity> viscosity_uncertainty;  ///< standard
  Density density{};
};

struct InstrumentSection {
  std::optional<Length> height_noise;  ///< standard deviation of one pixel
  /// Of the interferometer: a miscounted fringe is half of it.
  std::optional<Length> wavelength;
  std::optional<Pressure> pressure_noise;             ///< of one hydrostatic reading
  std::optional<double> pressure_gain_uncertainty;    ///< relative, common to all levels
  std::optional<Pressure> pressure_zero_uncertainty;  ///< common to all levels
  std::optional<double> flow_rate_uncertainty;        ///< relative, common to all runs
  std::optional<Pressure> pressure_drop_uncertainty;  ///< standard, of one reading of the drop
  /// What the map files do not say themselves: distance of columns and of rows, unit of the
  /// heights, name of the channel to read.
  std::optional<std::array<Length, 2>> pixel_pitch;
  std::string height_unit, channel;
  std::optional<std::filesystem::path> reference;  ///< the instrument's own flat reference map
};

enum class SweepDirection { unknown, up, down };

/// One map at a known uniform pressure, outlet closed.
struct HydrostaticMap {
  std::filesystem::path map;  ///< absolute, or relative to the working directory
  std::string name;           ///< as written in the list
  Pressure pressure{};
  /// Standard, of this one reading: as the list says, else instrument.pressure_noise; nullopt if
  /// neither is given, which is no claim of an exact reading.
  std::optional<Pressure> pressure_uncertainty;
  /// To air, so at exactly 0 Pa and not read on the gauge: the list itself says 0 Pa with an
  /// uncertainty of 0.
  bool vented = false;
  std::optional<int> sequence;
  SweepDirection direction = SweepDirection::unknown;
  int line = 0;  ///< in the file that lists it
};

/// One map under flow.
struct FlowMap {
  std::filesystem::path map;
  std::string name;
  FlowRate flow_rate{};
  std::optional<Pressure>
      pressure_drop;  ///< transducer, inlet minus outlet, parasitic part included
  /// Standard, of this one reading of the drop: as the list says, else
  /// instrument.pressure_drop_uncertainty; nullopt if neither is given.
  std::optional<Pressure> pressure_drop_uncertainty;
  std::optional<Pressure> outlet_pressure;
  std::optional<Time> time;
  std::string run;  ///< "" in the file becomes the map's name without extension
  int line = 0;
};

/// A rigid passage between the channel and a gauge.
struct Passage {
  Length length{}, width{}, height{};
  std::optional<Length> height_uncertainty;  ///< standard, one error for both passages
  flow::PassageFittings fittings;  ///< steps at its ends and bends in it; a port is a mitre bend
  std::optional<Length> port{};    ///< length along the flow of a hole at the gauge's end
  bool port_at_side = false;       ///< in one side wall, else in the roof
};

struct RigidSection {
  std::optional<Passage> inlet, outlet;
  /// Drop of both passages together from a simulation, in the order of the file; replaces the
  /// formulas. Empty = none. An uncertainty of 0 = none given.
  std::vector<flow::SimulatedDrop> simulated;
};

/// One experiment file, checked whole: units understood, maps there, lists read.
struct Experiment {
  std::filesystem::path file;  ///< the experiment.toml
  std::string text;            ///< its content, verbatim
  std::string name;
  ChannelSection channel;
  InletSection inlet;
  std::optional<WallSection> wall;
  FluidSection fluid;
  InstrumentSection instrument;
  std::vector<HydrostaticMap> hydrostatic;  ///< in the order of the list
  std::vector<FlowMap> flow;                ///< in the order of the list; may be empty
  RigidSection rigid;
};

/// Reads and checks an experiment: a folder that holds experiment.toml, or the file itself.
///
/// @throws InputErrors with every fault of the file and its lists, each naming file, line and key,
///         what was found and what to write instead.
Experiment read_experiment(const std::filesystem::path& folder_or_file);

/// What can be understood of an experiment, and every fault of it.
struct ExperimentAttempt {
  Experiment experiment;           ///< a value at fault is left at its default
  std::vector<InputError> faults;  ///< as read_experiment() throws them
};

/// The same without an exception, for a draft: `instead` holds the texts of experiment.toml and of
/// lists that are not written yet, by their paths in normal form.
ExperimentAttempt attempt_experiment(const std::filesystem::path& file,
                                     const FileTexts& instead = {});

}  // namespace manoscope::experiment

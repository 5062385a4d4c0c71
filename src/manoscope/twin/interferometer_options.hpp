#pragma once

#include <string>

#include "manoscope/core/frame.hpp"
#include "manoscope/core/units.hpp"

namespace manoscope::twin {

/// A model camera: its pixels, how it looks at the channel, and its errors.
///
/// Every error has its own switch (0 turns it off) and its own random stream, so that one can be
/// turned on alone without moving the draws of the others. "Map by map" is an independent draw for
/// each map; a drift is the sum of such draws, one from each map to the next; what is "the same in
/// all maps" is drawn once.
///
/// Pixels need not be square: channel and rim exactly fill the map, so that the pitch along and
/// across follows from their numbers.
struct InterferometerOptions {
  int n_along = 1024;        ///< pixels along the flow
  int n_across = 192;        ///< pixels across
  Length rim = 0.4 * mm;     ///< rigid rim seen on each side
  Length blur{};             ///< standard deviation of the point spread
  Length noise = 20.0 * nm;  ///< white, Gaussian
  Length correlated_noise{};
  Length correlation_length = 100.0 * um;
  Angle tilt = Angle::from_si(0.2e-3);
  Length piston = 1.0 * um;
  Length curvature{};
  Length shift = 5.0 * um;
  Angle rotation_scatter{};
  Angle tilt_drift{};
  Length piston_drift{}, shift_drift{};
  double dropouts = 0.01;
  double blobs = 0.005;
  double spikes = 0.002;
  Length spike_height = 2.0 * um;
  double fringe_jumps = 0.0;
  Length wavelength = 600.0 * nm;
  Length quantisation{};
  FlowDirection flow = FlowDirection::plus_columns;
  bool across_reversed = false;
  Angle rotation{};
  Outward outward = Outward::plus_height;

  /// The two enumerations are set in code and have no text form here.
  template <class Visitor>
  void describe(Visitor&& visit) {
    visit("n_along", n_along, "pixels along the flow");
    visit("n_across", n_across, "pixels across the channel");
    visit("rim", rim, "width of the rigid rim seen around the channel");
    visit("blur", blur, "standard deviation of the Gaussian point spread");
    visit("noise", noise, "standard deviation of one pixel, white and Gaussian");
    visit("correlated_noise", correlated_noise,
          "standard deviation of Gaussian noise that neighbouring pixels share");
    visit("correlation_length", correlation_length,
          "distance at which correlated noise has the correlation 1/e");
    visit("tilt", tilt, "standard deviation of the sample's tilt about each axis, map by map");
    visit("piston", piston, "standard deviation of the height offset, map by map");
    visit("curvature", curvature,
          "standard deviation of each second-order term (along, across, product) of the frame's "
          "form, at the edge of the map; the same in all maps");
    visit("shift", shift, "standard deviation of the lateral shift along each axis, map by map");
    visit("rotation_scatter", rotation_scatter,
          "standard deviation of the rotation about the map's centre, map by map");
    visit("tilt_drift", tilt_drift, "standard deviation of the step of tilt between maps");
    visit("piston_drift", piston_drift, "standard deviation of the step of height between maps");
    visit("shift_drift", shift_drift,
          "standard deviation of the step of position between maps, along each axis");
    visit("dropouts", dropouts, "fraction of pixels lost one by one");
    visit("blobs", blobs, "fraction of pixels lost in small blobs of 1.5 to 3.5 pixels radius");
    visit("spikes", spikes, "fraction of pixels with a false height");
    visit("spike_height", spike_height, "mean size of a false height, up or down");
    visit("fringe_jumps", fringe_jumps,
          "fraction of pixels in patches of 3 to 10 pixels radius that are off by half a "
          "wavelength, up or down");
    visit("wavelength", wavelength, "mean wavelength of the light");
    visit("quantisation", quantisation, "step of the recorded heights");
    visit("across_reversed", across_reversed,
          "z runs towards falling rows (columns, for a flow along rows)");
    visit("rotation", rotation, "angle of the channel in the map, columns towards growing rows");
  }
  /// @throws InputError naming the first option out of range.
  void validate() const;
  /// The same camera with every error switched off; what it looks at and how stays.
  InterferometerOptions without_errors() const;
};

/// The camera with other numbers of pixels over the same view.
///
/// @param size  "512x96", along times across; or "0.25", a share of both numbers, in (0, 4].
/// @throws InputError if it is neither, or the numbers are out of range.
InterferometerOptions resized(InterferometerOptions camera, const std::string& size);

}  // namespace manoscope::twin

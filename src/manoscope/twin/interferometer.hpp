#pragma once

#include <cstdint>

#include "manoscope/core/frame.hpp"
#include "manoscope/core/height_map.hpp"
#include "manoscope/core/units.hpp"
#include "manoscope/flow/channel.hpp"
#include "manoscope/twin/uniform_curve.hpp"

namespace manoscope::twin {

/// A model camera: its pixels, how it looks at the channel, and its errors.
///
/// Every error has its own switch (0 turns it off) and its own random stream, so that one can be
/// turned on alone without moving the others.
struct InterferometerOptions {
  int n_along = 1024;        ///< pixels along the flow
  int n_across = 192;        ///< pixels across
  Length rim = 0.4 * mm;     ///< rigid rim seen on each side
  Length noise = 20.0 * nm;  ///< white, Gaussian
  Angle tilt = Angle::from_si(0.2e-3);
  Length piston = 1.0 * um;
  Length shift = 5.0 * um;
  double dropouts = 0.01;
  double blobs = 0.005;
  double spikes = 0.002;
  Length spike_height = 2.0 * um;
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
    visit("noise", noise, "standard deviation of one pixel, white and Gaussian");
    visit("tilt", tilt, "standard deviation of the sample's tilt about each axis, map by map");
    visit("piston", piston, "standard deviation of the height offset, map by map");
    visit("shift", shift, "standard deviation of the lateral shift along each axis, map by map");
    visit("dropouts", dropouts, "fraction of pixels lost one by one");
    visit("blobs", blobs, "fraction of pixels lost in small blobs of 1.5 to 3.5 pixels radius");
    visit("spikes", spikes, "fraction of pixels with a false height");
    visit("spike_height", spike_height, "mean size of a false height, up or down");
    visit("across_reversed", across_reversed,
          "z runs towards falling rows (columns, for a flow along rows)");
    visit("rotation", rotation, "angle of the channel in the map, columns towards growing rows");
  }
  /// @throws InputError naming the first option out of range.
  void validate() const;
};

/// Pixels of the camera: the channel and its rim exactly fill the map.
CameraGrid camera_grid(const flow::Channel& channel, const InterferometerOptions& options);

/// Where the channel lies in an unshifted map (before shift, with rotation about the corner).
ChannelFrame channel_frame(const flow::Channel& channel, const InterferometerOptions& options);

/// x of the pixel centres inside the channel of an unshifted, unrotated map: (n), m, ascending.
Array1 pixel_stations(const flow::Channel& channel, const InterferometerOptions& options);

/// The map a camera takes of a wall with a parabolic section, each pixel at its centre:
///
///   zeta(x, z) = (3/2) zeta(x) (1 - (2 z/w)^2) inside the channel, 0 on the rim
///
/// (eq. (3) of Ozsun, Yakhot & Ekinci 2013, read backwards), seen with the errors of `options`:
/// shift, tilt and piston of the whole sample, then pixel noise, spikes and dropouts.
///
/// @param deflection  width-averaged zeta(x), m, over the channel's length.
/// @param map_index   number of the map: each has its own errors. The same (seed, map_index) gives
///                    the same map.
/// @throws InputError if an option is out of range.
HeightMap record_map(const flow::Channel& channel, const UniformCurve& deflection,
                     const InterferometerOptions& options, std::uint64_t seed,
                     std::uint64_t map_index);

}  // namespace manoscope::twin

#pragma once

#include "manoscope/core/profile.hpp"
#include "manoscope/flow/channel.hpp"
#include "manoscope/numerics/smoothing_spline.hpp"
#include "manoscope/validation/flow_setup.hpp"

namespace manoscope::validation {

/// The deflection zeta(x) of one run without its noise: what a flow solver takes for the roof.
///
/// A smoothing spline through the stations that count and the clamped ends. Knots stand one height
/// apart in mid-channel and five times as dense at the ends, where the wall rises within w/pi; the
/// curve may bend there more than in between by a factor that the data choose, as they choose the
/// smoothing (numerics::SmoothingSpline). Ripples shorter than two heights are taken for noise in
/// any case: the flow hardly answers to them. Stretches without data are bridged by the same
/// spline, and standard() is wide there.
///
/// Error of zeta: standard() on average over x; no more is taken away than the noise explains
/// (tests).
class SmoothShape {
 public:
  /// @param state  profile of the run.
  /// @throws InputError if fewer than eight stations of the channel count.
  SmoothShape(const Profile& state, const flow::Channel& channel);

  /// (m) zeta at positions in [0, length], m.
  Array1 zeta(const Array1& x) const { return spline_.value(x); }
  /// (m) standard uncertainty of it by noise and smoothing, m; that of planes and position is none
  /// of the noise.
  Array1 standard(const Array1& x) const { return spline_.standard(x); }
  /// The smooth curve at stations of the caller's, with all errors of the profile as modes: noise
  /// under the name that flow_noise() gives each station.
  Profile at(const Array1& x) const;

  /// Positions that follow the knots: (n) from 0 to length, for models along the channel.
  const Array1& positions() const { return positions_; }
  /// Wavelength of a ripple along x of which half is left in mid-channel.
  Length half_wavelength() const { return Length::from_si(spline_.half_wavelength()); }
  Length taken() const { return Length::from_si(taken_); }  ///< rms of what was taken away
  Length noise() const { return Length::from_si(noise_); }  ///< rms of the stated noise
  Length longest_silence() const;  ///< longest stretch between stations that count

 private:
  Profile state_;
  WallLine line_;
  Array1 positions_;
  numerics::SmoothingSpline spline_;
  double taken_ = 0.0, noise_ = 0.0;  ///< m
};

}  // namespace manoscope::validation

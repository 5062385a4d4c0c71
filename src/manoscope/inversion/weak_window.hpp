#pragma once

#include <optional>
#include <vector>

#include "manoscope/core/arrays.hpp"

namespace manoscope::inversion {

/// A smooth weight over a short stretch of stations, and its second derivative.
///
///   phi(x) = (1 - t^2)^3,  t = (x - centre) / half_width,  |t| < 1
///
/// The weighted mean of a second derivative is that of the values themselves with the weight phi'':
/// phi and phi' vanish at both ends, so that int phi f'' = int phi'' f, and noise is averaged, not
/// differentiated. On the stations all weights are brought to the moments of phi and phi'' up to
/// the fifth, whatever the spacing: of a polynomial of that degree the means are exact. They
/// average over a stretch of standard deviation half_width/3.
struct WeakWindow {
  double centre = 0.0;  ///< m
  Index first = 0;      ///< station of the first weight
  Array1 mean;          ///< (n) weights, sum 1
  Array1 curvature;     ///< (n) weights, 1/m2
  Array1 skew;          ///< (n) weights of the mean of t f'', 1/m2
  Matrix smooth;        ///< (n, 6) orthonormal polynomials over the usable stations

  Index size() const { return mean.size(); }
  Index last() const { return first + size() - 1; }
  /// Weighted mean of values at all stations, (n_x).
  double mean_of(const Array1& values) const {
    return (mean * values.segment(first, size())).sum();
  }
  /// Weighted mean of their second derivative along x, per m2.
  double curvature_of(const Array1& values) const {
    return (curvature * values.segment(first, size())).sum();
  }
  /// Mean square, in standard deviations, of what a polynomial of fifth degree leaves of values:
  /// about 1 of what is smooth but for noise, more where a few neighbours stand off together.
  /// @param values, sigma  (n) of the window.
  double roughness(const Array1& values, const Array1& sigma) const;
};

/// The window about a centre; none unless at least 9 usable stations lie in it, no gap between them
/// or at its ends longer than half of half_width. Unusable stations have the weight 0.
///
/// @param x       (n_x) m, ascending.
/// @param usable  (n_x) 0 where a station has no value.
std::optional<WeakWindow> make_weak_window(const Array1& x, const Flags1& usable, double centre,
                                           double half_width);

/// Which of some windows are not rough: at most 3 times as rough as the median one, or twice as
/// rough as noise. A patch of pixels off by a fringe hardly moves a mean of deflections but
/// overturns its curvature.
std::vector<bool> not_rough(const std::vector<double>& roughness);

/// Half the width of the windows in which a wall is asked: an eighth of the channel's width, or 4.5
/// stations.
double window_half_width(const Array1& x, double channel_width);

}  // namespace manoscope::inversion

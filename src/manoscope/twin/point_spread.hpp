#pragma once

#include "manoscope/core/arrays.hpp"
#include "manoscope/core/random.hpp"

namespace manoscope::twin {

/// Weights of a Gaussian on whole pixels, of variance sigma^2 and sum 1: (2 m + 1), centre at m.
///
///   w(k) = e^(-t) I_k(t), t = sigma^2, for sigma <= 4;  w(k) ~ exp(-k^2/(2 sigma^2)) beyond
///
/// Source: the discrete analogue of the Gaussian (Lindeberg 1990, "Scale-space for discrete
/// signals", IEEE Trans. PAMI 12, eq. (20)): its variance is sigma^2 for any sigma, where a sampled
/// Gaussian narrower than a pixel has less. Beyond 4 pixels the two agree to 1e-3 of the largest
/// weight. Cut where the weights fall below 1e-8 of the centre.
///
/// @param sigma  standard deviation in pixels, in [0, 1000]; 0 gives the single weight 1.
Array1 gaussian_weights(double sigma);

/// Blurs an array (ny, nx) by a Gaussian point spread, along x and y; mirrored at the edges, so
/// that the mean of the array is kept.
///
/// @param sigma_x, sigma_y  standard deviations in pixels of their axis.
void blur(Array2& values, double sigma_x, double sigma_y);

/// Gaussian noise of mean 0 and variance 1, stationary up to the edges, with the autocorrelation
///
///   rho(dx, dy) = exp(-(dx/l_x)^2 - (dy/l_y)^2)
///
/// made by averaging white noise over a Gaussian of standard deviation l/2. Where l is below about
/// two pixels the law holds for the discrete Gaussian of gaussian_weights().
///
/// @param l_x, l_y  correlation lengths in pixels of their axis; 0 = uncorrelated.
/// @return (ny, nx).
Array2 correlated_noise(Index ny, Index nx, double l_x, double l_y, RandomStream& random);

}  // namespace manoscope::twin

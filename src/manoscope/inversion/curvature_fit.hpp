#pragma once

#include <optional>

#include "manoscope/core/arrays.hpp"

namespace manoscope::inversion {

/// Windows in which a pressure is explained by a curvature:
///
///   target = nuisance c + b curvature + errors
struct CurvatureRows {
  Eigen::VectorXd target;     ///< (n) Pa
  Eigen::VectorXd curvature;  ///< (n) 1/m
  Matrix nuisance;            ///< (n, k) shapes whose sizes c are not known, k may be 0
  /// (k) what is known of c beforehand, and how well; an infinite sigma for nothing.
  Eigen::VectorXd prior, prior_sigma;
  /// (n, n_errors) what one standard deviation of each independent error does.
  Matrix target_effect, curvature_effect;
};

struct CurvatureFit {
  double b = 0.0;          ///< N/m
  Eigen::VectorXd size;    ///< (k) c
  Eigen::VectorXd effect;  ///< (n_errors) N/m: what each error does to b
  double noise = 0.0;  ///< N/m, standard uncertainty of b by errors, priors and scatter of misfit
  /// N/m: by how much b differs from window to window, errors taken off; 0 where they may explain
  /// it all. Misfit in pressure over root mean square of the curvature.
  double misfit = 0.0;
  /// Root of the sum of squares of the curvature over that of its noise.
  double clearness = 0.0;

  /// Standard uncertainty of b.
  double uncertainty() const;
};

/// Fits b by generalised least squares with the covariance of all errors, each moving target and
/// curvature together.
///
/// Errors of the curvature itself would draw b towards what they do to target and curvature
/// together: their mean products are taken off (Fuller, Measurement Error Models, 1987, sec. 2.2).
///
/// Where what is left of the targets is more than errors explain (chi-square beyond its mean by two
/// standard deviations), the law itself is only nearly true: the same variance is then added to
/// every window, as much as brings chi-square to its mean (Mandel & Paule, Anal. Chem. 42, 1194,
/// 1970). That misfit is a definitional uncertainty of b (GUM D.3.4): a law that holds in no window
/// is no better known for there being more of them, so it is not divided by their number.
///
/// @return none with fewer than k + 3 windows, shapes that cannot be told apart, or a curvature
/// that is half noise.
std::optional<CurvatureFit> fit_curvature(const CurvatureRows& rows);

}  // namespace manoscope::inversion

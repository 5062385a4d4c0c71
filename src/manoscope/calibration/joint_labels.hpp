#pragma once

#include <optional>
#include <vector>

#include "manoscope/calibration/levels.hpp"
#include "manoscope/core/arrays.hpp"

namespace manoscope::calibration {

/// The pressures of all levels, estimated together.
struct JointLabels {
  Array1 pressure;  ///< (n) Pa
  /// (n, n): how the pressures follow the labels; an error that labels share goes through it.
  Matrix response;
  /// (n, n) Pa, lower triangular: root of the covariance of their errors; its columns are error
  /// variables of unit variance that the levels share.
  Matrix root;
};

/// What a model of the wall deflects under uniform pressure: of use for its shape, not its scale.
struct WallCurves {
  Array1 pressure;    ///< (n) Pa, ascending, n >= 3
  Array2 deflection;  ///< (n, n_x) m, rising with the pressure, at the stations of the levels
};

/// What the labels of all levels together say of each one's pressure.
///
/// The error of a label is the same at every station, so the wall as a whole tells it: its state is
/// one number, the deflection s projected on its own response, and
///
///   label_k = F(s_k) + e_k - F' d_k,    F(s) = a + b s + c s^3 + a cubic spline's rest,
///
/// with e_k the error of the label and d_k that of s_k. (p = b s + c s^3 is the long clamped
/// membrane, Ozsun et al. 2013, eq. (1), and, with b < 0 < a, a buckled one; c = 0 is a plate.) The
/// rest is a Gaussian process with the covariance of the cubic smoothing spline (Wahba, Spline
/// Models for Observational Data, 1990, ch. 1); how large it is the labels themselves say:
/// pressures and covariance are averages over that size, weighted by its restricted likelihood,
/// with e times the size, so that the bias of smoothing stays below the uncertainty. A wall that
/// follows no such law keeps its labels almost as they were read.
///
/// A model of the wall adds a term to F, d p_m(s), p_m(s) the pressure at which the model's
/// deflections have the state s: the rest is then only what the model's *shape* of p(s) misses. Of
/// a wall that snaps through (level_after_snap()) the levels behind the jump alone are estimated;
/// those before it keep their labels.
///
/// @param levels  ascending in pressure, on the same stations.
/// @param wall    a wall fitted to this calibration, if there is one.
/// @return none where fewer than six labels have an uncertainty, fewer than five stations count in
/// every level, or a label lies more than 4.5 standard uncertainties off what the others say: then
/// something else is wrong, and labels stay as they are.
std::optional<JointLabels> estimate_labels(const std::vector<Level>& levels,
                                           const WallCurves* wall = nullptr);

/// What estimate_labels() will say of labels that nobody has read yet, on average over their
/// errors: for planning.
///
/// The restricted likelihood of the rest's size is replaced by its expectation over the errors of
/// labels and states; what differs between sizes because of those errors joins the covariance.
/// `pressure` less the true ones is the bias of smoothing, `response` times the labels' own errors
/// what the estimates will really be off by, `root` what will be stated. Against estimates of drawn
/// labels: stated uncertainties within 5 %, errors within 10 %.
///
/// @param levels  in ascending order of their true pressures; profiles without errors.
/// @return none as estimate_labels(), but for labels that are off: none is.
std::optional<JointLabels> expect_labels(const std::vector<Level>& levels);

}  // namespace manoscope::calibration

#pragma once

#include <optional>
#include <string>
#include <vector>

#include "manoscope/core/arrays.hpp"
#include "manoscope/wall/wall_laws.hpp"

namespace manoscope::wall {

/// Width-averaged deflections of one cross-section under known uniform pressures: what a
/// hydrostatic calibration gives at one station, or at mid-channel. Errors are independent samples.
struct HydrostaticData {
  Array1 pressure;          ///< (n) Pa, gauge
  Array1 sigma_pressure;    ///< (n) Pa, standard uncertainty; 0 = exact
  Array1 deflection;        ///< (n) m, counted from the plane of the rim
  Array1 sigma_deflection;  ///< (n) m, standard uncertainty, > 0

  /// @throws InputError if shapes differ or a number is not finite or out of range.
  void validate() const;
};

struct PressureRange {
  Pressure low, high;
};
struct LengthRange {
  Length low, high;
};

/// What fit_law() frees, and between which bounds.
struct FitLawOptions {
  bool prestress = true;   ///< fit s0, of laws that have one
  bool thickness = false;  ///< fit t; together with E only large deflections tell them apart
  bool preload = false;    ///< fit a constant inward load: the law then takes p - preload

  /// Bounds; by default E from 1/10 to 10 times the start; s0 of the stiffest such wall from
  /// buckling (0 for membranes) to 2 % of E, or to as much tension as would buckle it; t from half
  /// to twice the start; the preload +- the largest pressure.
  std::optional<PressureRange> youngs_modulus_range, prestress_range, preload_range;
  std::optional<LengthRange> thickness_range;
  int max_iterations = 200;

  /// @throws InputError naming the first option out of range.
  void validate() const;
};

/// One fitted parameter, SI.
struct FitParameter {
  std::string name;  ///< "youngs_modulus", "prestress", "thickness" or "preload"
  double value = 0.0;
  double sigma = 0.0;  ///< standard uncertainty, k = 1
  double lower = 0.0, upper = 0.0;
  /// False where it shares in a direction of the parameter space that the data do not see (see
  /// fit_law()); sigma then says what the bounds leave.
  bool determined = true;
  bool at_bound = false;  ///< value rests on a bound: sigma is then that of a free parameter
};

/// A wall law fitted to hydrostatic data.
struct LawFit {
  LawKind kind{};
  WallSection section;  ///< with the fitted values
  Pressure preload{};
  std::vector<FitParameter> parameters;
  Matrix covariance;         ///< (k, k) of the parameters, SI
  Index n_undetermined = 0;  ///< directions of the parameter space that the data do not see
  Array1 pressure;           ///< (n) Pa, most likely true pressures
  /// (n) deviations over their standard uncertainty, sign of data minus law; sum of squares chi2.
  Array1 residual;
  double chi2 = 0.0;
  Index n_dof = 0;           ///< n - k
  double probability = 0.0;  ///< of a larger chi2 if the law and the sigmas are right
  /// chi2 + 2 k + 2 k (k + 1)/(n - k - 1); infinite where n < k + 2.
  double aicc = 0.0;
  bool converged = false;

  AnyWallLaw law() const { return make_wall_law(kind, section); }
  /// Parameter by name, null if it was not fitted.
  const FitParameter* find(const std::string& name) const;
};

/// Fits a wall law to hydrostatic data with errors in both variables.
///
///   minimise sum ((p_i - P_i)/sigma_p,i)^2 + ((zeta_i - zeta(P_i - preload; E, s0, t))/
///   sigma_zeta,i)^2
///
/// over the parameters and the true pressures P_i (explicit latent pressures: maximum likelihood
/// for normal errors; an effective variance that follows the slope of the law would bias it). E and
/// t are fitted by their logarithms. Levenberg-Marquardt of Ceres, inside the bounds, first with
/// P_i = p_i. Covariance: inverse of the Gauss-Newton information, the true pressures
/// marginalised; where directions are undetermined, the bounds join as uniform distributions
/// (variance range^2/12). A direction is undetermined if the data alone leave it wider than half
/// the standard deviation that the bounds do.
///
/// Validity: that of the law; uncertainties hold where the law is nearly linear over them (pulls
/// of mean 0 and width 1 on virtual data with 1 % errors).
///
/// @param start  Known properties of the wall (width, Poisson ratio, ...) and first values of those
///               to be fitted.
/// @throws InputError if data or options are bad, points are fewer than parameters + 1, or the law
///         does not hold for `start`.
LawFit fit_law(LawKind kind, const WallSection& start, const HydrostaticData& data,
               const FitLawOptions& options = {});

}  // namespace manoscope::wall

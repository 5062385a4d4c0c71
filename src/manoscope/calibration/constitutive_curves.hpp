#pragma once

#include <optional>
#include <string>
#include <vector>

#include "manoscope/calibration/levels.hpp"
#include "manoscope/calibration/pressure_scale.hpp"
#include "manoscope/core/arrays.hpp"
#include "manoscope/numerics/shape_spline.hpp"

namespace manoscope::calibration {

/// zeta(p) of one station: a shape-preserving cubic through its knots.
///
/// A knot is a level, or the mean of neighbouring levels that cannot be told apart. The curve lives
/// in the coordinate of PressureScale; outside [lowest(), highest()] it does not exist.
class ConstitutiveCurve {
 public:
  struct Knot {
    std::vector<Index> levels;  ///< averaged with equal weight
    double pressure, zeta;      ///< Pa, m
  };
  ConstitutiveCurve(const PressureScale& scale, std::vector<Knot> knots);

  double lowest() const { return knots_.front().pressure; }  ///< Pa
  double highest() const { return knots_.back().pressure; }  ///< Pa
  double zeta(double pressure) const;                        ///< m
  double slope(double pressure) const;                       ///< d zeta / d p, m/Pa
  /// Every pressure, Pa, at which the curve has this deflection, m; ascending.
  std::vector<double> pressures(double zeta) const;

  /// Standard uncertainty, signed, m, of the curve between its knots: what another fair interpolant
  /// through them would give instead. Shared by neighbouring stations whose readings lie between
  /// the same two levels.
  double interpolation_doubt(double pressure) const;
  /// The lower of the two knots around a pressure, by its first level.
  Index interval_level(double pressure) const;

  /// How an error of one level moves the curve at a pressure.
  struct LevelWeight {
    Index level;
    double deflection;  ///< d zeta(p) / d zeta_level
    double label;       ///< d zeta(p) / d p_level, m/Pa, p_s held fixed
  };
  std::vector<LevelWeight> level_weights(double pressure) const;

  const std::vector<Knot>& knots() const { return knots_; }

 private:
  PressureScale scale_;
  std::vector<Knot> knots_;
  numerics::ShapeSpline spline_;
};

/// The constitutive curves of a wall: zeta(p) at every station, with what is known of their errors.
///
/// Source: Ozsun et al. 2013, section III A: "position-dependent (local) constitutive curves".
struct ConstitutiveCurves {
  Array1 x;                   ///< (n_x) m, stations
  std::vector<Level> levels;  ///< ascending in their labels, as read
  /// (n_levels) Pa: the pressure of each level that the curves go through; the label itself, or
  /// what all labels together say of it (estimate_labels()).
  Array1 level_pressure;
  /// (n_levels, n_levels): how those pressures follow the labels.
  Matrix label_response;
  /// (n_levels, n_errors) Pa: how the errors of the labels, independent variables of unit variance,
  /// move those pressures; and what the variables are called.
  Matrix label_effect;
  std::vector<std::string> label_error;
  /// (n_x) curve of each station; empty where fewer than two levels count.
  std::vector<std::optional<ConstitutiveCurve>> curves;

  /// Standard uncertainty of each level's pressure, (n_levels) Pa.
  Array1 level_uncertainty() const { return label_effect.rowwise().norm().array(); }
  /// The levels with the pressures that the curves go through, and their uncertainties.
  std::vector<Level> estimated_levels() const;
};

}  // namespace manoscope::calibration

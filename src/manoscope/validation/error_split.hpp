#pragma once

#include <optional>
#include <string>
#include <vector>

#include "manoscope/calibration/constitutive_curves.hpp"
#include "manoscope/core/arrays.hpp"
#include "manoscope/validation/true_curve.hpp"

namespace manoscope::validation {

/// The error of one run's p(x) by its origin, station by station, Pa.
///
///   neighbourhood  the result's p(x) - read(measured curves, labelled p; measured zeta)
///   labels       read(measured curves, labelled p; measured zeta)
///                - read(measured curves, true p; measured zeta)
///   maps         read(measured curves, true p; measured zeta) - read(true curves; true zeta)
///   curve shape  read(true curves; true zeta) - true static pressure of the true zeta
///   locality     true static pressure of the true zeta - true p(x)
///
/// where read() is the program's own reading off the curves it fits through the levels, and the
/// true static pressure is that of TrueCurve. A telescoping sum: the five add up to the error at
/// every station. Sums of squares do not: at one station parts may cancel.
///
/// maps holds all that lies between a true width-averaged deflection and the measured one: noise,
/// levelling, position, width average, and what the flow did while the map was taken. locality is
/// what reading each station on its own costs: the wall was calibrated at uniform p and is read at
/// p(x). neighbourhood is what a reading that heeds the neighbours (read_nonlocal()) changes: it
/// takes locality and noise back, with the opposite sign; 0 where each station was read on its own.
struct ErrorSplit {
  /// (n) 1 where every one of the readings has an answer; elsewhere the parts are 0 and mean
  /// nothing.
  Flags1 split;
  Array1 neighbourhood;             ///< (n)
  Array1 labels, maps;              ///< (n)
  Array1 curve_shape_and_locality;  ///< (n), their sum
  Array1 curve_shape, locality;     ///< (n); empty where the true compliance is unknown
};

/// What one run was read from, and what was true. Arrays have shape (n).
struct SplitInput {
  Flags1 answered;         ///< 1 where the result holds a pressure
  Array1 pressure;         ///< Pa, as the result holds it
  Array1 local_pressure;   ///< Pa, each station on its own, as the result holds it
  Array1 deflection;       ///< m, measured
  Array1 true_pressure;    ///< Pa
  Array1 true_deflection;  ///< m
};

/// Curves at the same n stations: as measured; the same with true labels; of true deflections and
/// pressures. The last member is empty where the true compliance is unknown.
struct SplitCurves {
  calibration::ConstitutiveCurves measured, relabelled, true_curves;
  std::vector<TrueCurve> exact;
};

/// Splits the error of one run.
///
/// A station counts where all four readings have exactly one answer and reading the measured curves
/// again gives the result's local pressure to kSameReading: curves that cannot be fitted again
/// (another version of the program) explain nothing.
/// @throws InternalError if shapes differ.
ErrorSplit split_error(const SplitInput& run, const SplitCurves& curves);

/// Pa; far below any error that is looked at, far above round-off.
inline constexpr double kSameReading = 1e-3;

/// One part over the stations that count, Pa.
struct PartSummary {
  double mean = 0.0, rms = 0.0, largest = 0.0;
};

/// The split of one run in a few numbers.
struct SplitSummary {
  Index n_split = 0;     ///< stations in the stretch that count
  Index n_left_out = 0;  ///< with a pressure in the result but without a split
  PartSummary total, neighbourhood, labels, maps, curve_shape_and_locality;
  std::optional<PartSummary> curve_shape, locality;
};

/// @param inside    (n), 1 in the stretch that is judged.
/// @param answered  (n), 1 where the result holds a pressure.
SplitSummary summarise(const ErrorSplit& split, const Flags1& inside, const Flags1& answered);

}  // namespace manoscope::validation

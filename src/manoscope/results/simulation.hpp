#pragma once

#include <string>
#include <vector>

#include "manoscope/core/arrays.hpp"
#include "manoscope/results/no_number.hpp"

namespace manoscope::results {

/// Navier-Stokes in the measured shape of one run, as its file beside the result holds it: plain SI
/// arrays under the names of the file.
///
/// Dimensions: x (n) stations along the channel, ascending; variant (n_v) "as solved", and of a
/// plane solution "side walls added"; source (n_s) parts of the uncertainty. NaN where there is no
/// number.
struct Simulation {
  // Texts.
  std::string run;         ///< label of the flow run
  std::string source;      ///< program, version, revision
  std::string experiment;  ///< the whole experiment.toml
  std::string inputs;      ///< one "name  sha256" a line, as in result.nc
  std::string inlet;       ///< profile that `pressure` belongs to, and what of it is not known
  std::string roof;        ///< how the wall's shape was taken from the maps, in words
  std::string cells;       ///< options of the solver, one "name = value" a line

  double dim = 0.0;        ///< 2 or 3
  double flow_rate = 0.0;  ///< m3 s-1
  double converged = 0.0;  ///< 1 if the numerical uncertainty is within the tolerance
  double n_unknowns = 0.0, seconds = 0.0, peak_memory = 0.0;  ///< 1, s, bytes

  // Smoothing of the measured deflection.
  double smoothing_half_wavelength = kNoNumber;  ///< m
  double smoothing_taken = kNoNumber;            ///< m, rms
  double smoothing_noise = kNoNumber;            ///< m, rms of the stated noise
  double longest_silence = kNoNumber;            ///< m

  // The roof across, of three dimensions below a map; no number without one.
  double roof_map = 0.0;              ///< 1: below the run's own maps; 0: one shape, or a plane
  double roof_taken = kNoNumber;      ///< m, rms a cell, of what smoothing took away
  double roof_noise = kNoNumber;      ///< m, rms of the stated noise of a cell
  double roof_end_taken = kNoNumber;  ///< m, the same within half a width of the ends
  double roof_misfit = kNoNumber;     ///< rms of what was taken away over the noise, cell by cell
  double roof_departure = kNoNumber;  ///< m, rms, from the shape between the levels
  double roof_effect = kNoNumber;     ///< of the channel's drop, what the departure changes
  double roof_odd = kNoNumber;        ///< m, rms, of what is odd across
  double roof_odd_uncertainty = kNoNumber;  ///< m, standard
  double roof_odd_effect = kNoNumber;       ///< of the channel's drop

  Array1 x;                                ///< (n) m
  Array1 zeta, zeta_uncertainty;           ///< (n) m, smooth, standard
  Array1 gap;                              ///< (n) m, on the centre line
  Array2 pressure, pressure_uncertainty;   ///< (n_v, n) Pa, gauge, mean over the section
  Array1 wall_pressure, floor_pressure;    ///< (n) Pa, gauge, as solved, on the centre line
  Array1 wall_shear, floor_shear;          ///< (n) Pa, as solved, on the centre line
  Array1 inlet_effect;                     ///< (n) Pa, from this profile to the other end of what
                                           ///< is plausible; 0 where it counts as known
  Array1 read_pressure, read_uncertainty;  ///< (n) Pa, standard
  std::vector<std::string> error_source;   ///< (n_s)
  std::vector<Array2> pressure_variance;   ///< n_s of (n_v, n) Pa2
  double outlet_pressure = kNoNumber, outlet_uncertainty = kNoNumber;  ///< Pa
  double channel_drop = kNoNumber;                        ///< Pa, as solved, between the ends
  double channel_drop_numerical_uncertainty = kNoNumber;  ///< Pa
  double coarse_channel_drop = kNoNumber;                 ///< Pa, on the coarser mesh

  // Against the reading, over the test section.
  double section_start = kNoNumber, section_end = kNoNumber;                  ///< m
  double extracted_drop = kNoNumber, extracted_drop_uncertainty = kNoNumber;  ///< Pa
  std::vector<std::string> variant, verdict;                                  ///< (n_v)
  Array1 drop, drop_uncertainty;                                              ///< (n_v) Pa
  Array1 difference_uncertainty;                                              ///< (n_v) Pa
  Array1 en_number, chi_square, dof, p_value;                                 ///< (n_v)
  Array2 drop_variance;                                                       ///< (n_s, n_v) Pa2
};

}  // namespace manoscope::results

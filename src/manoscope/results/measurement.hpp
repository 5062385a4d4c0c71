#pragma once

#include <string>
#include <vector>

#include "manoscope/core/arrays.hpp"
#include "manoscope/core/map_picture.hpp"
#include "manoscope/results/checks.hpp"
#include "manoscope/results/flow_checks.hpp"
#include "manoscope/results/simulation.hpp"

namespace manoscope::results {

/// Everything a measurement leaves behind, as the result file holds it: plain SI arrays whose names
/// are those of the file. The schema (schema.hpp) lists name, unit, dimensions and meaning of each.
///
/// Dimensions: level (n_l) distinct calibration pressures, ascending; x (n_x) stations, ascending;
/// run (n_r) flow runs in the order of the experiment; map (n_m) every map that was read;
/// crossing (n_c) crossing points of all runs.
/// A number that does not exist (no transducer, no answer of the wall) is NaN.
struct Measurement : Checks, FlowChecks {
  // Global attributes.
  std::string title, source, history;
  std::string experiment;             ///< the whole experiment.toml
  std::string inputs;                 ///< one "name  sha256" a line
  std::string settings;               ///< one "name = value" a line: every option in force
  std::string reading;                ///< how p(x) was read: by which wall, or why by none
  std::string tube_law;               ///< b of the tube law, or why there is none
  std::vector<std::string> warnings;  ///< doubts worth a person's time, in words

  // Scalars.
  double channel_length = 0.0, channel_width = 0.0, channel_height = 0.0;  ///< m
  double channel_height_uncertainty = 0.0;                                 ///< m, standard
  double viscosity = 0.0, viscosity_uncertainty = 0.0;                     ///< Pa s, standard
  double density = 0.0;                                                    ///< kg m-3
  double coverage = 0.95;  ///< probability content of the intervals

  Array1 x;  ///< (n_x) m

  // Calibration.
  Array1 level_pressure;                 ///< (n_l) Pa, as applied (mean of repeats)
  Array1 level_pressure_uncertainty;     ///< (n_l) Pa, standard
  Array1 level_estimate;                 ///< (n_l) Pa, what all labels together say of it
  Array1 level_estimate_uncertainty;     ///< (n_l) Pa, standard
  Array2 static_deflection;              ///< (n_l, n_x) m
  Array2 static_deflection_uncertainty;  ///< (n_l, n_x) m
  Array1 crest_deflection;               ///< (n_l) m, zeta_p: mid-channel, on the centre line
  Array1 crest_deflection_uncertainty;   ///< (n_l) m

  // Reading.
  std::vector<std::string> run;               ///< (n_r)
  Array1 flow_rate, flow_rate_uncertainty;    ///< (n_r) m3 s-1, standard; 0 = taken as exact
  Array2 deflection, deflection_uncertainty;  ///< (n_r, n_x) m
  Array2 pressure, pressure_uncertainty;      ///< (n_r, n_x) Pa
  Array2 pressure_lower, pressure_upper;      ///< (n_r, n_x) Pa
  /// Each station on its own, before the wall's neighbourhood is taken into account.
  Array2 pressure_local, pressure_local_uncertainty;  ///< (n_r, n_x) Pa
  Array1 pressure_band_factor;                        ///< (n_r) k of the simultaneous band
  Array1 half_response_wavelength;                    ///< (n_r) m; NaN: read station by station
  std::vector<Matrix> pressure_covariance;            ///< n_r of (n_x, n_x) Pa2
  Flags2 pressure_flags;                              ///< (n_r, n_x) bits of ReadingFlag
  Array2 test_section;                                ///< (n_r, 2) m: x_start, x_end
  /// Budget: variance of p(x) by source; a name for each and one (n_r, n_x) array of Pa2.
  std::vector<std::string> budget_source;
  std::vector<Array2> pressure_variance;

  // The paper's own method: crossings of the flow profile with the static profiles.
  std::vector<int> crossing_run;  ///< (n_c) index into run
  Array1 crossing_x;              ///< (n_c) m
  Array1 crossing_x_uncertainty;  ///< (n_c) m
  Array1 crossing_pressure;       ///< (n_c) Pa

  // The tube law p = f(zeta) + b zeta'', a = f'. NaN: not determined.
  Array2 stiffness, stiffness_uncertainty;    ///< (n_l, n_x) Pa m-1, dp/dzeta at uniform p
  Array1 tube_law_deflection;                 ///< (n_r) m, where a and b belong
  Array1 tube_law_a;                          ///< (n_r) Pa m-1
  Array1 tube_law_b, tube_law_b_uncertainty;  ///< (n_r) N m-1, standard
  Array1 tube_law_misfit;                     ///< (n_r) N m-1, of it, from place to place
  Array1 healing_length;                      ///< (n_r) m, sqrt(-b/a)
  Array1 tube_law_at_rest_deflection;         ///< (n_l) m, from the ends of the wall
  Array1 tube_law_at_rest_a;                  ///< (n_l) Pa m-1
  Array1 tube_law_at_rest_b, tube_law_at_rest_b_uncertainty;  ///< (n_l) N m-1, standard
  Array1 tube_law_at_rest_misfit;                             ///< (n_l) N m-1
  double tube_law_at_rest_b_small = kNoNumber;                ///< N m-1
  double tube_law_at_rest_b_small_uncertainty = kNoNumber;

  // What each map was like.
  std::vector<std::string> map;             ///< (n_m) file names
  Array1 map_pressure;                      ///< (n_m) Pa, as applied; NaN of a map under flow
  Array1 map_tilt_x, map_tilt_z;            ///< (n_m) slope of the rim's plane, m/m
  Array1 map_noise;                         ///< (n_m) m, standard deviation of one pixel on the rim
  Array1 map_missing, map_spikes;           ///< (n_m) fraction of the pixels
  Array1 map_shift, map_shift_uncertainty;  ///< (n_m) m, along the flow, taken back
  Array1 map_shift_across;                  ///< (n_m) m, taken back
  Array1 map_shift_across_uncertainty;      ///< (n_m) m, standard; NaN where the wall does not show
  Array1 map_rotation;                      ///< (n_m) rad, taken back
  Array1 map_rotation_uncertainty;          ///< (n_m) rad, standard; NaN likewise
  Array1 map_mended;                        ///< (n_m) fraction of pixels of a false fringe order
  Array1 map_unmended;                      ///< (n_m) fraction of such pixels, left out
  Array1 map_rim_bend, map_rim_bend_uncertainty;  ///< (n_m) m, at mid-channel

  // What the wall did between the lowest and the highest pressure: where the channel was taken to
  // lie. Empty if the result holds no such picture.
  Array1 response_x, response_z;  ///< m, in the channel's frame
  Array2 wall_response;           ///< (n_z, n_x) m

  /// Deflection of every map, n_m or none. Not in result.nc but beside it, in maps.nc
  /// (map_pictures.hpp).
  std::vector<MapPicture> map_picture;

  /// Navier-Stokes in the measured shapes: in files of their own (read_simulations()), no part of
  /// result.nc.
  std::vector<Simulation> simulations;
};

}  // namespace manoscope::results

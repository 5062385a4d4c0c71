#pragma once

#include <string>
#include <vector>

#include "manoscope/core/arrays.hpp"
#include "manoscope/results/no_number.hpp"

namespace manoscope::results {

/// What a measurement tells of its own trustworthiness without knowing the truth. Part of
/// Measurement: plain SI arrays whose names are those of the file.
///
/// Dimensions beside those of Measurement: left_out_x (n_o) stations; section_x (n_sx), section_z
/// (n_sz) cells of the cross-sections, none where maps show too few pixels; repeat (n_p) states of
/// which there is more than one map. NaN where there is no number.
struct Checks {
  // Every inner level read on the curves of the others.
  Array1 left_out_x;                            ///< (n_o) m
  Array2 left_out_error, left_out_uncertainty;  ///< (n_l, n_o) Pa; reading minus label
  Array1 left_out_mean_error;                   ///< (n_l) Pa, mean over the stations
  Array1 left_out_mean_uncertainty;             ///< (n_l) Pa, standard

  // Is it pressure that bends this wall: cross-sections against the calibrated shapes.
  Array1 section_x, section_z;         ///< m
  std::vector<int> map_run;            ///< (n_m) index into run; -1: a level's map
  Array2 shape_chi_square, shape_dof;  ///< (n_m, n_sx)
  std::vector<Array2> shape_misfit;    ///< n_m of (n_sz, n_sx) m
  Array1 shape_reduced_chi_square;     ///< (n_m) over the test section
  Array1 shape_p_value;                ///< (n_m)
  Array2 shape_worst;                  ///< (n_m, 2) m, start and end of the worst stretch
  Array1 shape_reading_shift;          ///< (n_m) Pa, what the misfit there could do to p

  // Do repeats of one state agree within their bars.
  std::vector<std::string> repeat;  ///< (n_p) "level 400 Pa", "flow 20 mL/min"
  std::vector<int> repeat_maps;     ///< (n_p)
  Array1 repeat_scatter;            ///< (n_p) Pa, standard deviation of the maps' mean pressures
  Array1 repeat_chi_square, repeat_dof, repeat_p_value;  ///< (n_p)

  // Levels on the way down against those on the way up. NaN where there are too few.
  double sweep_up_maps = 0.0, sweep_down_maps = 0.0;  ///< numbers of maps
  double sweep_difference = kNoNumber;  ///< Pa, down minus up where the wall deflects alike
  double sweep_difference_uncertainty = kNoNumber;  ///< Pa, standard

  /// (n_s, n_r) Pa2: variance of the extracted drop by source of uncertainty.
  Array2 extracted_drop_variance;
};

}  // namespace manoscope::results

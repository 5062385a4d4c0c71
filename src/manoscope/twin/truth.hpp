#pragma once

#include <filesystem>
#include <string>
#include <vector>

#include "manoscope/core/arrays.hpp"
#include "manoscope/core/units.hpp"

namespace manoscope::twin {

/// Snap-throughs of a wall on its way to a level or run from the one before.
struct SnapTruth {
  int n = 0;          ///< branches of states that ended
  double jump = 0.0;  ///< of the width-averaged zeta at one station, the furthest, m; with its sign
  double at = 0.0;    ///< that station, m; 0 without a snap
};

/// What was true along the channel during one run.
struct RunTruth {
  std::string run;
  Array1 pressure;    ///< (n) gauge pressure p(x), Pa
  Array1 deflection;  ///< (n) width-averaged zeta(x), m
  SnapTruth snaps{};  ///< since the run before; the first, since rest
};

/// What was true of one calibration level.
struct LevelTruth {
  std::string map;
  Pressure pressure{};  ///< true
  Pressure label{};     ///< as the gauge read it
  Array1 deflection;    ///< (n) width-averaged zeta(x; pressure), m, at Truth::x
  Array1 compliance{};  ///< (n) d zeta / d pressure, m/Pa, > 0 on a stable branch; empty: unknown
  SnapTruth snaps{};    ///< since the level before; the first, since rest
};

/// What a measurement should have found.
struct Truth {
  Array1 x;  ///< (n) m from the inlet edge, ascending
  std::vector<RunTruth> runs;
  std::vector<LevelTruth> levels{};  ///< empty where a truth tells of runs only
  std::string name{};                ///< of the experiment; empty: not told
  /// One "name  sha256" of a map a line, as in the result file; empty: not told.
  std::string inputs{};
};

/// The single numbers of one run: a row of truth_scalars.csv.
struct RunScalars {
  FlowRate flow_rate{};
  Pressure inlet{}, outlet{}, maximum{};  ///< p(0), p(l), largest p(x)
  Pressure parasitic{};                   ///< drop of the rigid passages
  Pressure transducer_reading{};          ///< with its noise
  Length largest_deflection{};            ///< of the width average along x
  double reynolds = 0.0;                  ///< mean of Re_x over the channel
  double speed_index = 0.0;               ///< largest S along the channel; 1 = choked

  Pressure compliant_drop() const { return inlet - outlet; }
  Pressure total_drop() const { return compliant_drop() + parasitic; }
};

/// truth.csv: x_mm, then p_Pa_<run> and zeta_um_<run> for each run; 1 mPa and 1 pm resolution.
std::string truth_csv(const Truth& truth);
/// truth_scalars.csv: one row a run; `height` is the true gap 2 h0.
std::string truth_scalars_csv(const std::vector<RunScalars>& runs, Length height);
/// truth_levels.csv: map, true and labelled pressure.
std::string truth_levels_csv(const std::vector<LevelTruth>& levels);
/// truth_static.csv: x_mm, then zeta_um_<map without extension> for each level.
std::string truth_static_csv(const Array1& x, const std::vector<LevelTruth>& levels);

/// Reads a truth.nc (truth_netcdf.hpp), or a truth.csv, which tells of runs only.
///
/// @param path  the file, or a folder that holds truth/truth.nc, truth.nc, truth/truth.csv or
///              truth.csv: the first of these counts.
/// @throws InputError naming file, column and line if it is missing or not such a table.
Truth read_truth(const std::filesystem::path& path);

}  // namespace manoscope::twin

#pragma once

#include <optional>
#include <vector>

#include "manoscope/core/arrays.hpp"
#include "manoscope/core/index.hpp"
#include "manoscope/numerics/lanes.hpp"
#include "manoscope/numerics/plane.hpp"

namespace manoscope::numerics {

/// Selected samples of a grid, side by side as the plane fit reads them: in runs along the rows.
class GridPoints {
 public:
  /// @param a         (nx) coordinate of the columns, of order 1
  /// @param b         (nz) coordinate of the rows, of order 1
  /// @param v         (nz, nx) values, below 1e150
  /// @param selected  (nz, nx), 1 where a sample may count
  /// @param flags     (nz, nx), 0 where it does
  GridPoints(const Array1& a, const Array1& b, const Array2& v, const Flags2& selected,
             const Flags2& flags);

  /// Neighbouring samples of one row. What does not count holds kAbsent, and so does what fills the
  /// run up to a multiple of kLanes.
  struct Run {
    Index start, first, length;  ///< in values(); column; samples, filled up
    Index row;
    double b;  ///< of the row
  };
  static constexpr double kAbsent = 1e200;

  Index size() const { return size_; }  ///< samples that count
  const std::vector<double>& values() const { return values_; }
  const std::vector<Run>& runs() const { return runs_; }
  const std::vector<double>& a() const { return a_; }  ///< of the columns, kLanes zeros behind them

 private:
  void add_run(const double* v, const FlagBits* flags, const Run& run, Index n);

  Index size_ = 0;
  std::vector<double> values_, a_;
  std::vector<Run> runs_;
};

/// Robust plane through samples of a grid: what fit_plane() finds for the same points, to within
/// 1e-5 of the plane's own standard uncertainty, in a fraction of the time.
///
/// It starts from 4000 of the points, of which few iterations are asked; and it looks for the
/// median of the residuals only where the last step can have moved it.
/// @return nullopt if the points lie on one line.
/// @throws InternalError for fewer than 3 points.
std::optional<PlaneFit> fit_plane(const GridPoints& points,
                                  Instructions instructions = best_instructions());

/// mad_sigma() of the values that count, about 0.
/// @throws InternalError if there are none.
double mad_sigma(const GridPoints& points, Instructions instructions = best_instructions());

}  // namespace manoscope::numerics

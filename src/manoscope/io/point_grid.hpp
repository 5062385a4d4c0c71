#pragma once

#include <string>
#include <vector>

#include "manoscope/core/arrays.hpp"

namespace manoscope::io {

/// Numbers at equal distances in memory, which outlive the view: a vector, a column of a table.
class NumberView {
 public:
  NumberView(const std::vector<double>& numbers) : NumberView(numbers.data(), numbers.size(), 1) {}
  NumberView(const double* first, std::size_t n, std::size_t step)
      : first_(first), size_(n), step_(step) {}

  std::size_t size() const { return size_; }
  bool empty() const { return size_ == 0; }
  double operator[](std::size_t i) const { return first_[i * step_]; }
  double front() const { return first_[0]; }
  double back() const { return (*this)[size_ - 1]; }

 private:
  const double* first_;
  std::size_t size_, step_;
};

/// Points that lie on an evenly spaced grid, as a map.
struct PointGrid {
  Array2 values;                        ///< (ny, nx); NaN where no point lies
  double pitch_x = 0.0, pitch_y = 0.0;  ///< in the points' own unit; 0 for a single column or row
  double x0 = 0.0, y0 = 0.0;            ///< of the first column and row
};

/// Puts points in any order on the grid that they lie on: x rises along a row, and row 0 has the
/// smallest y. Whole rows and columns may be absent.
///
/// A coordinate may depart from its grid line by 5 % of the pitch: files round their coordinates.
/// @param x, y, z  equally many; x and y finite, z NaN where missing.
/// @throws InputError(where, ...) if the points are on no even grid, two lie on one grid point, or
///         fewer than one in four grid points is occupied.
PointGrid grid_of_points(NumberView x, NumberView y, NumberView z, const std::string& where);

/// Spacing of values that rise or fall evenly, negative where they fall; 0 for a single value.
/// @throws InputError(where, ...) if they are not evenly spaced.
double even_spacing(NumberView positions, const std::string& where);

}  // namespace manoscope::io

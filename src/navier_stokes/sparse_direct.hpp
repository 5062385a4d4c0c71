#pragma once

#include <memory>
#include <string>
#include <vector>

namespace manoscope::navier_stokes {

/// Square sparse matrix by rows; columns of a row ascend.
struct SparseMatrix {
  std::vector<int> row_start;  ///< (n + 1)
  std::vector<int> column;     ///< (row_start[n])
  std::vector<double> value;   ///< (row_start[n])

  int size() const { return static_cast<int>(row_start.size()) - 1; }
  /// y = A x, both (n).
  std::vector<double> times(const std::vector<double>& x) const;
};

/// Libraries that factorise a sparse matrix.
enum class SparseLibrary { mumps, umfpack };

/// Direct solver of indefinite sparse systems whose every answer is checked.
///
/// A solution counts where |b - A x| <= kResidual |b| in the 2-norm, after at most two steps of
/// iterative refinement: the libraries' own verdict is no proof (UMFPACK 5.7 has called a solution
/// of a three-dimensional Stokes matrix good whose residual was 87 |b|). The analysis of the
/// pattern is kept as long as the pattern stays.
class SparseDirect {
 public:
  static constexpr double kResidual = 1e-9;

  explicit SparseDirect(SparseLibrary library = SparseLibrary::mumps);
  ~SparseDirect();
  SparseDirect(const SparseDirect&) = delete;
  SparseDirect& operator=(const SparseDirect&) = delete;

  /// @param matrix           (n, n)
  /// @param right_hand_side  (n)
  /// @return x of A x = b, (n).
  /// @throws InternalError if the library gives up, for want of memory too, or the residual stays
  ///         too large.
  std::vector<double> solve(const SparseMatrix& matrix, const std::vector<double>& right_hand_side);

  /// |b - A x| / |b| of the last solution.
  double residual() const { return residual_; }

  /// The library behind a SparseDirect; told apart in the source file.
  class Factors;

 private:
  std::unique_ptr<Factors> factors_;
  double residual_ = 0.0;
};

}  // namespace manoscope::navier_stokes

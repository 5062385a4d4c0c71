#pragma once

#include <Eigen/Cholesky>
#include <string>
#include <vector>

#include "manoscope/core/arrays.hpp"
#include "manoscope/inversion/read_pressure.hpp"

namespace manoscope::inversion {

/// Errors that stations share, of known shape and unit variance, beside errors of their own:
/// V = diag(1/weight) + E E^T.
class SharedErrors {
 public:
  /// @param effect  E, (n, k), k from 0; kept by reference.
  /// @param weight  (n), > 0.
  SharedErrors(const Matrix& effect, const Array1& weight);

  /// V^-1 times columns, by the formula of Sherman, Morrison and Woodbury.
  Matrix weighted(const Matrix& columns) const;
  /// What is left of residuals, (n), once the most likely shared errors are taken off.
  Eigen::VectorXd own_part(const Eigen::VectorXd& residual) const;

 private:
  const Matrix& effect_;
  Array1 weight_;
  Matrix weighted_;
  Eigen::LLT<Matrix> factors_;
};

/// Effects of the modes of one source on some stations, (stations, modes).
Matrix effects_of(const PressureReading& reading, const std::string& source,
                  const std::vector<Index>& stations);

}  // namespace manoscope::inversion

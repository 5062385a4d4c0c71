#include "manoscope/inversion/shared_errors.hpp"

namespace manoscope::inversion {

SharedErrors::SharedErrors(const Matrix& effect, const Array1& weight)
    : effect_(effect),
      weight_(weight),
      weighted_(weight.matrix().asDiagonal() * effect),
      factors_(Matrix::Identity(effect.cols(), effect.cols()) + effect.transpose() * weighted_) {}

Matrix SharedErrors::weighted(const Matrix& columns) const {
  return weight_.matrix().asDiagonal() * columns -
         weighted_ * factors_.solve(weighted_.transpose() * columns);
}

Eigen::VectorXd SharedErrors::own_part(const Eigen::VectorXd& residual) const {
  return residual - effect_ * factors_.solve(weighted_.transpose() * residual);
}

Matrix effects_of(const PressureReading& reading, const std::string& source,
                  const std::vector<Index>& stations) {
  std::vector<const ErrorMode*> modes;
  for (const ErrorMode& mode : reading.uncertainty.modes) {
    if (mode.source == source) modes.push_back(&mode);
  }
  Matrix effects(static_cast<Index>(stations.size()), static_cast<Index>(modes.size()));
  for (Index a = 0; a < effects.rows(); ++a) {
    for (Index j = 0; j < effects.cols(); ++j) {
      effects(a, j) =
          modes[static_cast<std::size_t>(j)]->effect[stations[static_cast<std::size_t>(a)]];
    }
  }
  return effects;
}

}  // namespace manoscope::inversion

#include "manoscope/validation/pieces.hpp"

#include <fmt/format.h>

#include <Eigen/Cholesky>
#include <algorithm>
#include <vector>

#include "manoscope/core/error.hpp"
#include "manoscope/numerics/chi_square.hpp"

namespace manoscope::validation {

bool counts(const inversion::PressureReading& reading, const Profile& state, Index ix) {
  return reading.answered(ix) && state.flags[ix] == 0;
}

Matrix piece_weights(const inversion::PressureReading& reading, const Profile& state,
                     const inversion::TestSection& section, Index n_pieces) {
  std::vector<Index> stations;
  for (Index ix = section.first; ix <= section.last; ++ix) {
    if (counts(reading, state, ix)) stations.push_back(ix);
  }
  const auto n = static_cast<Index>(stations.size());
  if (n < 2 || n_pieces < 2) {
    throw InputError("test section",
                     fmt::format("holds {} stations with a pressure, for {} pieces", n, n_pieces),
                     "Two stations and two pieces are the least; widen the test section");
  }
  const Index pieces = std::min(n_pieces, n);
  Matrix means = Matrix::Zero(pieces, reading.x.size());
  for (Index k = 0; k < n; ++k) {
    means(k * pieces / n, stations[static_cast<std::size_t>(k)]) = 1.0;
  }
  for (Index piece = 0; piece < pieces; ++piece) means.row(piece) /= means.row(piece).sum();
  return means.topRows(pieces - 1).rowwise() - means.row(pieces - 1);
}

ChiSquare chi_square(const Array1& difference, const Matrix& covariance, double floor) {
  const Index n = difference.size();
  const Matrix regular = covariance + floor * floor * Matrix::Identity(n, n);
  ChiSquare result;
  result.dof = static_cast<double>(n);
  const Eigen::LDLT<Matrix> solver(regular);
  result.value = difference.matrix().dot(solver.solve(difference.matrix()));
  result.tail = numerics::chi_square_tail(result.value, result.dof);
  result.log_likelihood = -0.5 * (result.value + solver.vectorD().array().log().sum());
  return result;
}

}  // namespace manoscope::validation

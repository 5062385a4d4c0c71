#include "manoscope/pipeline/checks.hpp"

namespace manoscope::pipeline {

void store_left_out(const inversion::LeftOut& left_out, results::Measurement& m) {
  const Index n = m.level_pressure.size(), n_x = left_out.x.size();
  m.left_out_x = left_out.x;
  m.left_out_error = m.left_out_uncertainty = Array2::Constant(n, n_x, kMissing);
  m.left_out_mean_error = m.left_out_mean_uncertainty = Array1::Constant(n, kMissing);
  for (std::size_t i = 0; i < left_out.levels.size(); ++i) {
    const inversion::LevelLeftOut& level = left_out.levels[i];
    const auto k = static_cast<Index>(i);
    m.left_out_error.row(k) = level.error;
    m.left_out_uncertainty.row(k) = level.uncertainty;
    m.left_out_mean_error[k] = level.mean_error;
    m.left_out_mean_uncertainty[k] = level.mean_uncertainty;
  }
}

}  // namespace manoscope::pipeline

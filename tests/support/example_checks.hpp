// The checks of an example measurement: dust in the last map, one level off its label by much.
#pragma once

#include <cmath>
#include <limits>
#include <string>

#include "manoscope/core/random.hpp"
#include "manoscope/results/measurement.hpp"

namespace manoscope::test_support {

inline void add_example_left_out(results::Measurement& m, RandomStream& random) {
  constexpr double kNan = std::numeric_limits<double>::quiet_NaN();
  constexpr Index kStations = 20;
  const Index n = m.level_pressure.size();
  m.left_out_x = Array1::LinSpaced(kStations, 2e-3, 13e-3);
  m.left_out_error = m.left_out_uncertainty = Array2::Constant(n, kStations, kNan);
  m.left_out_mean_error = m.left_out_mean_uncertainty = Array1::Constant(n, kNan);
  for (Index k = 1; k + 1 < n; ++k) {
    const double label = k == n / 2 ? 60.0 : 10.0 * random.normal();
    for (Index i = 0; i < kStations; ++i) {
      m.left_out_error(k, i) = label + 2.0 * random.normal();
      m.left_out_uncertainty(k, i) = 11.0;
    }
    m.left_out_mean_error[k] = m.left_out_error.row(k).mean();
    m.left_out_mean_uncertainty[k] = 10.5;
  }
}

inline void add_example_shapes(results::Measurement& m, RandomStream& random) {
  constexpr double kDof = 11.0;
  const auto n = static_cast<Index>(m.map.size());
  m.section_x = Array1::LinSpaced(36, 0.2e-3, m.channel_length - 0.2e-3);
  m.section_z = Array1::LinSpaced(10, -0.45 * m.channel_width, 0.45 * m.channel_width);
  m.shape_chi_square = m.shape_dof = Array2::Constant(n, 36, kDof);
  m.shape_reduced_chi_square = m.shape_p_value = m.shape_reading_shift = Array1::Zero(n);
  m.shape_worst = Array2::Zero(n, 2);
  for (Index i = 0; i < n; ++i) {
    m.map_run.push_back(static_cast<int>(i - m.level_pressure.size()));
    if (m.map_run.back() < 0) m.map_run.back() = -1;
    for (double& chi_square : m.shape_chi_square.row(i)) {
      chi_square *= 1.0 + 0.4 * random.normal();
    }
    m.shape_misfit.emplace_back(Array2::Constant(10, 36, 4e-9 * random.normal()));
    m.shape_reduced_chi_square[i] = 1.0;
    m.shape_p_value[i] = 0.4;
    m.shape_worst.row(i) << 5e-3, 5.4e-3;
  }
  if (n == 0) return;
  m.shape_chi_square(n - 1, 12) = 400.0;
  m.shape_misfit.back().block(6, 11, 3, 3).setConstant(150e-9);
  m.shape_reduced_chi_square[n - 1] = 2.1;
  m.shape_p_value[n - 1] = 1e-30;
  m.shape_reading_shift[n - 1] = 34.0;
}

inline void add_example_checks(results::Measurement& m, std::uint64_t seed) {
  RandomStream random(seed, "checks");
  add_example_left_out(m, random);
  add_example_shapes(m, random);
  m.repeat = {"level 400 Pa", "flow 20 mL/min"};
  m.repeat_maps = {2, 3};
  m.repeat_scatter = Array1{{3.0, 9.0}};
  m.repeat_chi_square = Array1{{1.4, 31.0}};
  m.repeat_dof = Array1{{2.0, 4.0}};
  m.repeat_p_value = Array1{{0.5, 3e-6}};
  m.extracted_drop_variance =
      Array2(static_cast<Index>(m.budget_source.size()), m.flow_rate.size());
  for (Index s = 0; s < m.extracted_drop_variance.rows(); ++s) {
    for (Index r = 0; r < m.extracted_drop_variance.cols(); ++r) {
      const double share = s == 2 ? 0.7 : 0.1;
      m.extracted_drop_variance(s, r) = share * std::pow(m.extracted_drop_uncertainty[r], 2);
    }
  }
}

}  // namespace manoscope::test_support

#include "tests/campaign/pixel_limit.hpp"

#include <Eigen/Cholesky>
#include <cmath>

#include "manoscope/core/error.hpp"
#include "manoscope/inversion/wall_response.hpp"
#include "manoscope/numerics/natural_spline.hpp"
#include "manoscope/wall/foppl_von_karman.hpp"

namespace manoscope::campaign {
namespace {

constexpr double kKnots = 0.5e-3;  // m apart

/// <s^2>/<s>^2 across the wall at stations, s its answer to a uniform change of pressure.
Array1 gain_of_shape(const wall::FopplVonKarman& wall, const wall::WallState& state,
                     const Array1& x) {
  constexpr Index kAcross = 64;  // midpoints: smooth, and flat at both edges
  const auto more =
      wall.predicted(state, 1.0, wall.rate(state, wall::WallLoad::uniform(Pressure::from_si(1.0))));
  const double w = wall.wall().width.si();
  Array1 gain(x.size());
  for (Index i = 0; i < x.size(); ++i) {
    double sum = 0.0, squares = 0.0;
    for (Index k = 0; k < kAcross; ++k) {
      const double z = w * ((static_cast<double>(k) + 0.5) / kAcross - 0.5);
      const double s = more.deflection(x[i], z) - state.deflection(x[i], z);
      sum += s;
      squares += s * s;
    }
    gain[i] = sum != 0.0 ? kAcross * squares / (sum * sum) : 1.0;
  }
  return gain;
}

}  // namespace

Array1 pixel_limit(const twin::Scenario& scenario, const Array1& nodes, const Array1& pressure,
                   const Array1& x) {
  const twin::InterferometerOptions& camera = scenario.camera;
  MANO_ASSERT(camera.correlated_noise.si() == 0.0 && camera.noise.si() > 0.0);
  const double l = scenario.wall.length.si(), w = scenario.wall.width.si();
  wall::FopplVonKarmanOptions options;
  options.n_cells_z = 6;
  options.design_pressure = scenario.levels.back();
  const wall::FopplVonKarman wall(scenario.wall, options);
  // From a uniform pressure like the mean one, which the wall reaches from rest on a single way.
  const auto uniform =
      wall.equilibrium(wall::WallLoad::uniform(Pressure::from_si(pressure.mean())));
  const auto state = wall.equilibrium(wall::WallLoad::along(nodes, pressure), uniform);

  const Array1 stations = inversion::response_nodes(scenario.wall.length, scenario.wall.width);
  const Index n = stations.size();
  const auto n_knots = static_cast<Index>(std::lround(l / kKnots)) + 1;
  const numerics::NaturalSpline spline(Array1::LinSpaced(n_knots, 0.0, l));
  const Matrix answer = wall.influence(state, stations) * spline.sampling(stations);
  const double dx = (l + 2.0 * camera.rim.si()) / camera.n_along;
  const double dz = (w + 2.0 * camera.rim.si()) / camera.n_across;
  const double lost = camera.dropouts + camera.blobs + camera.spikes;
  const double density = (1.0 - lost) * (w / dz) / (dx * std::pow(camera.noise.si(), 2));
  const Array1 gain = gain_of_shape(wall, state, stations.segment(1, n - 2));
  Array1 weight = Array1::Zero(n);  // nothing is told at the clamped ends themselves
  for (Index i = 1; i + 1 < n; ++i) {
    weight[i] = 0.5 * (stations[i + 1] - stations[i - 1]) * gain[i - 1] * density;
  }
  const Matrix information = answer.transpose() * weight.matrix().asDiagonal() * answer;
  const Matrix at = spline.sampling(x);
  const Matrix solved = information.ldlt().solve(at.transpose());
  return (at.transpose().array() * solved.array()).colwise().sum().sqrt().transpose();
}

}  // namespace manoscope::campaign

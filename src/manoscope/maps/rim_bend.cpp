#include "manoscope/maps/rim_bend.hpp"

#include <Eigen/Cholesky>
#include <Eigen/LU>
#include <algorithm>
#include <cmath>
#include <vector>

#include "manoscope/numerics/robust.hpp"

namespace manoscope::maps {
namespace {

using Terms = RimBend::Terms;
using Normal = Eigen::Matrix<double, 6, 6>;

struct Sample {
  Terms terms;
  double height;
};

std::vector<Sample> choose_samples(const ChannelMap& map, const Flags2& rim, const RimBend& bend) {
  constexpr Index kMost = 20000;
  const Index every = std::max<Index>(1, (rim != 0).count() / kMost);
  std::vector<Sample> samples;
  Index passed = 0;
  for (Index iz = 0; iz < map.grid.nz; ++iz) {
    const double z = map.grid.z(iz);
    for (Index ix = 0; ix < map.grid.nx; ++ix) {
      if (rim(iz, ix) == 0 || map.flags(iz, ix) != 0) continue;
      if (passed++ % every == 0) {
        samples.push_back({bend.terms(map.grid.x(ix), z), map.height(iz, ix)});
      }
    }
  }
  return samples;
}

}  // namespace

RimBend fit_rim_bend(const ChannelMap& leveled, const Flags2& rim, Length sigma,
                     Length channel_length) {
  constexpr double kTukey = 4.685;
  constexpr int kPasses = 3;
  constexpr double kLeastPivot = 1e-4;  // of the first: below it a term is not told from the others
  const ChannelGrid& grid = leveled.grid;
  RimBend bend;
  bend.x_centre = 0.5 * (grid.x(0) + grid.x(grid.nx - 1));
  bend.reach_x = std::max(0.5 * (grid.x(grid.nx - 1) - grid.x(0)), 1e-12);
  bend.reach_z = std::max({std::abs(grid.z(0)), std::abs(grid.z(grid.nz - 1)), 1e-12});
  bend.sigma = sigma;
  const std::vector<Sample> samples = choose_samples(leveled, rim, bend);
  Terms coefficient = Terms::Zero();
  double spread = sigma.si();
  Normal normal;
  std::vector<double> residuals(samples.size());
  for (int pass = 0; pass < kPasses; ++pass) {
    const double bound = kTukey * std::max(spread, 1e-300);
    normal.setZero();
    Terms right = Terms::Zero();
    for (const Sample& sample : samples) {
      const double off = (sample.height - coefficient.dot(sample.terms)) / bound;
      if (std::abs(off) > 1.0) continue;
      const double weight = std::pow(1.0 - off * off, 2);
      normal.noalias() += weight * sample.terms * sample.terms.transpose();
      right += weight * sample.height * sample.terms;
    }
    const auto factors = normal.ldlt();
    if (!(factors.vectorD().minCoeff() > kLeastPivot * normal(0, 0))) return bend;
    coefficient = factors.solve(right);
    for (std::size_t i = 0; i < samples.size(); ++i) {
      residuals[i] = samples[i].height - coefficient.dot(samples[i].terms);
    }
    spread = numerics::mad_sigma(residuals, 0.0);
  }
  bend.coefficient = coefficient;
  bend.covariance = spread * spread * normal.inverse();
  bend.sigma = Length::from_si(spread);
  const Terms middle = bend.terms(0.5 * channel_length.si(), 0.0);
  bend.at_middle = Length::from_si(middle.dot(coefficient));
  bend.at_middle_uncertainty = Length::from_si(std::sqrt(middle.dot(bend.covariance * middle)));
  return bend;
}

void subtract_bend(ChannelMap& map, const RimBend& bend) {
  for (Index iz = 0; iz < map.grid.nz; ++iz) {
    const double z = map.grid.z(iz);
    for (Index ix = 0; ix < map.grid.nx; ++ix) map.height(iz, ix) -= bend.height(map.grid.x(ix), z);
  }
}

}  // namespace manoscope::maps

#pragma once

#include <cstdint>
#include <functional>
#include <vector>

#include "manoscope/core/random.hpp"
#include "manoscope/numerics/distribution.hpp"
#include "manoscope/numerics/propagation.hpp"

namespace manoscope::numerics {

/// Draws one vector of input quantities from their joint distribution.
using Sampler = std::function<Eigen::VectorXd(RandomStream&)>;

/// Independent input quantities.
Sampler independent(std::vector<Distribution> distributions);

/// Jointly normal input quantities (JCGM 101:2008, 6.4.8).
/// @throws InputError if the estimates are bad or the covariance has a negative eigenvalue.
Sampler jointly_normal(const Estimates& estimates);

struct MonteCarloOptions {
  Index trials = 1'000'000;  ///< number of draws; the most of them where `digits` is not 0
  /// Significant digits of each standard uncertainty that are to be stable: draws until twice the
  /// standard deviations of value, standard uncertainty and end points of the symmetric interval
  /// are below numerical_tolerance() (JCGM 101:2008, 7.9). 0 = draws all `trials`.
  int digits = 0;
  double tolerance_part = 1.0;  ///< of that tolerance; 1/5 for validate_linear()
  double coverage = 0.95;       ///< probability of the intervals, in (0, 1)
  std::uint64_t seed = 1;
  int n_threads = 0;  ///< 0 = all; the model is then called from several at once

  /// @throws InputError naming the first option out of range.
  void validate() const;
};

struct MonteCarloResult {
  Eigen::VectorXd value;            ///< (m) means
  Matrix covariance;                ///< (m, m)
  std::vector<Interval> symmetric;  ///< (m) as much probability below as above
  std::vector<Interval> shortest;   ///< (m)
  Index n_trials = 0;
  bool stable = true;  ///< false if `trials` ended before the digits were stable

  Eigen::VectorXd sigma() const { return covariance.diagonal().cwiseSqrt(); }
};

/// Propagation of distributions by draws.
///
/// Source: JCGM 101:2008, clause 7 (7.6 value and uncertainty, 7.7 intervals, 7.9 number of
/// draws), for several outputs JCGM 102:2011, clause 7. Draws come in blocks of 1000, each from a
/// random stream of its own, and are summed in their order: seed and options fix every bit, on any
/// number of threads.
///
/// Error: that of M draws; of a value sigma/sqrt(M), of a standard uncertainty about
/// sigma/sqrt(2 M). An output that is not finite is an InputError of the model.
MonteCarloResult propagate_by_draws(const Model& model, const Sampler& inputs,
                                    const MonteCarloOptions& options = {});

}  // namespace manoscope::numerics

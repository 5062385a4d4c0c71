#pragma once

#include <cstdint>
#include <random>
#include <string_view>

#include "manoscope/core/index.hpp"

namespace manoscope {

/// A named stream of random numbers: the same (seed, name, index) always gives the same numbers,
/// whatever other streams are drawn, in whatever order, on whatever thread.
///
/// The generator is std::mt19937_64, whose output the standard fixes; uniform and normal variates
/// are formed here because the standard leaves its distributions to each library.
class RandomStream {
 public:
  RandomStream(std::uint64_t seed, std::string_view name, std::uint64_t index = 0);

  /// Uniform in [0, 1), 53 random bits.
  double uniform();
  double uniform(double low, double high) { return low + (high - low) * uniform(); }
  /// Standard normal (Box-Muller).
  double normal();
  /// Uniform integer in [0, n), n > 0.
  Index below(Index n);

 private:
  std::mt19937_64 engine_;
  double spare_ = 0.0;
  bool has_spare_ = false;
};

}  // namespace manoscope

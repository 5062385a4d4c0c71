#pragma once

#include <cstdint>

#include "manoscope/results/measurement.hpp"

namespace manoscope::test_support {

/// How large an example to make.
struct ExampleSize {
  Index n_x = 194;
  Index n_levels = 25;  ///< at most 25
  Index n_runs = 8;     ///< at most 8
  bool crossings = true;
  std::uint64_t seed = 1;
};

/// A made-up but self-consistent measurement in the manner of a thin, initially buckled wall over
/// 15.5 mm x 1.7 mm x 174.5 um: static profiles, flow profiles that a lubrication flow would give,
/// readings with noise, gaps (NaN and flags) near the ends and around the snap-through, one station
/// without data, a missing transducer reading.
results::Measurement example_measurement(const ExampleSize& size = {});

/// Empty if both hold the same texts and bit by bit the same numbers; else the name of the first
/// variable that differs.
std::string first_difference(const results::Measurement& a, const results::Measurement& b);

}  // namespace manoscope::test_support

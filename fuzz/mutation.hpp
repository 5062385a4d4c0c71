#pragma once

#include <string>

#include "manoscope/core/random.hpp"

namespace manoscope::fuzz {

/// The bytes with one to four wounds: flipped bits, runs of one byte, numbers of 1 to 8 bytes (of
/// either byte order) and numbers as text set to extremes such as 0, -1, 2^31 and 2^63, a cut-off
/// end, blocks taken out, doubled or moved in from `other`, the first part of `bytes` with the rest
/// of `other`, and words that the formats know. Half of the wounds hit the first 600 bytes, where
/// most formats have their header.
///
/// The same state of `random` gives the same wounds.
std::string mutated(std::string bytes, const std::string& other, RandomStream& random);

}  // namespace manoscope::fuzz

#pragma once

#include <functional>

#include "manoscope/core/index.hpp"

namespace manoscope {

/// Runs body(i) for i in [0, n) on up to `n_threads` threads (0 = all the machine has).
///
/// Each call must write only what belongs to its own i; sums over i are taken afterwards in the
/// order of i, so that the result has the same bytes on any number of threads. An exception of the
/// lowest failing i is rethrown.
void parallel_for(Index n, int n_threads, const std::function<void(Index)>& body);

}  // namespace manoscope

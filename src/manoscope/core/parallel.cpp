#include "manoscope/core/parallel.hpp"

#include <tbb/parallel_for.h>
#include <tbb/task_arena.h>

#include <exception>
#include <vector>

namespace manoscope {

void parallel_for(Index n, int n_threads, const std::function<void(Index)>& body) {
  if (n_threads == 1 || n < 2) {
    for (Index i = 0; i < n; ++i) body(i);
    return;
  }
  std::vector<std::exception_ptr> failures(static_cast<std::size_t>(n));
  tbb::task_arena arena(n_threads > 0 ? n_threads : tbb::task_arena::automatic);
  arena.execute([&] {
    tbb::parallel_for(
        tbb::blocked_range<Index>(0, n, 1),
        [&](const auto& range) {
          for (Index i = range.begin(); i != range.end(); ++i) {
            try {
              body(i);
            } catch (...) {
              failures[static_cast<std::size_t>(i)] = std::current_exception();
            }
          }
        },
        tbb::simple_partitioner{});
  });
  for (const std::exception_ptr& failure : failures) {
    if (failure) std::rethrow_exception(failure);
  }
}

}  // namespace manoscope
